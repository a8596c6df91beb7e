// apps/burr/shared/interrupt.h - Ctrl-C, SIGTERM, and SIGHUP of a terminal that closes.
#pragma once

namespace burr::app {

// True after one of these signals, once catch_interrupts() has been called; long work then ends cleanly and saves what it has.
// Any thread.
[[nodiscard]] bool interrupted() noexcept;

// The same without the time that grant_time() gives: whoever does one piece of work after the other begins no further one.
[[nodiscard]] bool asked_to_end() noexcept;

// The exit code of work that was stopped: 143 after SIGTERM, 129 after SIGHUP, 130 after Ctrl-C, or where the user closed what was open.
[[nodiscard]] int stopped_code() noexcept;

// From now on the first signal asks long work to end, and the second one ends the program at once. Call it at the start of main.
// every_one: a second signal changes nothing, for a process whose parent passes on a signal that came to both.
void catch_interrupts(bool every_one = false) noexcept;

// A signal from now on lets the work go on to its end, if that is expected in time: `takes` seconds from now, and at most
// `left` seconds after the signal, when interrupted() becomes true in any case.
void grant_time(double takes, double left) noexcept;

}  // namespace burr::app
