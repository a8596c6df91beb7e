#include "burr/workshop/sound_tracker.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "burr/workshop/tool_places.h"
#include "burr/workshop/work_view.h"

namespace burr::workshop {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr double kOver = 10e-3;  // shortest time over which removal is averaged  [s]

}  // namespace

SoundTracker::SoundTracker(const tick::ServoSettings& settings, ToSpare to_spare,
                           const tool::ShapedTool* second)
    : teeth_(settings.burr.teeth), rate_hz_(settings.rate_hz), to_spare_(std::move(to_spare)) {
  for (const tool::ShapedTool& tool : settings.tools)
    tools_.push_back({tool.cutter.teeth, tool.cutter.drive, places_on(tool.tool)});
  if (second == nullptr) return;
  tick::ServoSettings others = settings;
  others.tools = {*second};
  other_ = std::make_unique<SoundTracker>(others, to_spare_);
}

// From the surface of what cuts.
double SoundTracker::distance_of(const tick::TickRow& row, const Tool* tool) const {
  if (tool == nullptr) return to_spare_(row.contact.proxy) - row.tool.radius;
  const math::Pose pose = pose_of_tool(row);
  double least = std::numeric_limits<double>::infinity();
  for (const math::Vec3& place : tool->places) least = std::min(least, to_spare_(pose * place));
  return least;
}

const sound::SoundState& SoundTracker::update(const tick::TickRow& row,
                                              const tick::TickRow* second) {
  now_.spindle_rad_s = row.spindle_rad_s;
  now_.cutting_nm = row.cutting_nm;
  now_.touching = row.contact.touching;
  const Tool* tool = nullptr;
  if (row.tool.number >= 0 && row.tool.number < static_cast<int>(tools_.size()))
    tool = &tools_[static_cast<std::size_t>(row.tool.number)];
  now_.teeth = row.tool.kind == tool::BurrKind::diamond ? 0 : teeth_;
  if (tool != nullptr) now_.teeth = tool->drive == tool::Drive::turning ? tool->teeth : 0;
  now_.strokes = tool != nullptr && (tool->drive == tool::Drive::oscillating ||
                                     tool->drive == tool::Drive::reciprocating);
  now_.struck = tool != nullptr && tool->drive == tool::Drive::struck && row.cutting_w > 0;
  now_.irrigated = row.tool.irrigated;
  if (to_spare_) now_.to_spare = distance_of(row, tool);

  Sums sums = {row.tick, row.ledger.removed, row.ledger.energy};
  if (other_ && second != nullptr) {
    static_cast<void>(other_->update(*second));
    now_.to_spare = std::min(now_.to_spare, std::exchange(other_->now_.to_spare, kFar));
    // the session's sums has what both removed
    sums.removed -= second->ledger.removed;
    sums.energy -= second->ledger.energy;
  }
  if (!before_ || sums.tick < before_->tick) before_ = sums;  // the first; a jump back
  const double seconds = static_cast<double>(sums.tick - before_->tick) / rate_hz_;
  if (seconds < kOver) return now_;
  const double removed = std::max(0.0, sums.removed - before_->removed);
  const double energy = std::max(0.0, sums.energy - before_->energy);
  now_.removal_m3_s = removed / seconds;
  if (removed > 0) now_.hardness_j_m3 = energy / removed;
  before_ = sums;
  return now_;
}

}  // namespace burr::workshop
