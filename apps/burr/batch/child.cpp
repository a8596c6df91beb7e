#include "batch/child.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "batch/row.h"
#include "shared/interrupt.h"

namespace burr::app {
namespace {

// The signals that ask to end wait while it lives, so that none is missed between a look and a wait.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t all;
    sigemptyset(&all);
    for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&all, number);
    sigprocmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsWait() { end(); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
  void end() { sigprocmask(SIG_SETMASK, &before_, nullptr); }
  [[nodiscard]] const sigset_t& before() const { return before_; }

 private:
  sigset_t before_ = {};
};

Error no_process() {
  return error(kTryAgain, fmt::format("no process can be started: {}; end other programs, or raise "
                                      "the limit (`ulimit -u`)",
                                      std::strerror(errno)));
}

// Until the pipe's other end, which only the child has, is closed.
void wait_for(int pipe, pid_t child, const sigset_t& mask) {
  for (bool passed_on = false;;) {
    pollfd end = {.fd = pipe, .events = POLLIN, .revents = 0};
    if (ppoll(&end, 1, nullptr, &mask) >= 0 || errno != EINTR) return;
    if (asked_to_end() && !passed_on) {
      kill(child, stopped_code() - 128);
      passed_on = true;
    }
  }
}

}  // namespace

Result<ChildEnd> in_child(const std::function<int()>& work) {
  std::array<int, 2> ends = {};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return no_process();
  std::fflush(nullptr);
  SignalsWait waiting;
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(0);  // it was killed before
    close(ends[0]);
    catch_interrupts(true);
    waiting.end();
    const int code = work();
    std::fflush(nullptr);
    _exit(code);
  }
  close(ends[1]);
  if (child < 0) {
    close(ends[0]);
    return no_process();
  }
  wait_for(ends[0], child, waiting.before());
  close(ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFSIGNALED(status)) return ChildEnd{0, WTERMSIG(status)};
  return ChildEnd{WEXITSTATUS(status), 0};
}

}  // namespace burr::app
