#include "burr/metrics/moment.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/math/turn.h"
#include "burr/rt/flags.h"

namespace burr::metrics {
namespace {

bool usable(const tick::TickRow& row) {
  return row.contact.proxy.allFinite() && row.contact.normal.allFinite() &&
         row.contact.force.allFinite() && row.hand.world_from_tool.finite() &&
         std::isfinite(row.ledger.removed) && std::isfinite(row.spindle_rad_s);
}

// The session began with the method of touch that feels the shaft.
bool feels_shaft(const record::SessionInfo& info) {
  constexpr double kShaftMethod = 7;  // of docs/use/recording_fields.md
  const auto found = info.numbers.find("touch_method");
  return found != info.numbers.end() && found->second == kShaftMethod;
}

// Contact may have turned the tool away from the hand.
math::Quat turn_of_tool(const tick::TickRow& row) {
  const math::Vec3& turn = row.contact.turn;
  if (!turn.allFinite()) return row.hand.world_from_tool.q;
  return math::product(math::rotation_of(turn), row.hand.world_from_tool.q);
}

}  // namespace

MomentMaker::MomentMaker(double rate_hz, bool shaft_felt,
                         const std::vector<tool::ShapedTool>& tools)
    : rate_hz_(rate_hz), shaft_felt_(shaft_felt) {
  for (const tool::ShapedTool& one : tools) tools_.push_back(tool::places_on_surface(one.tool));
}

bool MomentMaker::make(const tick::TickRow& row, bool gap, Moment& moment) {
  if (!usable(row)) {
    ++unusable_;
    return false;
  }
  moment.tick = row.tick;
  moment.t = static_cast<double>(row.tick) / rate_hz_;
  moment.dt = 1 / rate_hz_;
  moment.centre = row.contact.proxy;
  moment.hand = row.hand.world_from_tool.p;
  moment.shaft = row.hand.world_from_tool.q * math::Vec3::UnitZ();
  moment.normal = row.contact.normal;
  moment.force = math::norm(row.contact.force);
  moment.touching = row.contact.touching;
  moment.turning =
      std::abs(row.spindle_rad_s) > kTurning * std::max(std::abs(row.tool.full_speed), 1.0);
  moment.gap = gap;
  moment.stalled = (row.contact.flags & rt::kFlagStalled) != 0;
  moment.shaft_rests = (row.contact.flags & rt::kFlagShaft) != 0;
  moment.shaft_felt = shaft_felt_ || row.tool.number >= 0 || moment.shaft_rests;
  moment.speed = std::abs(row.spindle_rad_s);
  moment.asked_speed = row.hand.pedal * std::abs(row.tool.full_speed);
  moment.torque = row.cutting_nm;
  moment.power = row.cutting_w;
  moment.twist = math::norm(row.contact.unsent_torque);
  moment.tool = row.tool;
  const bool shaped = row.tool.number >= 0 && row.tool.number < static_cast<int>(tools_.size());
  moment.parts = shaped ? &tools_[static_cast<std::size_t>(row.tool.number)] : nullptr;
  if (shaped) {
    moment.tool.radius = moment.parts->half_width;
    moment.turn = turn_of_tool(row);
  }
  const double rise = removed_ ? row.ledger.removed - *removed_ : 0;
  moment.removed = gap ? 0 : std::max(0.0, rise);
  if (gap) lost_removed_ += std::max(0.0, rise);
  removed_ = row.ledger.removed;
  return true;
}

MomentReader::MomentReader(record::Player& player)
    : maker_(player.info().rate_hz, feels_shaft(player.info()), player.info().tools),
      steps_(player.steps()) {}

bool MomentReader::next(Moment& moment) {
  bool gap = false;
  while (steps_.next(step_)) {
    gap = gap || step_.gap;
    if (maker_.make(step_.row, gap, moment)) return true;
    gap = true;
  }
  return false;
}

}  // namespace burr::metrics
