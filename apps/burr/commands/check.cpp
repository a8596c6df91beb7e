// burr check - is this computer good enough? A thousand ticks a second, alone and with full load,
// compared with a loop that only waits.
//
// The exit code is 0 when it could measure, whatever the result: scripts read "verdict" from
// --json.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <nlohmann/json.hpp>

#include "bench/machine_trial.h"
#include "burr/rt/machine_check.h"
#include "burr/workshop/hand_device.h"
#include "devices/springs_words.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options : MachineTrial {
  workshop::HandRequest hand;
  bool json = false;
};

nlohmann::json json_of(const rt::TickSummary& t) {
  return {
      {"ticks", t.ticks},
      {"missed", t.missed},
      {"work_us", {{"p50", t.p50_us}, {"p99", t.p99_us}, {"p999", t.p999_us}, {"max", t.max_us}}},
      {"late_us",
       {{"p50", t.late_p50_us},
        {"p99", t.late_p99_us},
        {"p999", t.late_p999_us},
        {"max", t.worst_lateness_us}}}};
}

void print_row(const char* what, const rt::TickSummary& t, bool works) {
  const std::string work = works ? fmt::format("{:7.0f} {:7.0f} {:7.0f} {:7.0f}", t.p50_us,
                                               t.p99_us, t.p999_us, t.max_us)
                                 : fmt::format("{:>7} {:>7} {:>7} {:>7}", "-", "-", "-", "-");
  fmt::print("{:<26} {}  {:7.0f} {:7.0f} {:7.0f} {:7.0f} {:8}\n", what, work, t.late_p50_us,
             t.late_p99_us, t.late_p999_us, t.worst_lateness_us, t.missed);
}

void print(const rt::MachineMeasurements& seen, const rt::MachineReport& judged,
           const std::vector<std::string>& left_out, const std::vector<std::string>& device) {
  for (const rt::CheckLine& line : judged.lines) {
    fmt::print("{:<16} {}\n", line.what, line.value);
    if (!line.change.empty()) fmt::print("{:<16}   change: {}\n", "", line.change);
  }
  fmt::print("\n{:<26} {:^31}  {:^31} {:>8}\n", "1000 ticks a second [us]", "work of a tick",
             "begins late by", "left out");
  fmt::print("{:<26} {:>7} {:>7} {:>7} {:>7}  {:>7} {:>7} {:>7} {:>7}\n", "", "p50", "p99", "p99.9",
             "worst", "p50", "p99", "p99.9", "worst");
  print_row("a loop that only waits", seen.waiting, false);
  print_row("milling", seen.milling, true);
  print_row("waiting, all else at work", seen.waiting_loaded, false);
  print_row("milling, all else at work", seen.milling_loaded, true);
  for (const std::string& sentence : left_out) fmt::print("{}\n", sentence);
  for (const std::string& sentence : device) fmt::print("{}\n", sentence);
  fmt::print("\n{}\n", judged.sentence);
}

void print_json(const rt::MachineMeasurements& seen, const rt::MachineReport& judged,
                const std::vector<std::string>& left_out, const std::vector<std::string>& device) {
  const rt::Machine& m = seen.machine;
  nlohmann::json out;
  out["verdict"] = rt::name(judged.verdict);
  out["sentence"] = judged.sentence;
  out["reasons"] = judged.reasons;
  out["machine"] = {
      {"processor", m.processor},
      {"cores", m.cores},
      {"core_quota", m.core_quota},
      {"simd", m.simd},
      {"kernel", m.kernel},
      {"preemption", m.preemption},
      {"preempt_rt", m.preempt_rt()},
      {"clock_source", m.clock_source},
      {"governor", m.governor},
      {"virtual_machine", m.virtual_machine},
      {"fifo_limit", m.fifo_limit},
      {"locked_bytes", m.locked_bytes == rt::kNoLimit ? nlohmann::json("unlimited")
                                                      : nlohmann::json(m.locked_bytes)}};
  out["fifo"] = seen.grant.fifo;
  out["memory_locked"] = seen.grant.locked;
  out["waiting"] = json_of(seen.waiting);
  out["milling"] = json_of(seen.milling);
  out["waiting_loaded"] = json_of(seen.waiting_loaded);
  out["milling_loaded"] = json_of(seen.milling_loaded);
  for (const rt::CheckLine& line : judged.lines)
    out["lines"].push_back({{"what", line.what}, {"is", line.value}, {"change", line.change}});
  out["left_out"] = left_out;
  if (!device.empty()) out["device"] = device;
  fmt::print("{}\n", json_line(out));
}

// What the device can do about the torque of a contact; nothing moves and no force is sent.
Result<std::vector<std::string>> device_words(const workshop::HandRequest& hand) {
  if (hand.device.empty()) return std::vector<std::string>();
  auto laid = workshop::open_hand(hand, {}, math::Quat::Identity());
  if (!laid) return laid.error();
  std::vector<std::string> words = springs_words(laid->hand->spec());
  words.insert(words.begin(), laid->id + ":");
  laid->hand->close();
  return words;
}

Status run(const Options& options) {
  const auto device = device_words(options.hand);
  if (!device) return device.error();
  auto measured = measure_machine(options);
  if (!measured) return measured.error();
  const rt::MachineReport judged = rt::judge(measured->seen);
  if (options.json) {
    print_json(measured->seen, judged, measured->left_out, *device);
  } else {
    print(measured->seen, judged, measured->left_out, *device);
  }
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("check", "is this computer good enough for a haptic device?");
  command
      ->add_option("--seconds", options->seconds, "length of the measurement, in three equal parts")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--voxel-mm", options->voxel_mm,
                   "voxel edge of the built-in bone that is milled")
      ->check(CLI::Range(0.1, 1.0))
      ->capture_default_str();
  command->add_option("--device", options->hand.device,
                      "also say what this haptic device does with the torque of a contact");
  command->add_flag("!--no-picture", options->picture, "draw no picture during the measurement");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{75, add};

}  // namespace
}  // namespace burr::app
