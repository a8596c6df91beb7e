// apps/burr/shared/console.h - what the terminal shows during long work.
#pragma once

namespace burr::app {

// --quiet: no progress
bool& quiet() noexcept;

// --percent: where stderr is no terminal, a line for each percent, "filming 12 %", for another program
bool& each_percent() noexcept;

}  // namespace burr::app
