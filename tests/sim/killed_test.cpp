// kill -9 at any moment: a child process mills and records, the parent kills it. The file must
// open, lack at most the last 0.1 s, and replay exactly to its end.
//
//     BURR_KILLS=1000 build/release/test_sim --gtest_filter='Killed.*'
//
// The loss is measured against the number of ticks that the servo had given to the recorder when
// the child died. The hand counts them, because it is asked for its position at the start of every
// tick. Children in real time: lost ticks times the period, so that a machine that stands still as
// a whole costs nothing. Children as fast as possible: the time in which the lost ticks were given
// over.
//
// Every single kill is judged, on any machine. Delays that the machine causes are measured, not
// guessed. The pen asks for a processor every 40 ms; how long the kernel let it wait is in the
// kernel's own account (schedstat), which the child copies out while it lives. How long the host of
// a virtual machine kept the processors for others is in the account of stolen time (/proc/stat; a
// thread on a stolen processor does not wait, it "runs"). Exactly this time is added to the 0.1 s.
// There is no excuse for a file that lacks ticks that the recorder called safe, or that does not
// replay.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>

#include "burr/base/progress.h"
#include "burr/device/simulated_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/record/player.h"
#include "burr/record/recorder.h"
#include "burr/record/repair.h"
#include "burr/rt/clock.h"
#include "burr/sim/replay.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/tick_hash.h"
#include "support/folder.h"

namespace burr::sim {
namespace {

using Random = std::mt19937_64;
using namespace std::chrono_literals;

constexpr std::size_t kMostTicks = 1 << 18;
constexpr double kPromised = 100;  // [ms]

// What the child reports while it lives, in memory that both share.
struct Told {
  std::atomic<bool> started;            // the file has its beginning
  std::atomic<std::uint64_t> handed;    // ticks that the servo has given to the recorder
  std::atomic<std::uint64_t> safe;      // of these, in the file according to the recorder
  std::atomic<std::uint64_t> refused;   // did not fit into a ring
  std::atomic<std::int64_t> waited_ns;  // total wait of the pen for a processor
  std::atomic<std::int64_t> handed_ns[kMostTicks];
};

// Passes everything to a simulated hand and counts: when asked for tick n + 1, tick n has been
// given to the recorder.
class CountingHand final : public device::Device {
 public:
  CountingHand(device::HandPath path, Told& told) : hand_(std::move(path), {}), told_(told) {}
  Status open() override { return hand_.open(); }
  void close() override { hand_.close(); }
  [[nodiscard]] const device::DeviceSpec& spec() const override { return hand_.spec(); }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override {
    if (asked_ > 0 && asked_ <= kMostTicks) {
      told_.handed_ns[asked_ - 1].store(rt::monotonic_ns(), std::memory_order_relaxed);
      told_.handed.store(asked_, std::memory_order_release);
    }
    ++asked_;
    return hand_.state(dt);
  }
  void write_force(const math::Vec3& force) BURR_RT override { hand_.write_force(force); }
  void scale_force(double scale) BURR_RT override { hand_.scale_force(scale); }
  [[nodiscard]] bool finished() const BURR_RT override { return asked_ >= kMostTicks; }

