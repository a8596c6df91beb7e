#include "commands/interrupt.h"

#include <csignal>

namespace burr::app {
namespace {

volatile std::sig_atomic_t asked_to_stop = 0;

void on_signal(int number) {
  if (asked_to_stop != 0) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  asked_to_stop = 1;
}

}  // namespace

bool interrupted() noexcept { return asked_to_stop != 0; }

void catch_interrupts() noexcept {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace burr::app
