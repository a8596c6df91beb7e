#include "shared/interrupt.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>

namespace burr::app {
namespace {

std::atomic<int> asked_by = 0;            // the first signal; 0: none came
std::atomic<std::int64_t> asked_at = 0;   // [ns]
std::atomic<std::int64_t> ends_at = 0;    // when the work is expected to end [ns]; 0: nobody knows
std::atomic<std::int64_t> left_then = 0;  // how long it may go on after the signal [ns]
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "used by a signal's handler");

std::int64_t now() noexcept {
  timespec time = {};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

// A terminal that was closed refuses every word, and a word refused would end the work before its end.
void leave_closed_terminal() noexcept {
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int file = STDIN_FILENO; nowhere >= 0 && file <= STDERR_FILENO; ++file) {
    struct stat about = {};
    pollfd end = {.fd = file, .events = 0, .revents = 0};
    if (fstat(file, &about) == 0 && S_ISCHR(about.st_mode) && poll(&end, 1, 0) > 0 &&
        (end.revents & (POLLHUP | POLLERR)) != 0)
      dup2(nowhere, file);
  }
  if (nowhere > STDERR_FILENO) close(nowhere);
}

void on_first(int number) {
  if (number == SIGHUP) {
    const int before = errno;
    leave_closed_terminal();
    errno = before;
  }
  if (asked_by != 0) return;
  asked_at = now();
  asked_by = number;
}

void on_signal(int number) {
  if (asked_by != 0) {
    std::signal(number, SIG_DFL);
    std::raise(number);
  }
  on_first(number);
}

}  // namespace

bool asked_to_end() noexcept { return asked_by != 0; }

bool interrupted() noexcept {
  if (!asked_to_end()) return false;
  const bool in_time = ends_at != 0 && ends_at - asked_at <= left_then;
  return !in_time || now() - asked_at > left_then;
}

int stopped_code() noexcept { return 128 + (asked_by == 0 ? SIGINT : asked_by.load()); }

void catch_interrupts(bool every_one) noexcept {
  struct sigaction action = {};
  action.sa_handler = every_one ? on_first : on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // a terminal that closes, a connection that breaks; what `nohup` started is to go on
  struct sigaction hangup = {};
  if (sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler != SIG_IGN)
    sigaction(SIGHUP, &action, nullptr);
}

void grant_time(double takes, double left) noexcept {
  left_then = static_cast<std::int64_t>(1e9 * left);
  ends_at = now() + static_cast<std::int64_t>(1e9 * takes);
}

}  // namespace burr::app
