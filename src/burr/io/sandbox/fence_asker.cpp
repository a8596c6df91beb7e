#include "burr/io/sandbox/fence_asker.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <utility>

#include "burr/base/helper_program.h"
#include "burr/io/read/bytes.h"
#include "burr/io/sandbox/fence.h"

namespace burr::io {
namespace {

using base::Handle;
using Clock = std::chrono::steady_clock;
constexpr std::size_t kLongestRequest = 16384;

// Memory of exactly this size, sealed: its size cannot be changed.
Handle sealed_memory(const char* name, std::size_t bytes) {
  Handle handle(::memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!handle.open() || ::ftruncate(handle.get(), static_cast<off_t>(bytes)) != 0 ||
      ::fcntl(handle.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) != 0)
    return {};
  return handle;
}

}  // namespace

FenceAsker::FenceAsker(const std::filesystem::path& path) : file_(short_name(path)) {}

Status FenceAsker::ask(const FenceRequest& request, Progress& progress) {
  mesh_ = request.mesh;
  if (Status status = start(request); !status) return status.error();
  return watch(progress);
}

Status FenceAsker::start(const FenceRequest& request) {
  const std::string program = fence_state().reader;
  if (program.empty())
    return error(Trouble::io,
                 "the program burr-read, which reads scans and meshes, is not beside libburr.so; "
                 "install burr again or give its path in BURR_READ");
  const auto failed = [this](const char* what, int reason) {
    return error(Trouble::io,
                 fmt::format("{}: cannot be read: {}: {}", file_, what, std::strerror(reason)));
  };
  letter_ = sealed_memory("burr-letter", kLetterBytes);
  if (!letter_.open()) return failed("shared memory cannot be created", errno);
  std::vector<std::uint8_t> packed(kLongestRequest);
  const std::uint64_t length = pack(request, packed);
  if (length == 0)
    return error(Trouble::usage, fmt::format("{}: its path is too long; move the file", file_));
  if (::pwrite(letter_.get(), &length, sizeof length, 0) != ssize_t{sizeof length} ||
      ::pwrite(letter_.get(), packed.data(), length, sizeof length) != static_cast<ssize_t>(length))
    return failed("shared memory cannot be created", errno);
  int ends[2] = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
    return failed("a socket cannot be opened", errno);
  socket_ = Handle(ends[0]);
  Handle theirs(ends[1]);

  constexpr int kReports = kMemoryLimit ? base::kNothing : STDERR_FILENO;  // of a sanitizer
  pid_t child = -1;
  const int reason = base::start_helper(program, "burr-read",
                                        {{theirs.get(), kFenceSocket},
                                         {letter_.get(), kFenceLetter},
                                         {base::kNothing, STDOUT_FILENO},
                                         {kReports, STDERR_FILENO}},
                                        child);
  if (reason != 0) return failed("burr-read cannot be started", reason);
  child_ = child;
  return fine();
}

// Watches the reader until it has ended.
Status FenceAsker::watch(Progress& progress) {
  constexpr int kTick = 50;  // [ms]
  mark_ = Clock::now();
  while (true) {
    if (progress.cancelled()) {
      stop();
      return error(Trouble::interrupted, "reading was stopped");
    }
    pollfd waiting{socket_.get(), POLLIN, 0};
    ::poll(&waiting, 1, kTick);
    const bool gone = reap(WNOHANG);  // before the socket is emptied, so that no message is lost
    bool closed = !listen(progress);
    for (int n = 0; gone && !closed && n < 8; ++n) closed = !listen(progress);
    if (gone || closed) break;
    if (misbehaved_ || last_) break;
    // at least a thousandth of the time must be work, even on a busy computer; less counts as
    // standing still
    constexpr double kWork = 1e-3;
    const double work = processor_seconds();
    // the reader's own limit ends it long before; this is the second line of defence
    constexpr double kGrace = 3;  // [s]
    if (work > limits_.seconds + kGrace) {
      stop();
      return took_too_long();
    }
    if (work - worked_at_mark_ > kWork * limits_.seconds) {
      mark_ = Clock::now();
      worked_at_mark_ = work;
    } else if (Clock::now() - mark_ > std::chrono::duration<double>(limits_.seconds)) {
      stop();
      return stood_still();
    }
  }
  if (misbehaved_) {
    stop();
    return error(
        fmt::format("{}: the reader sent an invalid answer and was stopped; the file is damaged "
                    "or made to do harm",
                    file_));
  }
  if (last_) {
    end_soon();
    return fine();
  }
  end_soon();
  return why_it_ended();
}

// Reads all messages that are there. False: the other end is closed.
bool FenceAsker::listen(Progress& progress) {
  for (int n = 0; n < 256 && !misbehaved_; ++n) {
    FenceMessage message;
    const ssize_t got = ::recv(socket_.get(), &message, sizeof message, MSG_DONTWAIT | MSG_TRUNC);
    if (got < 0) return errno == EAGAIN || errno == EINTR;
    if (got == 0) return false;
    if (got != ssize_t{sizeof message})
      misbehaved_ = true;
    else
      take(message, progress);
  }
  return true;
}

void FenceAsker::take(FenceMessage& message, Progress& progress) {
  switch (message.kind) {
    case FenceMessage::ready:
      // sent before the reader opened the file, so it can be trusted
      limits_ = {message.bytes, message.value};
      mark_ = Clock::now();
      return;
    case FenceMessage::want:
      return lend(message.bytes);
    case FenceMessage::back:
      if (message.loan == 0 || message.loan > loans_.size()) {
        misbehaved_ = true;
        return;
      }
      loans_[message.loan - 1] = {};
      return;
    case FenceMessage::report: {
      message.words[sizeof message.words - 1] = '\0';
      for (char* c = message.words; *c != '\0'; ++c)
        if (static_cast<unsigned char>(*c) < 0x20 || *c == 0x7F) *c = ' ';
      progress.report(message.value >= 0 ? std::min(message.value, 1.0) : 0, message.words);
      return;
    }
    case FenceMessage::done:
    case FenceMessage::mesh:
      last_ = message;
      return;
    case FenceMessage::stranger:
    case FenceMessage::no_walls:
      refusal_ = message.kind;
      return;
    default:
      misbehaved_ = true;
  }
}

void FenceAsker::lend(std::uint64_t bytes) {
  std::uint64_t lent = 0;
  for (const Loan& loan : loans_) lent += loan.bytes;
  FenceMessage answer;
  answer.kind = FenceMessage::refused;
  Handle memory;
  auto place = std::find_if(loans_.begin(), loans_.end(),
                            [](const Loan& loan) { return !loan.memory.open(); });
  const bool room = place != loans_.end() || loans_.size() < kMostLoans;
  if (bytes > 0 && bytes <= limits_.memory && lent <= limits_.memory - bytes && room)
    memory = sealed_memory("burr-voxels", static_cast<std::size_t>(bytes));
  iovec part{&answer, sizeof answer};
  alignas(cmsghdr) char extra[CMSG_SPACE(sizeof(int))] = {};
  msghdr head{};
  head.msg_iov = &part;
  head.msg_iovlen = 1;
  if (memory.open()) {
    if (place == loans_.end()) {
      loans_.emplace_back();
      place = loans_.end() - 1;
    }
    answer.kind = FenceMessage::lent;
    answer.loan = static_cast<std::uint32_t>(place - loans_.begin()) + 1;
    head.msg_control = extra;
    head.msg_controllen = sizeof extra;
    cmsghdr* first = CMSG_FIRSTHDR(&head);
    first->cmsg_level = SOL_SOCKET;
    first->cmsg_type = SCM_RIGHTS;
    first->cmsg_len = CMSG_LEN(sizeof(int));
    const int handle = memory.get();
    std::memcpy(CMSG_DATA(first), &handle, sizeof handle);
    place->memory = std::move(memory);
    place->bytes = bytes;
  }
  // the reader waits for this answer, so there is always room for it
  const ssize_t sent = ::sendmsg(socket_.get(), &head, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (sent < 0 && errno != EPIPE && errno != ECONNRESET) misbehaved_ = true;
}

double FenceAsker::processor_seconds() const {
  clockid_t clock{};
  timespec used{};
  if (::clock_getcpuclockid(child_, &clock) != 0 || ::clock_gettime(clock, &used) != 0) return -1;
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

// True: the reader has ended. Other code in this process may have waited for it.
bool FenceAsker::reap(int how) {
  if (child_ < 0) return true;
  pid_t which = 0;
  do {
    which = ::waitpid(child_, &status_, how);
  } while (which < 0 && errno == EINTR);
  if (which == 0) return false;
  if (which < 0) status_ = 0;
  child_ = -1;
  return true;
}
void FenceAsker::stop() {
  if (reap(WNOHANG)) return;
  ::kill(child_, SIGKILL);
  reap(0);
}
// The reader has sent its last message; gives it a moment to end.
void FenceAsker::end_soon() {
  for (int n = 0; n < 400 && !reap(WNOHANG); ++n) ::usleep(n < 50 ? 200 : 5000);
  stop();
}

Error FenceAsker::took_too_long() const {
  return error(
      fmt::format("{}: reading it took more than {:.0f} s of processor time, far more than its "
                  "size requires; {}",
                  file_, limits_.seconds,
                  mesh_ ? "simplify the mesh with another program"
                        : "if you trust it, allow more with `read_seconds`"));
}

Error FenceAsker::stood_still() const {
  return error(
      fmt::format("{}: reading it made no progress for {:.0f} s and was stopped; copy it to a disk "
                  "of this computer{}",
                  file_, limits_.seconds, mesh_ ? "" : ", or wait longer with `read_seconds`"));
}

Error FenceAsker::lies() const {
  return error(fmt::format(
      "{}: the reader sent an invalid answer; the file is damaged or made to do harm", file_));
}

std::vector<std::uint8_t> FenceAsker::letter() const {
  if (last_->kind != FenceMessage::done || last_->bytes == 0 || last_->bytes > kLetterBytes)
    return {};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(last_->bytes));
  if (::pread(letter_.get(), bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return {};
  return bytes;
}

FenceAsker::Loan* FenceAsker::loan(std::uint32_t number) {
  if (number == 0 || number > loans_.size() || !loans_[number - 1].memory.open()) return nullptr;
  return &loans_[number - 1];
}

Error FenceAsker::why_it_ended() const {
  if (refusal_ == FenceMessage::stranger)
    return error(Trouble::internal,
                 "burr-read belongs to another version of burr; install burr again");
  if (refusal_ == FenceMessage::no_walls)
    return error(Trouble::internal,
                 "burr-read could not set its own limits and therefore read nothing; see "
                 "`io::fence_state`");
  const int number = WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
  switch (number) {
    case SIGXCPU:
      return took_too_long();
    case SIGSYS:
      return error(
          fmt::format("{}: reading it tried something that no reader needs (the network, another "
                      "program, writing) and was stopped; do not trust this file",
                      file_));
    case SIGKILL:
      return error(
          fmt::format("{}: reading it was ended by the system, most likely because memory ran "
                      "out; close other programs or use a smaller {}",
                      file_, mesh_ ? "mesh" : "scan"));
    default:
      return error(
          fmt::format("{}: reading it crashed ({}), without harm to burr itself; the file is "
                      "damaged, copy it again",
                      file_, number != 0 ? ::strsignal(number) : "no answer"));
  }
}

}  // namespace burr::io
