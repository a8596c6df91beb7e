#include "burr/device/guardian.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "burr/base/helper_program.h"

namespace burr::device {
namespace {

constexpr int kReadyMs = 8000;  // long enough to discover a bus
constexpr std::size_t kPage = 4096;

// A file descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }
  void close() {
    if (fd_ >= 0) ::close(fd_);
    fd_ = -1;
  }

 private:
  int fd_;
};

Error failed(const char* what) {
  return error(Trouble::io,
               fmt::format("burr-guard, which releases the force if burr dies, cannot "
                           "be started ({}: {}); if it is not there, install burr again",
                           what, std::strerror(errno)));
}

}  // namespace

Result<std::unique_ptr<Guardian>> Guardian::start(std::vector<std::string> words, int fd) {
  static_assert(std::atomic<unsigned>::is_always_lock_free);
  const std::string program = base::helper_program("burr-guard", "BURR_GUARD");
  if (program.empty())
    return error(Trouble::io,
                 "burr-guard, which releases the force if burr dies, is not beside libburr.so; "
                 "install burr again or give its path in BURR_GUARD");

  int lives[2], says[2];  // the guardian's ends of the pipes: lives[0], says[1]
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, lives) != 0) return failed("socket");
  Descriptor theirs(lives[0]), ours(lives[1]);
  if (::pipe2(says, O_CLOEXEC) != 0) return failed("pipe");
  Descriptor hear(says[0]), say(says[1]);
  const Descriptor page(::memfd_create("burr-beats", MFD_CLOEXEC));
  if (page.get() < 0 || ::ftruncate(page.get(), kPage) != 0) return failed("memory");
  void* shared = ::mmap(nullptr, kPage, PROT_READ | PROT_WRITE, MAP_SHARED, page.get(), 0);
  if (shared == MAP_FAILED) return failed("memory");
  auto* beats = new (shared) std::atomic<unsigned>(0);

  // Its descriptors: 0 burr's life, 1 its answer, 3 the device, 4 the beats. First all of them are
  // moved to numbers that do not collide with these.
  const std::array<std::pair<int, int>, 4> laid = {
      {{theirs.get(), 0}, {say.get(), 1}, {fd >= 0 ? fd : page.get(), 3}, {page.get(), 4}}};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  constexpr int kAside = 900;
  for (const auto& [from, to] : laid) posix_spawn_file_actions_adddup2(&actions, from, kAside + to);
  for (const auto& [from, to] : laid) {
    posix_spawn_file_actions_adddup2(&actions, kAside + to, to);
    posix_spawn_file_actions_addclose(&actions, kAside + to);
  }
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  // in a session of its own, so that Ctrl-C in burr's terminal does not reach it
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);

  words.insert(words.begin(), program);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  const int trouble =
      ::posix_spawn(&child, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (trouble != 0) {
    ::munmap(shared, kPage);
    errno = trouble;
    return failed(program.c_str());
  }
  std::unique_ptr<Guardian> guardian(new Guardian(child, ours.release(), beats));
  say.close();
  theirs.close();

  // "+": ready; otherwise an error message
  std::string answer;
  std::array<char, 256> some{};
  pollfd waits{hear.get(), POLLIN, 0};
  while (!answer.starts_with('+') && ::poll(&waits, 1, kReadyMs) > 0) {
    const ssize_t got = ::read(hear.get(), some.data(), some.size());
    if (got <= 0) break;
    answer.append(some.data(), static_cast<std::size_t>(got));
  }
  if (answer.starts_with('+')) return guardian;
  return error(Trouble::io, !answer.empty() ? answer
                                            : "burr-guard, which releases the force if burr dies, "
                                              "does not answer; install burr again");
}

Guardian::~Guardian() {
  const char dismissed = 'q';
  // it may have ended already; then no SIGPIPE
  static_cast<void>(::send(line_, &dismissed, 1, MSG_NOSIGNAL));
  ::close(line_);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  ::munmap(beats_, kPage);
}

}  // namespace burr::device
