#include "window/mill/drill.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

#include "burr/tool/burr_tool.h"
#include "burr/tool/shaped_tool.h"

namespace burr::app {
namespace {

// diameters of the burrs [m]
constexpr double kSizes[] = {0.6e-3, 0.8e-3, 1e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 3.5e-3,
                             4e-3,   4.5e-3, 5e-3, 5.5e-3, 6e-3, 6.5e-3, 7e-3};
constexpr double kRpmStep = 5000, kRpmMost = 80'000;
constexpr double kRpm = 2 * std::numbers::pi / 60;
constexpr auto kRefused =
    std::chrono::milliseconds(300);  // after this time without it, the servo has refused it

Word says(tick::ToolMode mode) {
  switch (mode) {
    case tick::ToolMode::cut:
      break;
    case tick::ToolMode::add:
      return Word::now_add;
    case tick::ToolMode::touch:
      return Word::now_touch;
    case tick::ToolMode::restore:
      return Word::now_back;
    case tick::ToolMode::smooth:
      return Word::now_smooth;
  }
  return Word::now_cut;
}

}  // namespace

Drill::Drill(sim::Session& session, render::Burr& shown)
    : session_(session),
      shown_(shown),
      mode_(session.settings().servo.mode),
      full_speed_(session.settings().servo.spindle_rad_s),
      tool_(session.settings().servo.tool),
      burr_speed_(full_speed_),
      irrigated_(session.settings().servo.irrigated) {
  const tool::Burr& burr = session.settings().servo.burr;
  shown_.radius = burr.radius;
  shown_.diamond = burr.kind == tool::BurrKind::diamond;
  shown_.shaft_radius = burr.shaft_radius;
  shown_.shaft_length = burr.shaft_length;
  if (tool_ < 0) return;
  const auto number = static_cast<std::size_t>(tool_);
  full_speed_ = usual_speed_ = tool::full_speed(session.settings().servo.tools[number].cutter);
}

// Only the round burr adds, smooths and brings back.
std::string Drill::set_mode(tick::ToolMode mode) {
  mode_ = mode;
  if (tool_ >= 0 && mode != tick::ToolMode::cut && mode != tick::ToolMode::touch)
    static_cast<void>(take_tool(-1, nullptr));
  session_.command({tick::CommandKind::tool_mode, static_cast<double>(mode)});
  return word(says(mode));
}

std::string Drill::take_tool(int number, const scenario::RackTool* tool) {
  if (number == tool_) return {};
  if (tool_ < 0) burr_speed_ = full_speed_;
  tool_ = number;
  session_.command({tick::CommandKind::tool, static_cast<double>(number)});
  usual_speed_ = tool != nullptr ? tool::full_speed(tool->cutter) : 0;
  full_speed_ = tool != nullptr ? usual_speed_ : burr_speed_;
  if (tool == nullptr || mode_ == tick::ToolMode::cut || mode_ == tick::ToolMode::touch) return {};
  return set_mode(tick::ToolMode::cut);
}

std::string Drill::next_burr() {
  if (tool_ >= 0) return word(Word::tool_one_size);
  const double largest = *std::rbegin(kSizes);
  const bool over = 2 * requested_.value_or(session_.burr_radius()) > largest - 1e-9;
  if (over) requested_ = 0;
  return change_burr(1);
}

std::string Drill::change_burr(int by) {
  if (tool_ >= 0) return word(Word::tool_one_size);
  const double least = least_size();
  const double now = 2 * requested_.value_or(session_.burr_radius());
  std::optional<double> next;
  for (const double size : kSizes) {
    if (size < least - 1e-9) continue;
    if (by > 0 && size > now + 1e-9 && !next) next = size;
    if (by < 0 && size < now - 1e-9) next = size;
  }
  if (!next) return say(Word::no_burr, std::ceil(1e4 * least) / 10, 1e3 * tool::kLargestDiameter);
  requested_ = 0.5 * *next;
  requested_at_ = Clock::now();
  session_.command({tick::CommandKind::burr_radius, *requested_});
  return {};
}

std::string Drill::slower() { return change_speed(-kRpmStep); }
std::string Drill::faster() { return change_speed(kRpmStep); }

std::string Drill::change_speed(double by_rpm) {
  if (tool_ >= 0) return change_tool_speed(by_rpm > 0 ? 1 : -1);
  const double rpm =
      std::clamp(std::round(full_speed_ / kRpm / kRpmStep) * kRpmStep + by_rpm, kRpmStep, kRpmMost);
  full_speed_ = rpm * kRpm;
  session_.command({tick::CommandKind::spindle_speed, full_speed_});
  return say(Word::speed_now, rpm);
}

// In tenths of its own speed.
std::string Drill::change_tool_speed(int by) {
  if (usual_speed_ <= 0) return word(Word::tool_no_motor);
  const double tenths = std::clamp(std::round(10 * full_speed_ / usual_speed_) + by, 1.0, 10.0);
  full_speed_ = 0.1 * tenths * usual_speed_;
  session_.command({tick::CommandKind::spindle_speed, full_speed_});
  return say(Word::tool_speed_now, 10 * tenths);
}

std::string Drill::toggle_kind() {
  if (tool_ >= 0) return word(Word::tool_one_size);
  shown_.diamond = !shown_.diamond;
  session_.command({tick::CommandKind::burr_kind, shown_.diamond ? 1.0 : 0.0});
  return word(shown_.diamond ? Word::now_diamond : Word::now_fluted);
}

guidance::BurrChoice Drill::burr_for(const scenario::Step& step) const {
  std::vector<double> sizes;
  for (const double size : kSizes)
    if (size >= least_size() - 1e-9) sizes.push_back(size);
  const auto kind = shown_.diamond ? tool::BurrKind::diamond : tool::BurrKind::cutting;
  return guidance::burr_for(step, {kind, 2 * requested_.value_or(session_.burr_radius())}, sizes);
}

std::string Drill::suit(const scenario::Step& step) {
  std::string line;
  const bool works = mode_ == tick::ToolMode::cut || mode_ == tick::ToolMode::add;
  if (works && step.adds != (mode_ == tick::ToolMode::add))
    line = set_mode(step.adds ? tick::ToolMode::add : tick::ToolMode::cut);
  if (tool_ >= 0) line = take_tool(-1, nullptr);
  const guidance::BurrChoice burr = burr_for(step);
  if ((burr.kind == tool::BurrKind::diamond) != shown_.diamond) line = toggle_kind();
  if (std::abs(burr.diameter - 2 * session_.burr_radius()) < 1e-9) return line;
  requested_ = 0.5 * burr.diameter;
  requested_at_ = Clock::now();
  session_.command({tick::CommandKind::burr_radius, *requested_});
  return line;
}

double Drill::least_size() const {
  return std::max(tool::kSmallestDiameter, 4 * session_.bone().grid().voxel);  // as tick/servo.cpp
}

std::string Drill::toggle_coolant() {
  irrigated_ = !irrigated_;
  session_.command({tick::CommandKind::irrigation, irrigated_ ? 1.0 : 0.0});
  return word(irrigated_ ? Word::coolant_on : Word::coolant_off);
}

std::string Drill::look() {
  const double radius = session_.burr_radius();
  shown_.radius = radius;
  if (!requested_) return {};
  const bool there = std::abs(radius - *requested_) < 1e-9;
  if (!there && Clock::now() - requested_at_ < kRefused) return {};
  requested_.reset();
  return there ? say(Word::burr_now, 2e3 * radius) : std::string(word(Word::no_room));
}

}  // namespace burr::app
