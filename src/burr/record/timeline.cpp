#include "burr/record/timeline.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace burr::record {

double Timeline::force_in(double from_s, double to_s) const {
  if (!(seconds > 0) || force.empty()) return 0;
  const auto part = [this](double t) {
    const double at = t / seconds * static_cast<double>(force.size());
    return at > 0 ? static_cast<std::size_t>(std::min(at, static_cast<double>(force.size() - 1)))
                  : std::size_t{0};
  };
  const std::size_t first = part(from_s), last = std::max(first, part(to_s));
  return static_cast<double>(
      *std::max_element(force.begin() + static_cast<std::ptrdiff_t>(first),
                        force.begin() + static_cast<std::ptrdiff_t>(last) + 1));
}

tool::ToolState Timeline::tool_at(double t_s) const {
  if (tools.empty()) return {};
  const auto after = std::partition_point(
      tools.begin(), tools.end(), [t_s](const TimelineTool& one) { return one.t_s <= t_s; });
  return after == tools.begin() ? after->tool : std::prev(after)->tool;
}

std::optional<double> Timeline::stroke_after(double t_s) const {
  for (const Stroke& stroke : strokes)
    if (stroke.begin_s > t_s) return stroke.begin_s;
  return std::nullopt;
}

std::optional<double> Timeline::stroke_before(double t_s) const {
  std::optional<double> found;
  for (const Stroke& stroke : strokes)
    if (stroke.begin_s < t_s) found = stroke.begin_s;
  return found;
}

TimelineMaker::TimelineMaker(double rate_hz, std::uint64_t end_tick)
    : rate_hz_(rate_hz), end_tick_(std::max<std::uint64_t>(1, end_tick)) {
  line_.seconds = static_cast<double>(end_tick) / rate_hz;
  line_.force.assign(Timeline::kParts, 0);
}

void TimelineMaker::add(const Step& step) {
  const tick::TickRow& row = step.row;
  const double t = static_cast<double>(row.tick) / rate_hz_;
  // a damaged row may contain anything
  const double force = row.contact.force.norm();
  const auto part = static_cast<std::size_t>(
      std::min(static_cast<double>(row.tick) / static_cast<double>(end_tick_) * Timeline::kParts,
               static_cast<double>(Timeline::kParts - 1)));
  if (std::isfinite(force)) {
    line_.force[part] = std::max(line_.force[part], static_cast<float>(force));
    line_.peak_force = std::max(line_.peak_force, force);
  }

  // what a gap hides may belong to many strokes; it counts at the tick after the gap
  const bool cut =
      before_ && (row.ledger.removed > before_->removed || row.ledger.added > before_->added);
  before_ = row.ledger;
  if (cut) {
    std::vector<Stroke>& strokes = line_.strokes;
    if (strokes.empty() || t - strokes.back().end_s > Timeline::kPause) strokes.push_back({t, t});
    strokes.back().end_s = t;
    const math::Vec3& normal = row.contact.normal;
    const math::Vec3 outward = normal.allFinite() && normal.norm() > 0.5
                                   ? normal
                                   : row.hand.world_from_tool.q * math::Vec3::UnitZ();
    if (!line_.work && row.contact.proxy.allFinite() && outward.allFinite())
      line_.work = {row.contact.proxy, outward};
  }

  if (line_.tools.empty() || line_.tools.back().tool != row.tool)
    line_.tools.push_back({t, row.tool});
  // if several burrs were requested in one tick, the row shows the outcome of the last
  const auto last = std::find_if(
      step.commands.rbegin(), step.commands.rend(),
      [](const tick::Command& one) { return one.kind == tick::CommandKind::burr_radius; });
  for (const tick::Command& command : step.commands) {
    if (command.kind == tick::CommandKind::shed) continue;  // that one is the servo's
    if (command.kind == tick::CommandKind::shift_piece || command.kind == tick::CommandKind::let_go)
      continue;  // many, between a lift and where it is put down
    const bool refused =
        last != step.commands.rend() && &command == &*last && row.tool.radius != command.value;
    line_.events.push_back({t, command, refused});
  }
}

Timeline TimelineMaker::finish() { return std::move(line_); }

Result<Timeline> timeline_of(Player& player, Progress& progress) {
  TimelineMaker maker(player.info().rate_hz, player.end_tick());
  StepCursor steps = player.steps();
  Step step;
  while (steps.next(step)) {
    if (step.row.tick % 4096 == 0) {
      if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
      progress.report(static_cast<double>(step.row.tick) / static_cast<double>(player.end_tick()),
                      "reading what happened");
    }
    maker.add(step);
  }
  return maker.finish();
}

}  // namespace burr::record
