// Ctrl-C and SIGTERM.
#pragma once

namespace burr::app {

// True after Ctrl-C or SIGTERM, once catch_interrupts() has been called; long work then ends cleanly and saves what it has.
// Any thread.
[[nodiscard]] bool interrupted() noexcept;

// From now on the first signal asks long work to end, and the second one ends the program at once. Call it at the start of main.
void catch_interrupts() noexcept;

}  // namespace burr::app
