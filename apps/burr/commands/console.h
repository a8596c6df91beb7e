// apps/burr/commands/console.h - what the terminal shows while long work goes on.
#pragma once

namespace burr::app {

// --quiet: no progress
bool& quiet() noexcept;

}  // namespace burr::app
