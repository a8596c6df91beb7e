// A reader that misbehaves as its file tells it to, behind the same fence as burr-read. The file's
// first word says what to do. Only for tests/io/fence_test.cpp; never installed.
#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"
#include "burr/io/sandbox/fence_child.h"
#include "burr/io/sandbox/fence_letter.h"

namespace burr::io {
namespace {

Scan small_scan() {
  Scan scan;
  scan.size = {2, 2, 2};
  scan.format = "naughty";
  scan.values.assign(8, 1.0F);
  return scan;
}

Error answer(const std::string& what) { return error("the naughty reader: " + what); }
Error outcome_of(long result) {
  return answer(result >= 0 ? "it worked" : fmt::format("refused: {}", std::strerror(errno)));
}

void raw_message(std::uint32_t kind, std::uint32_t loan, std::uint64_t bytes, std::size_t size) {
  FenceMessage message;
  message.kind = kind;
  message.loan = loan;
  message.bytes = bytes;
  iovec part{&message, size};
  msghdr head{};
  head.msg_iov = &part;
  head.msg_iovlen = 1;
  ::sendmsg(kFenceSocket, &head, MSG_NOSIGNAL);
}

Result<Scan> misbehave(const std::filesystem::path& path, const ReadOptions& /*options*/,
                       Progress& progress) {
  auto bytes = first_bytes(path, 4096);
  if (!bytes) return bytes.error();
  const std::vector<std::string> todo = words(std::string(bytes->begin(), bytes->end()));
  const std::string what = todo.empty() ? "" : todo[0];
  const std::string other = todo.size() > 1 ? todo[1] : "";

  if (what == "behave") return small_scan();
  if (what == "work") {
    for (int n = 0; n <= 10; ++n) progress.report(n / 10.0, "working");
    return small_scan();
  }
  // ---- crashes and hangs
  if (what == "crash") {
    volatile int* nowhere = nullptr;
    *nowhere = 1;
  }
  if (what == "abort") std::abort();
  if (what == "divide") ::raise(SIGFPE);
  if (what == "leave") ::_exit(0);
  if (what == "loop")
    for (std::atomic<long> n = 0; n >= 0; n = n & 1023) ++n;
  if (what == "sleep")
    while (true) std::this_thread::sleep_for(std::chrono::milliseconds(200));
  if (what == "work_on")
    while (true) {
      progress.report(0.5, "working on");
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  // ---- memory
  if (what == "eat") {
    std::vector<std::vector<char>> all;
    while (true) all.emplace_back(std::size_t{32} << 20, 'x');
  }
  if (what == "eat_voxels") {
    std::vector<Voxels<float>> all;
    while (true) all.emplace_back(std::size_t{8} << 20);
  }
  if (what == "eat_quietly") {  // memory that the fence's protocol does not show
    while (::malloc(std::size_t{1} << 20) != nullptr) continue;
    return answer("no more memory");
  }
  if (what == "open_many") {
    int n = 0;
    while (::open(path.c_str(), O_RDONLY | O_CLOEXEC) >= 0 && n < 100000) ++n;
    return answer(n < 100 ? "few files" : "many files");
  }
  // ---- files outside the folder
  if (what == "open") {
    auto text = first_bytes(other, 64);
    return text ? answer("it worked") : answer("refused: " + text.error().text);
  }
  if (what == "list") return outcome_of(::open(other.c_str(), O_RDONLY | O_DIRECTORY));
  if (what == "write") return outcome_of(::open(other.c_str(), O_WRONLY | O_CREAT, 0600));
  if (what == "unlink") return outcome_of(::unlink(other.c_str()));
  if (what == "rename") return outcome_of(::rename(path.c_str(), other.c_str()));
  // ---- network, programs, processes
  if (what == "socket") return outcome_of(::socket(AF_INET, SOCK_STREAM, 0));
  if (what == "run") {
    ::execl("/bin/true", "true", nullptr);
    return outcome_of(-1);
  }
  if (what == "fork") return outcome_of(::fork());
  if (what == "trace") return outcome_of(::ptrace(PTRACE_ATTACH, ::getppid(), nullptr, nullptr));
  if (what == "kill") return outcome_of(::kill(::getppid(), SIGTERM));
  if (what == "raise_limit") {
    const rlimit all{RLIM_INFINITY, RLIM_INFINITY};
    return outcome_of(::setrlimit(RLIMIT_AS, &all));
  }
  if (what == "code") {  // memory that can be executed
    void* at = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC,
                      MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return outcome_of(at == MAP_FAILED ? -1 : 0);
  }
  if (what == "threads") {
    int sum = 0;
    std::thread second([&sum] { sum = 1; });
    second.join();
    return answer(sum == 1 ? "threads work" : "threads do not work");
  }
  // ---- false results
  Scan scan = small_scan();
  if (what == "lie_size") scan.size = {2048, 2048, 500};
  if (what == "lie_negative") scan.size = {-2, -2, 2};
  if (what == "lie_axes") scan.axes.setConstant(NAN);
  if (what == "lie_spacing") scan.spacing_mm = {0, 1, 1};
  if (what == "lie_values") scan.values[3] = INFINITY;
  if (what == "lie_label") scan.label_names.push_back({70000, "x", {}});
  if (what == "lie_both") scan.labels.assign(8, 1);
  if (what == "lie_words") scan.notices.push_back("\x1b[2Jgone\r\n");
  if (what == "lie_letter") {
    raw_message(FenceMessage::done, 0, std::uint64_t{1} << 60, sizeof(FenceMessage));
    ::_exit(0);
  }
  if (what == "lie_nothing") {
    raw_message(FenceMessage::done, 0, 4096, sizeof(FenceMessage));  // the request, returned as an
                                                                     // outcome
    ::_exit(0);
  }
  if (what == "lie_short") {
    raw_message(FenceMessage::want, 0, 4096, 5);
    std::this_thread::sleep_for(std::chrono::seconds(30));
  }
  if (what == "lie_kind") {
    raw_message(4711, 0, 4096, sizeof(FenceMessage));
    std::this_thread::sleep_for(std::chrono::seconds(30));
  }
  if (what == "lie_back") {
    raw_message(FenceMessage::back, 4000000000U, 0, sizeof(FenceMessage));
    std::this_thread::sleep_for(std::chrono::seconds(30));
  }
  return scan;
}

Result<TriangleMesh> misbehave_with_mesh(const std::filesystem::path& path) {
  auto bytes = first_bytes(path, 4096);
  if (!bytes) return bytes.error();
  const std::vector<std::string> todo = words(std::string(bytes->begin(), bytes->end()));
  const std::string what = todo.empty() ? "" : todo[0];
  if (what == "crash") std::abort();
  if (what == "loop")
    for (std::atomic<long> n = 0; n >= 0; n = n & 1023) ++n;
  if (what == "eat") {
    std::vector<std::vector<char>> all;
    while (true) all.emplace_back(std::size_t{32} << 20, 'x');
  }
  if (what == "open") {
    auto text = first_bytes(todo.at(1), 64);
    return text ? answer("it worked") : answer("refused: " + text.error().text);
  }
  if (what == "lie_loan") {
    raw_message(FenceMessage::mesh, 7, 3, sizeof(FenceMessage));
    ::_exit(0);
  }
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  if (what == "lie_corner") mesh.faces[0][2] = 3;
  if (what == "lie_nan") mesh.points[1][1] = NAN;
  if (what == "lie_none") mesh.faces.clear();
  return mesh;
}

}  // namespace
}  // namespace burr::io

int main() {
  return burr::io::answer_one_request(burr::io::misbehave, burr::io::misbehave_with_mesh);
}
