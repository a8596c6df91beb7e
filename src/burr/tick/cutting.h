// tick/cutting.h - what the turning tool does to the bone, and the bone to the tool, in a tick.
//
//     spindle: turn()  ->  friction()         before touch
//     drag(), vibration(), torque()           on the hand, from the cut of the tick before
//     cut()                                   push -> energy (edit/laws/) -> carver, or brush
//
// Thread: servo. Frame: world. Units: SI. Memory: taken at construction.
#pragma once

#include <cstddef>
#include <cstdint>

#include "burr/edit/bone_writer.h"
#include "burr/edit/brush.h"
#include "burr/edit/carve.h"
#include "burr/edit/laws/chip_law.h"
#include "burr/edit/laws/elements.h"
#include "burr/edit/laws/removal.h"
#include "burr/edit/undo.h"
#include "burr/haptics/vibration.h"
#include "burr/rt/rt.h"
#include "burr/thermal/heat_rows.h"
#include "burr/tick/controls.h"
#include "burr/tick/hand.h"
#include "burr/tick/rows.h"
#include "burr/tick/settings.h"
#include "burr/tool/shaped_tool.h"
#include "burr/tool/spindle.h"
#include "burr/volume/bone.h"

namespace burr::tick {

class Cutting {
 public:
  // which: 0 the first hand's, 1 the second's
  Cutting(const volume::Bone& bone, edit::UndoStore& undo, edit::BoneWriter& writer,
          const Controls& controls, const Hand& hand, std::size_t which = 0);
  // The other hand's, if it cuts too: a stroke is over when neither has touched for a while. Before
  // the session.
  void set_beside(const Cutting* other) { beside_ = other; }

  // Of a custom law, in each tick before cut(); it may pay for the cut. Before the session.
  void set_law(const LawRow* law) { law_ = law; }

  [[nodiscard]] tool::Spindle& spindle() BURR_RT { return spindle_; }
  [[nodiscard]] const tool::Spindle& spindle() const BURR_RT { return spindle_; }
  void turn(double pedal) BURR_RT { spindle_.step(pedal, now_.torque, dt_); }
  // Coefficient of friction of the tool on the bone that it touched in the last tick [-].
  [[nodiscard]] double friction() const BURR_RT;

  // Of the bone on the burr, along its surface, as the hand gets it. touched: force of touch [N].
  [[nodiscard]] math::Vec3 drag(const math::Vec3& touched) BURR_RT;
  // Of the spindle's vibration [N].
  [[nodiscard]] math::Vec3 vibration() BURR_RT;
  // Of the bone on a tool of any shape about its tip, across the shaft: along it the motor takes it.
  // After drag() [N m].
  [[nodiscard]] math::Vec3 moment() const BURR_RT;
  // Of the motor on the handpiece [N m].
  [[nodiscard]] math::Vec3 torque() const BURR_RT;

  // The bone's part of the tick. touched: force of touch that was really sent [N]; may: false while
  // bone is put back; path_mark: for the stroke that begins here (restore.h).
  void cut(std::uint64_t tick, const math::Vec3& touched, bool may, std::uint64_t path_mark,
           std::uint32_t& flags) BURR_RT;

  // Another tool is in the hand, as the settings say.
  void take_tool() BURR_RT;

  // ---- as of the last cut
  [[nodiscard]] const edit::Cutting& now() const BURR_RT { return now_; }
  [[nodiscard]] int bricks_last() const BURR_RT { return carver_.bricks_last(); }
  // Material was put on in this session, so that tissues have changed as well.
  [[nodiscard]] bool deposited() const BURR_RT { return deposited_; }
  // What warms the bone.
  struct Warming {
    double power = 0;                       // [W]
    math::Vec3 place = math::Vec3::Zero();  // [m]
    thermal::Edge edge = thermal::Edge::flute;
    double radius = 0;  // of the part, or half its thickness  [m]
  };
  [[nodiscard]] Warming warming() const BURR_RT;
  // The same of parts that turn or stroke and never cut, as a shaft that leans on bone.
  [[nodiscard]] const Warming& rubbing() const BURR_RT { return rubbing_; }

