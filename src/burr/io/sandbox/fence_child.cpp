#include "burr/io/sandbox/fence_child.h"

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <new>
#include <span>
#include <string>
#include <vector>

#include "burr/io/read/adf_folder.h"
#include "burr/io/read/bytes.h"
#include "burr/io/sandbox/fence_letter.h"
#include "burr/io/sandbox/fence_walls.h"
#include "burr/io/sandbox/voxel_lender.h"

namespace burr::io {
namespace {

// False: the asker is gone.
bool say(const FenceMessage& message) {
  iovec part{const_cast<FenceMessage*>(&message), sizeof message};  // only read
  msghdr head{};
  head.msg_iov = &part;
  head.msg_iovlen = 1;
  ssize_t sent = 0;
  do {
    sent = ::sendmsg(kFenceSocket, &head, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(sizeof message);
}

// The answer, and the file descriptor that comes with it, or -1.
bool hear(FenceMessage& message, int& handle) {
  handle = -1;
  iovec part{&message, sizeof message};
  alignas(cmsghdr) char extra[CMSG_SPACE(sizeof(int))] = {};
  msghdr head{};
  head.msg_iov = &part;
  head.msg_iovlen = 1;
  head.msg_control = extra;
  head.msg_controllen = sizeof extra;
  ssize_t got = 0;
  do {
    got = ::recvmsg(kFenceSocket, &head, MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  const cmsghdr* first = CMSG_FIRSTHDR(&head);
  if (first != nullptr && first->cmsg_type == SCM_RIGHTS)
    std::memcpy(&handle, CMSG_DATA(first), sizeof handle);
  return got == static_cast<ssize_t>(sizeof message);
}

// The thread that waits for an answer holds the lock, so the answer is always for itself.
class Loans final : public VoxelLender {
 public:
  void* lend(std::size_t bytes) override {
    const std::lock_guard guard(lock_);
    FenceMessage message;
    message.kind = FenceMessage::want;
    message.bytes = bytes;
    int handle = -1;
    if (!say(message) || !hear(message, handle)) ::_exit(1);  // the asker is gone
    if (message.kind != FenceMessage::lent || handle < 0) return nullptr;
    void* at = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, handle, 0);
    ::close(handle);
    if (at == MAP_FAILED) {
      give_back(message.loan);
      return nullptr;
    }
    loans_.push_back({at, bytes, message.loan});
    return at;
  }
  bool take_back(void* at) override {
    const std::lock_guard guard(lock_);
    const auto loan = find(at);
    if (loan == loans_.end()) return false;
    ::munmap(loan->at, loan->bytes);
    give_back(loan->number);
    loans_.erase(loan);
    return true;
  }
  // The number of the loan, or 0.
  [[nodiscard]] std::uint32_t number(const void* at) {
    const std::lock_guard guard(lock_);
    const auto loan = find(at);
    return loan == loans_.end() ? 0 : loan->number;
  }

 private:
  struct Loan {
    void* at;
    std::size_t bytes;
    std::uint32_t number;
  };
  std::vector<Loan>::iterator find(const void* at) {
    return std::find_if(loans_.begin(), loans_.end(), [at](const Loan& l) { return l.at == at; });
  }
  static void give_back(std::uint32_t number) {
    FenceMessage message;
    message.kind = FenceMessage::back;
    message.loan = number;
    (void)say(message);
  }
  std::mutex lock_;
  std::vector<Loan> loans_;
};

// Sends only as many reports as people can see, not one per slice.
class Reports final : public Progress {
 public:
  void report(double fraction, std::string_view stage) override {
    const auto now = std::chrono::steady_clock::now();
    if (stage == stage_ && fraction < 1 && now - last_ < std::chrono::milliseconds(40)) return;
    stage_ = stage;
    last_ = now;
    FenceMessage message;
    message.kind = FenceMessage::report;
    message.value = fraction;
    stage.copy(message.words, sizeof message.words - 1);
    (void)say(message);
  }
  // to cancel, the asker ends this process
  [[nodiscard]] bool cancelled() const override { return false; }

 private:
  std::string stage_;
  std::chrono::steady_clock::time_point last_;
};

FenceOutcome read_all(FencedRead read, const FenceRequest& request) {
  Reports reports;
  FenceOutcome outcome;
  try {
    outcome.scan = read(request.path, request.options, reports);
  } catch (const std::bad_alloc&) {
    outcome.scan = error(short_name(request.path) + ": reading it needs more memory than allowed");
  } catch (const std::exception& problem) {
    outcome.scan = error(short_name(request.path) + ": reading it failed: " + problem.what());
  }
  return outcome;
}

FenceMessage read_one_scan(FencedRead read, const FenceRequest& request, Loans& loans,
                           std::span<std::uint8_t> letter) {
  FenceOutcome outcome = read_all(read, request);
  if (outcome.scan.ok()) {
    outcome.values = outcome.scan->values.size();
    outcome.labels = outcome.scan->labels.size();
    outcome.values_loan = loans.number(outcome.scan->values.data());
    outcome.labels_loan = loans.number(outcome.scan->labels.data());
  }
  FenceMessage message;
  message.kind = FenceMessage::done;
  message.bytes = pack(outcome, letter);
  if (message.bytes == 0) {
    outcome.scan = error("its header holds more text than burr can keep");
    message.bytes = pack(outcome, letter);
  }
  return message;
}

Result<TriangleMesh> read_all(FencedMesh read, const std::string& path) {
  try {
    return read(path);
  } catch (const std::bad_alloc&) {
    return error(short_name(path) +
                 ": reading this mesh needs more memory than allowed; simplify it with another "
                 "program");
  } catch (const std::exception& problem) {
    return error(short_name(path) + ": reading it failed: " + problem.what());
  }
}

FenceMessage read_one_mesh(FencedMesh read, const FenceRequest& request, Loans& loans,
                           std::span<std::uint8_t> letter) {
  FenceMessage message;
  Result<TriangleMesh> mesh = read_all(read, request.path);
  if (mesh.ok()) {
    const std::size_t floats = 3 * mesh->points.size(), numbers = 3 * mesh->faces.size();
    auto* at = static_cast<std::uint8_t*>(
        loans.lend(floats * sizeof(float) + numbers * sizeof(std::uint32_t)));
    if (at != nullptr) {
      message.kind = FenceMessage::mesh;
      message.loan = loans.number(at);
      message.bytes = mesh->points.size();
      message.value = static_cast<double>(mesh->faces.size());
      std::memcpy(at, mesh->points.data(), floats * sizeof(float));
      std::memcpy(at + floats * sizeof(float), mesh->faces.data(), numbers * sizeof(std::uint32_t));
      return message;
    }
    mesh =
        error(Trouble::io, short_name(request.path) +
                               ": there is not enough memory for this mesh; close other programs");
  }
  FenceOutcome outcome;
  outcome.scan = mesh.error();
  message.kind = FenceMessage::done;
  message.bytes = pack(outcome, letter);
  return message;
}

}  // namespace

int answer_one_request(FencedRead read, FencedMesh read_mesh) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // Ctrl-C goes to every process at the terminal; the asker decides whether to stop
  for (const int number : {SIGINT, SIGQUIT, SIGHUP}) ::signal(number, SIG_IGN);
#if defined(SYS_close_range)
  ::syscall(SYS_close_range, kFenceLetter + 1, ~0U, 0);
#endif
  struct stat facts = {};
  void* letter = MAP_FAILED;
  if (::fstat(kFenceLetter, &facts) == 0 && facts.st_size == off_t{kLetterBytes})
    letter = ::mmap(nullptr, kLetterBytes, PROT_READ | PROT_WRITE, MAP_SHARED, kFenceLetter, 0);
  if (letter == MAP_FAILED) {
    std::fputs("burr-read reads scans and meshes for burr; do not start it by hand\n", stderr);
    return 2;
  }
  ::close(kFenceLetter);

  auto* bytes = static_cast<std::uint8_t*>(letter);
  std::uint64_t length = 0;
  std::memcpy(&length, bytes, sizeof length);
  FenceRequest request;
  FenceMessage message;
  if (length > kLetterBytes - sizeof length ||
      !unpack({bytes + sizeof length, static_cast<std::size_t>(length)}, request)) {
    message.kind = FenceMessage::stranger;
    (void)say(message);
    return 1;
  }
  if (!request.mesh) request.path = with_its_adf(request.path);
  const FenceLimits limits =
      request.mesh ? fence_limits_of_mesh() : fence_limits(request.path, request.options);
  if (!raise_walls(request.path, limits)) {
    message.kind = FenceMessage::no_walls;
    (void)say(message);
    return 1;
  }
  message.kind = FenceMessage::ready;
  message.bytes = limits.memory;
  message.value = limits.seconds;
  if (!say(message)) return 1;

  static Loans loans;  // must outlive all voxels
  set_voxel_lender(&loans);
  const std::span<std::uint8_t> out(bytes, kLetterBytes);
  message = request.mesh ? read_one_mesh(read_mesh, request, loans, out)
                         : read_one_scan(read, request, loans, out);
  (void)say(message);
  ::_exit(0);  // the voxels stay where they are
}

}  // namespace burr::io
