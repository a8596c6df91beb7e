// burr-guard - runs a little longer than burr, to release a device that would hold its last force
// (src/burr/device/guardian.h starts it).
//
//     burr-guard line TEXT
//         descriptors: 0 a pipe that closes when burr ends, 1 the answer, 3 the device,
//         4 shared memory with the count of burr's beats
//     burr-guard crtk DOMAIN ARM ROUTE
//         the same without 3
#include <fmt/core.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "burr/device/crtk/bus.h"
#include "burr/device/guardian.h"

namespace {

using namespace burr::device;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr int kLife = 0, kAnswer = 1, kDevice = 3, kBeats = 4;
constexpr milliseconds kLook(5);      // between two checks of burr
constexpr milliseconds kAgain(2);     // between two messages of "no force"
constexpr milliseconds kLong(300);    // how long they are repeated after burr's end
constexpr milliseconds kFound(5000);  // time to discover a bus

void answer(const std::string& words) {
  static_cast<void>(::write(kAnswer, words.data(), words.size()));
}

enum class Life { goes_on, dismissed, ended };
Life look(milliseconds longest) {
  pollfd waits{kLife, POLLIN, 0};
  if (::poll(&waits, 1, static_cast<int>(longest.count())) <= 0) return Life::goes_on;
  char word = 0;
  return ::read(kLife, &word, 1) == 1 && word == 'q' ? Life::dismissed : Life::ended;
}

int guard(const std::function<void()>& let_go) {
  void* shared = ::mmap(nullptr, sizeof(std::atomic<unsigned>), PROT_READ, MAP_SHARED, kBeats, 0);
  if (shared == MAP_FAILED) {
    answer("burr-guard cannot open the shared memory; close other programs");
    return EXIT_FAILURE;
  }
  const auto& beats = *static_cast<const std::atomic<unsigned>*>(shared);
  answer("+");
  unsigned seen = 0;
  auto beaten = steady_clock::now();
  for (;;) {
    const unsigned beat = beats.load(std::memory_order_relaxed);
    const auto now = steady_clock::now();
    if (beat != seen || beat == 0) beaten = now;
    seen = beat;
    const bool hangs = now - beaten > milliseconds(Guardian::kMissedMs);
    if (hangs) let_go();
    const Life life = look(hangs ? kAgain : kLook);
    if (life == Life::dismissed) return EXIT_SUCCESS;
    if (life == Life::ended) break;
  }
  for (const auto until = steady_clock::now() + kLong; steady_clock::now() < until;) {
    let_go();
    std::this_thread::sleep_for(kAgain);
  }
  return EXIT_SUCCESS;
}

int guard_line(const std::string& text) {
  return guard([&text] { static_cast<void>(::write(kDevice, text.data(), text.size())); });
}

int guard_arm(int domain, const std::string& arm, const std::string& route) {
  auto bus = crtk::Bus::open(domain);
  if (!bus) {
    answer(bus.error().text);
    return EXIT_FAILURE;
  }
  crtk::Writer<crtk::WrenchStamped> force((*bus)->participant(), arm + route, crtk::Keep::newest,
                                          crtk::kGuardian);
  for (const auto until = steady_clock::now() + kFound; force.readers() <= 0;) {
    if (steady_clock::now() > until) {
      answer(fmt::format(
          "burr-guard finds no subscriber of {0}{1}; check that the arm's node still runs", arm,
          route));
      return EXIT_FAILURE;
    }
    std::this_thread::sleep_for(kLook);
  }
  crtk::WrenchStamped none{};
  none.header_.frame_id_ = crtk::as_sample_text("");
  return guard([&] {
    none.header_.stamp_ = crtk::now_stamp();
    force.write(none);
  });
}

}  // namespace

int main(int count, char** words) {
  for (const int deaf : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGQUIT}) std::signal(deaf, SIG_IGN);
  sched_param first{};
  first.sched_priority = 83;
  static_cast<void>(::sched_setscheduler(0, SCHED_FIFO, &first));  // where this computer allows it
  const std::string kind = count > 1 ? words[1] : "";
  if (kind == "line" && count == 3) return guard_line(words[2]);
  if (kind == "crtk" && count == 5) return guard_arm(std::atoi(words[2]), words[3], words[4]);
  fmt::print(stderr, "burr-guard is started by burr; do not start it by hand\n");
  return 2;
}
