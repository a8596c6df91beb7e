// burr bench device - time from a pose on a device's wire to its force on the wire, through the
// whole of burr, compared with a tick that does nothing on the same device in the same run.
//
// Wall time on the wire's side, from the arrival of a reading until its force is given to the
// device.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "bench/bench.h"
#include "burr/math/rotation.h"
#include "burr/rt/thread.h"
#include "burr/sim/session.h"
#include "burr/workshop/hand_device.h"
#include "shared/hand_options.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/setting_options.h"
#include "shared/volume_words.h"
#include "shared/window_session.h"
#include "shared/work.h"

namespace burr::app {
namespace {

using device::LinkStats;

struct Options {
  WorkOptions work;
  double seconds = 20, echo_s = 5;
  bool json = false;
};

// A tick that does nothing: measures wire, wake-up and scheduler.
LinkStats echo(device::Device& device, double rate_hz, double seconds) {
  std::atomic<bool> stop = false;
  {
    rt::Thread thread({.name = "servo", .realtime = true}, [&] {
      rt::TickClock* clock = device.clock(rate_hz);
      while (!stop.load(std::memory_order_relaxed)) {
        static_cast<void>(clock->wait());
        static_cast<void>(device.state(1 / rate_hz));
        device.write_force(math::Vec3::Zero());
      }
    });
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end && !interrupted())
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    stop = true;
  }
  LinkStats account;
  static_cast<void>(device.take_stats(account));
  return account;
}

nlohmann::json json_of(const LinkStats& account) {
  return {{"readings", account.readings},
          {"passed_over", account.passed_over},
          {"unanswered", account.unanswered},
          {"p50", account.answers.quantile_us(0.5)},
          {"p99", account.answers.quantile_us(0.99)},
          {"p999", account.answers.quantile_us(0.999)},
          {"max", account.answers.max_us()}};
}

void print(const char* what, const LinkStats& account) {
  fmt::print(
      "{:<20} p50 {:.0f}, p99 {:.0f}, p99.9 {:.0f}, worst {:.0f} us; {} readings, {} not answered "
      "in "
      "time, {} between ticks\n",
      what, account.answers.quantile_us(0.5), account.answers.quantile_us(0.99),
      account.answers.quantile_us(0.999), account.answers.max_us(), account.readings,
      account.unanswered, account.passed_over);
}

Status run(const Options& options) {
  WorkOptions requested = options.work;
  if (const Status taken = take_case(requested); !taken) return taken;
  LinkStats idle;
  {
    auto device = workshop::make_hand(requested.hand);
    if (!device) return device.error();
    const Status opened = (*device)->open();
    if (!opened) return opened;
    if ((*device)->clock(1000) == nullptr)
      return error(Trouble::usage, "--device: this device has no wire to measure");
    idle = echo(**device, workshop::tick_rate((*device)->spec()), options.echo_s);
    (*device)->close();
  }
  auto work = open_work(requested, progress());
  if (!work) return work.error();
  const math::Vec3 outward = -work->place.into;
  auto ready = make_window_session(requested, std::move(*work), progress());
  if (!ready) return ready.error();
  sim::Session& session = *ready->session;
  // straight down points into the bone
  ready->hands.real->set_axes(math::shortest_rotation(math::Vec3::UnitZ(), outward));
  // opened again, so that a device that moves by itself starts its path with the session
  session.hand().close();
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // a pause that the device can
                                                                // notice
  const Status again = session.hand().open();
  if (!again) return again;
  const auto began = std::chrono::steady_clock::now();
  session.run(options.seconds, progress());
  const double wall =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  LinkStats whole;
  static_cast<void>(session.hand().take_stats(whole));
  const sim::Outcome outcome = session.outcome();
  // ticks that had room in wall time, but neither came nor were counted as missed
  const double unaccounted = wall * session.settings().servo.rate_hz -
                             static_cast<double>(outcome.ticks + outcome.timing.missed);
  const double above = 1e-3 * (whole.answers.quantile_us(0.99) - idle.answers.quantile_us(0.99));
  if (options.json) {
    nlohmann::json out;
    out["device"] = session.hand().spec().name;
    out["rate_hz"] = session.settings().servo.rate_hz;
    out["echo_us"] = json_of(idle);
    out["whole_us"] = json_of(whole);
    out["p99_above_echo_ms"] = above;
    out["ticks"] = outcome.ticks;
    out["missed"] = outcome.timing.missed;
    out["wall_s"] = wall;
    out["unaccounted"] = unaccounted;
    out["tick_us"] = {{"p50", outcome.timing.p50_us},
                      {"p99", outcome.timing.p99_us},
                      {"p999", outcome.timing.p999_us},
                      {"max", outcome.timing.max_us}};
    out["removed_mm3"] = 1e9 * outcome.ledger.removed;
    out["peak_force_N"] = outcome.peak_force;
    fmt::print("{}\n", json_line(out));
    return fine();
  }
  print("an idle echo", idle);
  print("the whole of burr", whole);
  fmt::print("p99 {:.3f} ms above the echo (bar 1)\n", above);
  fmt::print(
      "{} ticks, {} left out, {:.0f} not accounted for in {:.2f} s; tick p50 {:.0f}, p99 {:.0f}, "
      "p99.9 {:.0f} us; removed {:.1f} mm3, "
      "{:.2f} N "
      "at the most\n",
      outcome.ticks, outcome.timing.missed, unaccounted, wall, outcome.timing.p50_us,
      outcome.timing.p99_us, outcome.timing.p999_us, 1e9 * outcome.ledger.removed,
      outcome.peak_force);
  return fine();
}

void add(CLI::App& bench, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command =
      bench.add_subcommand("device", "time from a pose on the wire to its force on the wire");
  command->add_option("volume", options->work.volume.source,
                      "a case or a scan (default: temporal-bone)");
  command->add_option("--seconds", options->seconds, "length of the session")
      ->check(CLI::Range(1.0, 36'000.0))
      ->capture_default_str();
  command
      ->add_option("--echo-seconds", options->echo_s, "length of the idle echo before the session")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  add_setting_option(*command, "burr_mm", options->work.burr_mm);
  command->add_flag("--json", options->json, "one JSON object");
  add_hand_options(*command, options->work.hand);
  command->add_option("--suction", options->work.suction,
                      "a second device, as for burr run: measures what it adds to the tick");
  add_volume_options(*command, options->work.volume);
  command->callback([options, &todo] {
    if (options->work.hand.device.empty()) throw CLI::RequiredError("--device");
    todo.work = [options] { return run(*options); };
  });
}

const BenchCommand command{70, add};

}  // namespace
}  // namespace burr::app
