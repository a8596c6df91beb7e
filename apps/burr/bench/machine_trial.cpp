#include "bench/machine_trial.h"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "bench/full_load_run.h"
#include "burr/device/simulated_hand.h"
#include "burr/rt/idle_loop.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

constexpr double kRate = 1000;    // [Hz]
constexpr double kBurr = 2.5e-3;  // radius [m]

// A file that is removed with this object.
struct Scratch {
  std::string file;
  Scratch() {
    std::error_code trouble;
    const auto folder = std::filesystem::temp_directory_path(trouble);
    file = (folder / fmt::format("burr_check_{}.mcap", getpid())).string();
  }
  ~Scratch() {
    std::error_code nobody_asks;
    std::filesystem::remove(file, nobody_asks);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
};

// A session on the built-in bone that mills pockets.
struct Bench {
  std::unique_ptr<sim::Session> session;
  surgeon::WorkPlace place;
  importing::ImportSummary import;
  scenario::BoneRecipe volume;
};

Result<Bench> make_bench(const MachineTrial& options, double seconds) {
  Bench bench;
  bench.volume.source = "phantom:temporal-bone";
  bench.volume.voxel_mm = options.voxel_mm;
  auto opened = workshop::open_bone(bench.volume, progress());
  if (!opened) return opened.error();
  bench.import = opened->summary;
  auto place = surgeon::find_work_place(*opened->bone, kBurr, {}, {});
  if (!place) return place.error();
  bench.place = *place;
  auto path = surgeon::motion("pocket", *place, kBurr, std::max(2.0, seconds + 1));
  if (!path) return path.error();
  sim::SessionSettings settings;
  settings.realtime = true;
  settings.servo.rate_hz = kRate;
  settings.servo.burr.radius = kBurr;
  auto made =
      workshop::begin_by_itself(std::move(opened->bone), std::move(*path), settings, progress());
  if (!made) return made.error();
  bench.session = std::move(*made);
  return bench;
}

rt::TickSummary wait_only(double seconds) {
  rt::IdleLoop loop(kRate, {.name = "waiting", .realtime = true});
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end && !interrupted())
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return loop.stop();
}

}  // namespace

Result<MachineTrialResult> measure_machine(const MachineTrial& options) {
  const double each = options.seconds / 3;
  MachineTrialResult out;
  rt::MachineMeasurements& seen = out.seen;
  seen.machine = rt::read_machine();

  progress().report(0, "a loop that only waits");
  seen.waiting = wait_only(each);
  {
    auto bench = make_bench(options, each);
    if (!bench) return bench.error();
    progress().report(0, "milling");
    WholeOptions alone;
    alone.seconds = each;
    alone.picture = false;
    auto milled =
        run_whole(*bench->session, bench->place, bench->volume, bench->import, alone, progress());
    if (!milled) return milled.error();
    seen.milling = milled->session.timing;
  }
  {
    auto bench = make_bench(options, each);
    if (!bench) return bench.error();
    const Scratch scratch;
    WholeOptions all;
    all.seconds = each;
    all.picture = options.picture;
    all.record = scratch.file;
    all.busy = std::max(1, seen.machine.cores - 1);
    all.waiting_beside = true;
    auto milled =
        run_whole(*bench->session, bench->place, bench->volume, bench->import, all, progress());
    if (!milled) return milled.error();
    seen.milling_loaded = milled->session.timing;
    seen.waiting_loaded = milled->waiting;
    seen.grant = bench->session->grant();
    out.left_out = milled->left_out;
  }
  if (seen.milling_loaded.ticks < 100 || seen.waiting_loaded.ticks < 100)
    return error(
        Trouble::internal,
        fmt::format("only {} ticks could be measured in {:.1f} s: no verdict; try a larger "
                    "--seconds",
                    seen.milling_loaded.ticks, each));
  return out;
}

}  // namespace burr::app
