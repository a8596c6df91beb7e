// burr bench endure - a long session with everything running: are the ticks in time, does memory
// grow?
//
// Milling in real time with surface worker, off-screen renderer and recorder; during it, before and
// after it a loop that only waits. The same pocket of 20 s is milled again and again on the same
// bone, which is restored in between, so that every minute is like the one before.
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/bench.h"
#include "bench/full_load_run.h"
#include "burr/device/simulated_hand.h"
#include "burr/rt/idle_loop.h"
#include "burr/tick/flag_words.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/picture_size.h"
#include "shared/setting_options.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

constexpr double kPocket = 20;     // [s]
constexpr double kAllowed = 1.10;  // p99.9 of lateness relative to a loop that only waits ...
constexpr double kResolved = 5;    // ... and the difference between two such loops [us]

struct Options {
  scenario::BoneRecipe volume;
  WholeOptions whole;
  double burr_mm = 5, rate_hz = 1000, waiting_s = 10;
  bool json = false;
};

rt::TickSummary wait_only(double rate_hz, double seconds) {
  rt::IdleLoop loop(rate_hz, {.name = "waiting", .realtime = true});
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (std::chrono::steady_clock::now() < end && !interrupted())
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return loop.stop();
}

nlohmann::json lateness(const rt::TickSummary& t) {
  return {{"ticks", t.ticks},     {"missed", t.missed},     {"p50", t.late_p50_us},
          {"p99", t.late_p99_us}, {"p999", t.late_p999_us}, {"max", t.worst_lateness_us}};
}

void print(const Options& options, const WholeOutcome& out, const rt::TickSummary& before,
           const rt::TickSummary& after) {
  const rt::TickSummary& t = out.session.timing;
  const double idle = std::max({before.late_p999_us, out.waiting.late_p999_us, after.late_p999_us});
  const double grew = memory_grew_mb(out.memory);
  if (!options.json) {
    fmt::print("{:.0f} s, {} ticks: work p50 {:.0f}, p99 {:.0f}, p99.9 {:.0f}, worst {:.0f} us\n",
               options.whole.seconds, t.ticks, t.p50_us, t.p99_us, t.p999_us, t.max_us);
    const auto row = [](const char* what, const rt::TickSummary& one) {
      fmt::print(
          "late: {:<28} p50 {:.0f}, p99 {:.0f}, p99.9 {:.0f}, worst {:.0f} us, {} left out\n", what,
          one.late_p50_us, one.late_p99_us, one.late_p999_us, one.worst_lateness_us, one.missed);
    };
    row("the tick", t);
    row("a waiting loop, meanwhile", out.waiting);
    row("waiting loop alone, before", before);
    row("waiting loop alone, after", after);
    fmt::print("memory {:.1f} MB at first, {:.1f} MB at last; grew by {:.1f} MB after settling\n",
               out.memory.front().mb, out.memory.back().mb, grew);
    fmt::print("{} pictures, the longest wait for one {:.2f} s; {} patches; removed {:.1f} mm3\n",
               out.frames, out.longest_frame_s, out.patches, 1e9 * out.session.ledger.removed);
    for (const std::string& sentence : out.left_out) fmt::print("{}\n", sentence);
    return;
  }
  nlohmann::json json;
  json["seconds"] = options.whole.seconds;
  json["rate_hz"] = options.rate_hz;
  json["ticks"] = t.ticks;
  json["tick_us"] = {{"p50", t.p50_us}, {"p99", t.p99_us}, {"p999", t.p999_us}, {"max", t.max_us}};
  json["late_us"] = {{"tick", lateness(t)},
                     {"waiting_beside", lateness(out.waiting)},
                     {"waiting_before", lateness(before)},
                     {"waiting_after", lateness(after)}};
  json["no_later_than_waiting"] = t.late_p999_us <= kAllowed * idle + kResolved;
  json["waiting_alone_s"] = options.waiting_s;
  for (const MemoryRow& one : out.memory) json["memory_MB"].push_back({one.s, one.mb});
  json["memory_grew_MB"] = grew;
  json["frames"] = out.frames;
  json["longest_frame_s"] = out.longest_frame_s;
  json["patches"] = out.patches;
  json["patches_waiting_most"] = out.patches_waiting_most;
  json["recorded"] = {{"ticks", out.recorded.ticks},
                      {"bricks", out.recorded.brick_rows},
                      {"dropped_ticks", out.recorded.dropped_ticks},
                      {"dropped_wishes", out.recorded.dropped_commands},
                      {"dropped_bricks", out.recorded.dropped_bricks},
                      {"bytes", out.recorded.bytes},
                      {"longest_pause_s", out.recorded.longest_pause_s}};
  const edit::Ledger& ledger = out.session.ledger;
  json["asked_mm3"] = 1e9 * ledger.asked;
  json["removed_mm3"] = 1e9 * ledger.removed;
  json["not_cut_mm3"] = 1e9 * ledger.not_cut;
  json["owed_mm3"] = 1e9 * ledger.debt;
  json["noted"] = tick::words(tick::worth_telling(out.session.flags));
  json["load_ticks"] = out.session.shed_ticks;
  json["most_put_off"] = tick::name(out.session.most_shed);
  json["peak_force_N"] = out.session.peak_force;
  json["scheduling"] = out.session.scheduling;
  json["left_out"] = out.left_out;
  fmt::print("{}\n", json_line(json));
}

