// metrics/moment.h - one tick of a recording, as the measures of a process read it.
//
//     MomentReader reader(player);
//     Moment now;
//     while (reader.next(now)) for (auto& one : measures) one.add(now);
//
// A tick with a number that is not finite is left out and counted, as is the volume that was cut in a
// gap: nobody knows where. Frame: world. Units: SI. Thread: one. Memory: none per tick.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "burr/math/pose.h"
#include "burr/math/vec3.h"
#include "burr/record/player.h"
#include "burr/tick/rows.h"
#include "burr/tool/cutting_places.h"
#include "burr/tool/shaped_tool.h"
#include "burr/tool/state.h"

namespace burr::metrics {

// Share of its full speed from which on a burr counts as turning.
inline constexpr double kTurning = 0.05;

struct Moment {
  std::uint64_t tick = 0;
  double t = 0;                            // since the start of the session [s]
  double dt = 0;                           // that this tick stands for: 1 / rate [s]
  math::Vec3 centre = math::Vec3::Zero();  // of the burr's head: the proxy [m]
  math::Vec3 hand = math::Vec3::Zero();    // tip of the tool as the hand holds it [m]
  math::Vec3 shaft = math::Vec3::UnitZ();  // unit, from the head to the handle
  math::Vec3 normal = math::Vec3::Zero();  // unit, out of the bone; zero in free air
  double force = 0;                        // size of the force on the hand [N]
  bool touching = false;
  bool turning = false;  // spindle above kTurning of its full speed
  bool stalled = false;  // the bone holds the spindle
  bool gap = false;      // ticks before this one are missing
  // The shaft rests on bone, as the session felt it; false in every tick: shaft_felt tells why.
  bool shaft_rests = false;
  bool shaft_felt = false;            // a shaft that can touch is in the hand
  double removed = 0;                 // in this tick [m^3]; 0 after a gap
  double speed = 0, asked_speed = 0;  // of the spindle, without its sign; of the pedal [rad/s]
  double torque = 0, power = 0;       // of the bone on the burr [N m]; that goes into the bone [W]
  double twist = 0;                   // torque of the contact that the hand did not get [N m]
  tool::ToolState tool;               // radius: of a tool of the rack half its width
  // A tool of the rack: its cutting parts, and how it is turned about `centre`; nullptr: a round burr. Of the
  // maker, which must live as long.
  const tool::Places* parts = nullptr;
  math::Quat turn = math::Quat::Identity();
  [[nodiscard]] bool cutting() const { return removed > 0; }
  // False: the recording does not say how large the burr is; nothing then has a distance to it.
  [[nodiscard]] bool radius_known() const { return std::isfinite(tool.radius) && tool.radius > 0; }
};

// Ticks in order become moments.
class MomentMaker {
 public:
  // shaft_felt: the session's round burrs touch with their shafts (--touch shaft).
  // tools: of the session, other than the round burr.
  explicit MomentMaker(double rate_hz, bool shaft_felt = false,
                       const std::vector<tool::ShapedTool>& tools = {});
  // False: the tick is unusable. The first tick counts as one that removes nothing.
  [[nodiscard]] bool make(const tick::TickRow& row, bool gap, Moment& moment);

  [[nodiscard]] std::uint64_t unusable() const { return unusable_; }
  [[nodiscard]] double lost_removed() const { return lost_removed_; }  // cut in gaps [m^3]

 private:
  double rate_hz_;
  bool shaft_felt_;
  std::vector<tool::Places> tools_;
  std::optional<double> removed_;  // ledger of the tick before
  std::uint64_t unusable_ = 0;
  double lost_removed_ = 0;
};

class MomentReader {
 public:
  explicit MomentReader(record::Player& player);
  [[nodiscard]] bool next(Moment& moment);
  [[nodiscard]] const MomentMaker& account() const { return maker_; }

 private:
  MomentMaker maker_;
  record::StepCursor steps_;
  record::Step step_;
};

}  // namespace burr::metrics