 private:
  device::SimulatedHand hand_;
  Told& told_;
  std::uint64_t asked_ = 0;
};

std::unique_ptr<volume::Bone> small_bone() {
  return phantom::bone_from_distance(phantom::cube_grid(16e-3, 48), {}, phantom::slab(), 64, 1);
}

// How long the thread named "pen" has waited for a processor so far [ns]; -1: not known.
std::int64_t waited_by_pen() {
  static const std::string task = [] {
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
      std::string name;
      std::getline(std::ifstream(entry.path() / "comm"), name);
      if (name == "pen") return (entry.path() / "schedstat").string();
    }
    return std::string();
  }();
  std::int64_t ran = 0, waited = -1;
  std::ifstream(task) >> ran >> waited;
  return waited;
}

// How long the host has kept the processors of a virtual machine for others so far, summed over all
// processors [ms]; counted in steps of 10 ms.
double stolen_ms() {
  std::ifstream stat("/proc/stat");
  std::string cpu;
  double user = 0, nice = 0, system = 0, idle = 0, io = 0, irq = 0, softirq = 0, stolen = 0;
  stat >> cpu >> user >> nice >> system >> idle >> io >> irq >> softirq >> stolen;
  return 1e3 * stolen / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

// The child: mills, gets commands, records, until it is killed.
[[noreturn]] void mill_until_killed(const std::string& file, bool realtime, bool humble,
                                    std::uint64_t seed, Told& told) {
  // the kernel gives no priority to an ordinary user
  if (humble && (::setgid(65534) != 0 || ::setuid(65534) != 0)) ::_exit(10);
  Random random(seed);
  const auto names = surgeon::motion_names();
  SessionSettings settings;
  settings.servo.burr.radius = 1.5e-3;
  settings.servo.undo_bricks = 1024;
  settings.realtime = realtime;
  settings.threads = 1;
  auto bone = small_bone();
  const auto place = surgeon::find_work_place(*bone, settings.servo.burr.radius, {}, {});
  if (!place) ::_exit(11);
  auto path =
      surgeon::motion(names[random() % names.size()], *place, settings.servo.burr.radius, 200.0);
  if (!path) ::_exit(12);
  // reach the bone sooner than the long path of a built-in motion does
  for (device::PathPoint& point : path->points) point.t *= 0.25;
  NoProgress quiet;
  auto made = Session::make(std::move(bone), std::make_unique<CountingHand>(std::move(*path), told),
                            settings, quiet);
  if (!made) ::_exit(13);
  Session& session = **made;
  record::SessionInfo info;
  describe(session.settings(), session.hand().spec(), info);
  info.volume.grid = session.bone().grid();
  info.volume.tissues = session.bone().tissues();
  info.volume.content_hash = session.bone().content_hash();
  record::Recorder recorder(settings.servo.rate_hz, 8192, realtime);
  if (!recorder.start(file, info)) ::_exit(14);
  session.set_recorder(&recorder);
  told.started = true;
  session.start();
  const tick::CommandKind kinds[] = {
      tick::CommandKind::undo,      tick::CommandKind::redo,      tick::CommandKind::reset,
      tick::CommandKind::stiffness, tick::CommandKind::tool_mode, tick::CommandKind::spindle_speed};
  while (session.running()) {
    told.safe = recorder.written_ticks();
    told.refused = recorder.ticks().dropped();
    told.waited_ns = waited_by_pen();
    if (random() % 16 == 0) {
      const tick::CommandKind kind = kinds[random() % std::size(kinds)];
      const double value =
          kind == tick::CommandKind::stiffness   ? 300 + 100 * static_cast<double>(random() % 8)
          : kind == tick::CommandKind::tool_mode ? static_cast<double>(random() % 2)
                                                 : 4000;
      session.command({kind, value});
    }
    std::this_thread::sleep_for(2ms);
  }
  ::_exit(15);  // nobody killed it: kMostTicks is too small
}

struct Tally {
  int before_the_beginning = 0, repaired = 0, excused = 0;
  std::uint64_t ticks = 0, bricks = 0;
  std::vector<double> lost_ms;
};

// Judges the file after the kill.
void judge(const std::string& file, const Told& told, bool realtime, double stolen, bool again,
           Tally& tally) {
  NoProgress quiet;
  auto opened = record::Player::open(file);
  ASSERT_TRUE(opened) << opened.error().text;
  EXPECT_FALSE((*opened)->finished());
  const std::uint64_t kept = (*opened)->end_tick(), handed = told.handed;
  EXPECT_EQ(told.refused, 0U);
  EXPECT_GE(kept, told.safe) << "called safe, and lost";
  ASSERT_LE(kept, handed + 1);

  double lost = 0;
  if (kept < handed)
    lost = realtime ? static_cast<double>(handed - kept)
                    : 1e-6 * static_cast<double>(told.handed_ns[handed - 1] - told.handed_ns[kept]);
  tally.lost_ms.push_back(lost);
  const double waited = 1e-6 * static_cast<double>(std::max<std::int64_t>(0, told.waited_ns));
  EXPECT_LE(lost, kPromised + waited + stolen)
      << "the pen waited " << waited << " ms for a processor, and the host took " << stolen
      << " ms";
  if (lost > kPromised) ++tally.excused;

  // the hashes of a recording can be checked without simulating it
  record::StepCursor steps = (*opened)->steps();
  record::Step step;
  std::uint64_t hash = 0;
  while (steps.next(step)) {
    hash = tick::tick_hash(step.row, hash);
    ASSERT_EQ(hash, step.row.hash) << "tick " << step.row.tick;
  }

  const auto replays = [&](const std::string& what) {
    auto player = record::Player::open(file);
    ASSERT_TRUE(player) << player.error().text;
    auto bone = small_bone();
    ASSERT_EQ(bone->content_hash(), (*player)->info().volume.content_hash);
    const auto outcome = replay(**player, std::move(bone), quiet);
    ASSERT_TRUE(outcome) << outcome.error().text;
    EXPECT_FALSE(outcome->first_different_tick.has_value()) << what << ": " << outcome->difference;
    EXPECT_EQ(outcome->gaps, 0U) << what;
    EXPECT_EQ(outcome->ticks, kept) << what;
    tally.ticks += outcome->ticks;
    tally.bricks += outcome->bricks;
  };
  replays("as it was left");
  if (kept > 0) {
    auto bone = small_bone();
    const Status there = (*opened)->bone_at((*opened)->seconds(), *bone);
    EXPECT_TRUE(there) << there.error().text;
  }
  const auto report = record::repair(file, file, quiet);
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_FALSE(report->was_whole);
  EXPECT_EQ(report->ticks, kept);
  ++tally.repaired;
  if (again) replays("repaired");
  auto player = record::Player::open(file);
  ASSERT_TRUE(player) << player.error().text;
  EXPECT_TRUE((*player)->finished());
  EXPECT_EQ((*player)->end_tick(), kept);
}

TEST(Killed, AtAnyMomentItOpensLacksATenthOfASecondAtMostAndReplaysToTheBit) {
  const char* command = std::getenv("BURR_KILLS");
  const int kills = command != nullptr ? std::atoi(command) : 40;
  const char* given = std::getenv("BURR_SEED");
  const std::uint64_t seed =
      given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
  std::printf("%d kills; again the same with BURR_SEED=%llu\n", kills,
              static_cast<unsigned long long>(seed));
  Random random(seed);
  void* memory =
      ::mmap(nullptr, sizeof(Told), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);

  burr::test::Folder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::all);
  const std::string file = folder / "s.mcap";
  Tally paced, fast;
  int unborn = 0;
  for (int n = 0; n < kills && !HasFailure(); ++n) {
    Told& told = *new (memory) Told{};
    const double stolen_before = stolen_ms();
    std::filesystem::remove(file);
    const bool realtime = n % 4 != 3, humble = ::getuid() == 0 && random() % 2 == 0;
    const bool early = random() % 16 == 0;
    const std::uint64_t child_seed = random();
    const auto moment = std::chrono::microseconds(
        early ? random() % 120'000 : random() % (realtime ? 700'000 : 250'000));
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) mill_until_killed(file, realtime, humble, child_seed, told);
    int state = 0;
    // an early one may die before its recording has a beginning
    const auto patience = std::chrono::steady_clock::now() + 60s;
    pid_t ended = 0;
    while (!early && !told.started && (ended = ::waitpid(child, &state, WNOHANG)) == 0 &&
           std::chrono::steady_clock::now() < patience)
      std::this_thread::sleep_for(1ms);
    if (ended == child) {  // it could not start: there is nothing to kill, and this is only a
                           // mishap
      std::printf("kill %d: the child could not begin, it ended with %d\n", n,
                  WIFEXITED(state) ? WEXITSTATUS(state) : -WTERMSIG(state));
      ASSERT_LE(++unborn, kills / 20) << "children cannot begin";
      continue;
    }
    std::this_thread::sleep_for(moment);
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, &state, 0), child);
    ASSERT_TRUE(WIFSIGNALED(state) && WTERMSIG(state) == SIGKILL)
        << "the child ended by itself, with " << WEXITSTATUS(state);