Status run(Options options) {
  if (options.volume.source.empty()) options.volume.source = "phantom:temporal-bone";
  const Status possible =
      check_outputs({options.volume.source}, {{"--record", options.whole.record, {".mcap"}}});
  if (!possible) return possible;
  std::string scratch;  // a recording that the user did not request
  if (options.whole.record.empty()) {
    std::error_code trouble;
    scratch = (std::filesystem::temp_directory_path(trouble) /
               fmt::format("burr_endure_{}.mcap", getpid()))
                  .string();
    options.whole.record = scratch;
  }
  auto opened = workshop::open_bone(options.volume, progress());
  if (!opened) return opened.error();
  const double radius = 0.5e-3 * options.burr_mm;
  auto place = surgeon::find_work_place(*opened->bone, radius, {}, {});
  if (!place) return place.error();
  const double each = std::min(kPocket, std::max(2.0, options.whole.seconds / 2));
  auto pockets = pockets_again(*place, radius, each, options.whole.seconds + each);
  if (!pockets) return pockets.error();
  sim::SessionSettings settings;
  settings.realtime = true;
  settings.servo.rate_hz = options.rate_hz;
  settings.servo.burr.radius = radius;
  auto made = workshop::begin_by_itself(std::move(opened->bone), std::move(pockets->path), settings,
                                        progress());
  if (!made) return made.error();

  progress().report(0, "a loop that only waits");
  const rt::TickSummary before = wait_only(options.rate_hz, options.waiting_s);
  options.whole.waiting_beside = true;
  options.whole.reset_first = pockets->lifted;
  options.whole.reset_every = pockets->every;
  auto out = run_whole(**made, *place, options.volume, opened->summary, options.whole, progress());
  if (!scratch.empty()) {
    std::error_code nobody_asks;
    std::filesystem::remove(scratch, nobody_asks);
  }
  if (!out) return out.error();
  const rt::TickSummary after = wait_only(options.rate_hz, options.waiting_s);
  print(options, *out, before, after);
  return fine();
}

void add(CLI::App& bench, Todo& todo) {
  auto options = std::make_shared<Options>();
  options->whole.seconds = 600;
  auto* command = bench.add_subcommand("endure", "run a long session with everything at work");
  command->add_option("volume", options->volume.source,
                      "file, DICOM folder, or phantom:NAME (default: phantom:temporal-bone)");
  command->add_option("--seconds", options->whole.seconds, "length of milling")
      ->check(CLI::Range(4.0, 36'000.0))
      ->capture_default_str();
  command
      ->add_option("--waiting-seconds", options->waiting_s,
                   "length of the loop that only waits, before and after")
      ->check(CLI::Range(0.5, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--memory-every", options->whole.memory_every, "seconds between memory readings")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command->add_option("--busy", options->whole.busy, "threads that only use processor time")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  add_setting_option(*command, "burr_mm", options->burr_mm);
  add_setting_option(*command, "rate_hz", options->rate_hz);
  command->add_option("--record", options->whole.record,
                      "F.mcap: keep the recording (default: record and delete it)");
  command->add_flag("!--no-picture", options->whole.picture,
                    "draw no picture during the measurement");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  add_picture_size(*command, options->whole.size);
  add_volume_options(*command, options->volume);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const BenchCommand command{50, add};

}  // namespace
}  // namespace burr::app
