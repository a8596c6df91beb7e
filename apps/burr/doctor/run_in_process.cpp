#include "doctor/run_in_process.h"

#include <fmt/core.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>

namespace burr::app {
namespace {

constexpr std::size_t kLongest = 4096;  // longest text [byte]

// The text is sent with an end mark: a process that dies earlier has sent nothing valid.
[[noreturn]] void child(const std::function<std::string()>& work, int to) {
  std::string words;
  try {
    words = work();
  } catch (const std::exception& trouble) {
    words = trouble.what();
  }
  words.resize(std::min(words.size(), kLongest));
  words += '\0';
  for (std::size_t sent = 0; sent < words.size();) {
    const ssize_t n = write(to, words.data() + sent, words.size() - sent);
    if (n <= 0) break;
    sent += static_cast<std::size_t>(n);
  }
  _exit(0);
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status))
    return fmt::format("it crashed (signal {}, {})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  return fmt::format("it ended the program (exit code {})", WEXITSTATUS(status));
}

}  // namespace

ProcessResult run_in_process(const std::function<std::string()>& work,
                             std::chrono::milliseconds longest) {
  int ends[2] = {};
  if (pipe(ends) != 0)
    return {false, fmt::format("it could not be tried ({})", std::strerror(errno))};
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) {
    close(ends[0]);
    close(ends[1]);
    return {false, fmt::format("it could not be tried ({})", std::strerror(errno))};
  }
  if (pid == 0) {
    close(ends[0]);
    child(work, ends[1]);
  }
  close(ends[1]);

  const auto until = std::chrono::steady_clock::now() + longest;
  std::string words;
  bool late = false;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    pollfd look = {ends[0], POLLIN, 0};
    const int there = left.count() > 0 ? poll(&look, 1, static_cast<int>(left.count())) : 0;
    if (there < 0 && errno == EINTR) continue;
    late = there <= 0;
    char part[512];
    const ssize_t n = late ? 0 : read(ends[0], part, sizeof part);
    if (n <= 0) break;
    words.append(part, static_cast<std::size_t>(n));
    if (words.back() == '\0') break;  // it may hang while it ends
  }
  close(ends[0]);
  kill(pid, SIGKILL);
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (!words.empty() && words.back() == '\0') {
    words.pop_back();
    return {true, words};
  }
  return {false, late ? fmt::format("it hung for more than {:g} s",
                                    1e-3 * static_cast<double>(longest.count()))
                      : how_it_ended(status)};
}

}  // namespace burr::app