    const double stolen = stolen_ms() - stolen_before;
    SCOPED_TRACE("kill " + std::to_string(n) + (realtime ? ", paced" : ", as fast as possible") +
                 (humble ? ", without priority" : ""));
    Tally& tally = realtime ? paced : fast;
    if (!std::filesystem::exists(file)) {
      EXPECT_FALSE(told.started) << "a recording that had begun is not there";
      EXPECT_EQ(told.handed, 0U);
      ++tally.before_the_beginning;
      continue;
    }
    judge(file, told, realtime, stolen, n % 10 == 0, tally);
  }
  if (HasFailure()) {
    folder.keep();
    std::printf("the last one is kept: %s\n", file.c_str());
  }
  ::munmap(memory, sizeof(Told));

  for (auto [name, tally] : {std::pair{"paced", &paced}, {"as fast as possible", &fast}}) {
    std::sort(tally->lost_ms.begin(), tally->lost_ms.end());
    const std::size_t size = tally->lost_ms.size();
    const auto rank = [&](double q) {
      return size == 0 ? 0.0 : tally->lost_ms[static_cast<std::size_t>(q * double(size - 1))];
    };
    std::printf(
        "%s: %zu kills in a recording, %d before it began; lost [ms] p50 %.1f, p99 %.1f, "
        "worst %.1f; %d over 100 ms; replayed %llu ticks and %llu bricks\n",
        name, size, tally->before_the_beginning, rank(0.5), rank(0.99), rank(1), tally->excused,
        static_cast<unsigned long long>(tally->ticks),
        static_cast<unsigned long long>(tally->bricks));
  }
  EXPECT_GT(paced.bricks + fast.bricks, 0U) << "nothing was cut: the test shows nothing";
}

}  // namespace
}  // namespace burr::sim