 private:
  [[nodiscard]] const volume::Tissue& touched_tissue() const BURR_RT;
  [[nodiscard]] const volume::Tissue& rubbed_tissue() const BURR_RT;
  [[nodiscard]] bool tooth_is_carried() const BURR_RT;
  void cut_tool(std::uint64_t tick, const math::Vec3& touched, bool may, std::uint64_t path_mark,
                std::uint32_t& flags) BURR_RT;
  // How hard the cutting parts press, and along which normal.
  struct Press {
    math::Vec3 normal = math::Vec3::Zero();  // unit, out of the bone
    double push = 0;                         // [N]
  };
  [[nodiscard]] Press press(const math::Vec3& touched) const BURR_RT;
  [[nodiscard]] edit::Cutting by_law(const Press& press, double speed) BURR_RT;
  [[nodiscard]] edit::Cutting by_own_law(const Press& press) const BURR_RT;
  // ---- a tool of any shape (shaped_cutting.cpp)
  [[nodiscard]] const tool::ShapedTool* shaped() const BURR_RT;
  [[nodiscard]] edit::Stroke stroke_now() const BURR_RT;
  void rub(const math::Vec3& touched) BURR_RT;
  [[nodiscard]] bool drive_moves(double push) const BURR_RT;
  void cut_shaped(double push, bool may, std::uint32_t& flags, std::uint64_t path_mark) BURR_RT;
  void swing_mallet() BURR_RT;
  [[nodiscard]] int teeth() const BURR_RT;
  [[nodiscard]] edit::ElementCutting by_elements(double per_stretch) BURR_RT;
  void place_body(edit::Cut& cut) BURR_RT;
  [[nodiscard]] const volume::Tissue& tissue_at(const math::Vec3& world) const BURR_RT;
  [[nodiscard]] bool works(double push, bool may) BURR_RT;
  [[nodiscard]] bool rests_long() const BURR_RT { return untouched_ > settings_.stroke_pause; }
  void brush(const edit::Cut& cut, std::uint32_t& flags) BURR_RT;

  const volume::Bone& bone_;
  edit::UndoStore& undo_;
  const Controls& controls_;
  const ServoSettings& settings_;  // of the controls
  const Hand& hand_;
  const Cutting* beside_ = nullptr;
  const LawRow* law_ = nullptr;
  double dt_;
  edit::Carver carver_;
  edit::Brush brush_;
  edit::Chips chips_;
  haptics::Vibration vibration_;
  tool::Spindle spindle_;
  edit::Cutting now_;                           // in the last tick
  math::Vec3 cut_normal_ = math::Vec3::Zero();  // of the contact that cut
  edit::ToolBody body_;                         // cutting parts of the tool in the hand
  double body_reach_ = 0;    // of the tool's touching parts               [voxel]
  double blow_left_ = 0;     // energy of the mallet's last blow             [J]
  double since_blow_ = 1e9;  // [s]
  double burr_speed_ = 0;    // of the burr at full pedal, while a tool is in the hand
  math::Vec3 warm_place_ = math::Vec3::Zero();  // of a tool of any shape               [m]
  double warm_radius_ = 0;                      // half the thickness of what cut there [m]
  Warming rubbing_;                             // in the last tick
  double last_push_ = 0;                        // of touch alone, along the normal [N]
  double last_load_ = 0;                        // the same of all parts, also those that rub [N]
  math::Vec3 drag_ = math::Vec3::Zero();        // of the bone on the burr, as the hand gets it [N]
  double drag_ratio_ = 0;                       // over the push, likewise
  math::Vec3 cut_moment_ = math::Vec3::Zero();  // of the last cut of a shaped tool [N m]
  math::Vec3 moment_ = math::Vec3::Zero();      // the same, as slow as drag_
  double drag_share_ = 0;                       // of drag_ that the hand got in this tick
  double tooth_phase_ = 0;                      // [rad]
  double untouched_ = 0;                        // since the last contact of the open stroke [s]
  bool deposited_ = false;
};

}  // namespace burr::tick
