// apps/burr/commands/console.h - what the terminal shows during long work.
#pragma once

namespace burr::app {

// --quiet: no progress
bool& quiet() noexcept;

}  // namespace burr::app
