// The results of a trial as a table for a terminal, a page to send, or JSON.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "burr/base/markup.h"
#include "burr/base/version.h"
#include "devices/trial.h"
#include "shared/html_page.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

std::vector<std::pair<std::string, std::string>> rows_of(const TrialMeasurements& s) {
  std::vector<std::pair<std::string, std::string>> rows;
  const auto row = [&rows](const char* what, std::string is) {
    rows.emplace_back(what, std::move(is));
  };
  const device::DeviceSpec& spec = s.spec;
  row("device", spec.serial.empty() ? spec.name : spec.name + ", serial number " + spec.serial);
  if (!spec.software.empty()) row("its software", spec.software);
  row("senses, drives", fmt::format("{} and {} degrees of freedom", spec.sensed, spec.actuated));
  row("force",
      fmt::format("{:.2f} N peak, {:.2f} N continuous", spec.peak_force, spec.continuous_force));
  row("wall", fmt::format("up to {:.0f} N/m", spec.max_stiffness));
  row("rate", fmt::format("{:.1f} readings used per second; the device states {:.0f} Hz", s.rate_hz,
                          spec.native_rate));
  row("between two ticks", fmt::format("{:.0f} us median, {:.0f} p99, {:.0f} longest",
                                       s.interval_p50_us, s.interval_p99_us, s.interval_max_us));
  row("ticks",
      fmt::format("{}; {} left out, {} without a valid reading", s.ticks, s.missed, s.invalid));
  row("answered within",
      fmt::format("{:.0f} us median, {:.0f} p99, {:.0f} longest, from the arrival of a reading",
                  s.answer_p50_us, s.answer_p99_us, s.answer_max_us));
  row("noise at rest",
      fmt::format("{:.1f}, {:.1f}, {:.1f} um; its velocity {:.2f} mm/s", 1e6 * s.noise.x(),
                  1e6 * s.noise.y(), 1e6 * s.noise.z(), 1e3 * s.speed_noise));
  for (const AxisMeasurement& axis : s.axes)
    row(axis.asked.c_str(),
        axis.done
            ? fmt::format("moved {:.1f}, {:.1f}, {:.1f} mm: {:.0f} degrees off{}",
                          1e3 * axis.went.x(), 1e3 * axis.went.y(), 1e3 * axis.went.z(),
                          axis.off_deg, axis.off_deg > 30 ? " - an axis is turned or mirrored" : "")
            : "not done");
  row("pressed",
      fmt::format("{} times, {:.1f} mm deep, up to {:.2f} N; commanded stiffness {:.0f} N/m; on "
                  "the way back the force was at most {:.0f} degrees off the wall's normal",
                  s.presses, 1e3 * s.deepest, s.most_force, s.stiffness, s.aside_deg));
  for (const std::string& sentence : s.left_out) row("left out", sentence);
  return rows;
}

}  // namespace

std::string trial_text(const TrialMeasurements& seen) {
  std::string text;
  for (const auto& [name, value] : rows_of(seen)) text += fmt::format("{:<18} {}\n", name, value);
  return text;
}

std::string trial_page(const TrialMeasurements& seen) {
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>burr: a device tried</title>"
      "<style>{}</style>\n<h1>{}</h1>\n<table>\n",
      kPageStyle, base::markup_text(seen.spec.name));
  for (const auto& [name, value] : rows_of(seen))
    page += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", base::markup_text(name),
                        base::markup_text(value));
  return page + fmt::format("</table>\n<footer>burr {} ({})</footer></html>\n", base::version(),
                            base::markup_text(base::build()));
}

std::string trial_json(const TrialMeasurements& s) {
  nlohmann::json out;
  out["device"] = s.spec.name;
  out["serial"] = s.spec.serial;
  out["peak_force_N"] = s.spec.peak_force;
  out["rate_hz"] = s.rate_hz;
  out["interval_us"] = {
      {"p50", s.interval_p50_us}, {"p99", s.interval_p99_us}, {"max", s.interval_max_us}};
  out["answer_us"] = {{"p50", s.answer_p50_us}, {"p99", s.answer_p99_us}, {"max", s.answer_max_us}};
  out["ticks"] = s.ticks;
  out["missed"] = s.missed;
  out["invalid"] = s.invalid;
  out["noise_um"] = {1e6 * s.noise.x(), 1e6 * s.noise.y(), 1e6 * s.noise.z()};
  out["speed_noise_mm_s"] = 1e3 * s.speed_noise;
  for (const AxisMeasurement& axis : s.axes)
    out["axes"].push_back(
        {{"asked", axis.asked},
         {"done", axis.done},
         {"went_mm", {1e3 * axis.went.x(), 1e3 * axis.went.y(), 1e3 * axis.went.z()}},
         {"off_deg", axis.off_deg}});
  out["wall"] = {{"presses", s.presses},
                 {"deepest_mm", 1e3 * s.deepest},
                 {"most_force_N", s.most_force},
                 {"stiffness_N_m", s.stiffness},
                 {"aside_deg", s.aside_deg}};
  out["left_out"] = s.left_out;
  return json_line(out);
}

}  // namespace burr::app
