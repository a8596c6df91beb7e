// tick/servo.h - the tick: the hand comes first, then the bone.
//
//     read the hand - obey commands - step the proxy - force law - energy guard
//     - drag of the bone on the burr and vibration - limit - write the force
//     - then carve - then tell the others
//
// A pure function of (bone, hand, buttons, commands, lost): no clock, no random number, so that a
// recording replays to the bit. Thread: tick() on one thread, the servo's, the only writer of the
// bone. Memory: taken at construction. Cost: docs/realtime.md.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "burr/device/device.h"
#include "burr/edit/brush.h"
#include "burr/edit/carve.h"
#include "burr/edit/changed_queue.h"
#include "burr/edit/laws/chips.h"
#include "burr/edit/laws/removal.h"
#include "burr/edit/mirror.h"
#include "burr/edit/undo.h"
#include "burr/haptics/force_law.h"
#include "burr/haptics/safety/energy_guard.h"
#include "burr/haptics/safety/limit.h"
#include "burr/haptics/touch_method.h"
#include "burr/haptics/vibration.h"
#include "burr/rt/latest.h"
#include "burr/rt/ring.h"
#include "burr/thermal/worker.h"
#include "burr/tick/fault_report.h"
#include "burr/tick/rows.h"
#include "burr/tick/shed.h"
#include "burr/tick/touch_methods.h"
#include "burr/tool/burr_tool.h"
#include "burr/tool/spindle.h"
#include "burr/tool/state.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

using ToolMode = tool::Mode;
inline constexpr int kToolModes = tool::kModes;

struct ServoSettings {
  double rate_hz = 1000;
  haptics::Method touch = haptics::Method::constraint;
  tool::Burr burr;
  double spindle_rad_s = 4188.79;  // at full pedal: 40 000 rpm; below 0: backwards
  tool::Motor motor;
  haptics::ForceSettings force;
  bool guarded = false;        // by the energy guard; not by default: docs/status.md
  double guard_slack = 60e-6;  // that the guard lets pass, energy_guard.h               [J]
  bool irrigated = false;      // coolant runs from the start
  double drag_gain = 1;        // of the bone's drag on the turning burr in the hand
  double drag_hz = 5;          // it follows no faster, first order: see docs/decisions.md
  double vibration_gain = 0;   // of the spindle in the hand: 1 as haptics/vibration.h says, 0 none
  double torque_gain = 1;      // of the motor on the hand, where the device can turn it
  haptics::LimitSettings limit;
  edit::RemovalSettings removal;
  edit::CarveSettings carve;
  ToolMode mode = ToolMode::cut;
  double friction_scale = 1;        // of the tissues' own friction
  double friction_turning = 0.05;   // what is left of it while the spindle turns            [-]
  double kinetic_share = 0.9;       // sliding friction over sticking friction               [-]
  double velocity_filter_hz = 100;  // of the hand's velocity, first order
  double deposit_rate = 5e-9;  // at full pedal                                          [m^3/s]
  volume::TissueId deposit_tissue = 1;
  double stroke_pause = 0.3;        // a stroke ends after so long without contact           [s]
  double lift_speed = 50e-3;        // of the burr before an undo                             [m/s]
  std::size_t undo_bricks = 16384;  // that all remembered strokes may touch together
};

// The diary's rings (record/recorder.h); nullptr: nobody writes.
struct Diary {
  rt::Ring<TickRow>* ticks = nullptr;
  rt::Ring<CommandRow>* commands = nullptr;
  rt::Ring<BrickRow>* bricks = nullptr;
};

class Servo {
 public:
  Servo(volume::Bone& bone, volume::IsoVertices& surface, device::Device& device,
        const ServoSettings& settings);

  // One tick. lost: ticks were lost just before this one and the watchdog let go of the hand.
  const TickRow& tick(bool lost) BURR_RT;

  // What to put off from the next tick on; recorded as a command when it changes. Between ticks, on
  // the servo's thread.
  void set_shed(Shed shed) BURR_RT { shed_requested_ = shed; }
  [[nodiscard]] Shed shed() const BURR_RT { return shed_; }

  // ---- doors (docs/realtime.md, "Doors")
  [[nodiscard]] rt::Ring<Command>& commands() BURR_RT { return commands_; }  // main -> servo
  [[nodiscard]] rt::Latest<TickRow>& view() BURR_RT { return view_; }        // servo -> main
  [[nodiscard]] rt::Latest<FaultReport>& faults() BURR_RT { return faults_.reports(); }  // likewise
  // of the burr's head as it is now: a command for a larger one is refused where it has no room [m]
  [[nodiscard]] double burr_radius() const BURR_RT {
    return burr_radius_.load(std::memory_order_relaxed);
  }
  // The hand neither feels nor cuts, and will not until it was in free air once: a fault let go of
  // it in contact, or it came back inside bone. As of the last tick; any thread.
  [[nodiscard]] bool let_go() const BURR_RT { return let_go_.load(std::memory_order_relaxed); }
  void set_diary(const Diary& diary) { diary_ = diary; }  // before the session
  // One more who sees every row, on a thread of its own; before the session. nullptr: nobody.
  void set_watch(rt::Latest<TickRow>* watch) { watch_ = watch; }
  void set_heat(thermal::Worker* heat) { heat_ = heat; }  // servo -> heat; before the session

  // How long the last tick took and how late it began, for the diary and the view; not part of the
  // truth.
  void note_timing(double took_us, double late_us) BURR_RT;
  // Hands the finished row to the diary and the view.
  void publish() BURR_RT;

  // What the last tick had to do, in counts that are the same on every machine.
  struct Work {
    int candidates = 0;  // contacts looked at
    int bricks = 0;      // that the burr stood in while cutting
    int rebuilt = 0;     // bricks whose surface was made anew
  };
  [[nodiscard]] Work work() const BURR_RT {
    return {row_.contact.candidates, carver_.bricks_last(), surface_.rebuilt_last()};
  }

  [[nodiscard]] const ServoSettings& settings() const BURR_RT { return settings_; }
  [[nodiscard]] const edit::UndoStore& undo_store() const BURR_RT { return undo_; }
  [[nodiscard]] std::size_t bricks_to_write() const BURR_RT { return changed_.size(); }
  [[nodiscard]] bool restoring() const BURR_RT { return restore_ != Restore::none; }
  // Everything still owed to the diary, regardless of budget; after the last tick.
  void flush_bricks() BURR_RT;
  // Takes the memory that undo will need next; every few milliseconds while it ticks, from one
  // other thread.
  void take_ahead() { undo_.take_ahead(); }

 private:
  enum class Restore { none, lifting, restoring, settling };

  void obey(const Command& command) BURR_RT;
  void take_commands() BURR_RT;
  void note_tool() BURR_RT;
  void begin_restore(CommandKind kind) BURR_RT;
  void step_restore() BURR_RT;
  [[nodiscard]] bool clear_of_what_returns(const math::Vec3& p) const BURR_RT;
  void touch_bone(const math::Vec3& hand) BURR_RT;
  void let_go_in_bone() BURR_RT;
  [[nodiscard]] math::Vec3 passive(const math::Vec3& wanted, bool begins_anew) BURR_RT;
  [[nodiscard]] math::Vec3 buzz() BURR_RT;
  [[nodiscard]] math::Vec3 turn(bool believed) BURR_RT;
  [[nodiscard]] math::Vec3 drag(const math::Vec3& touched) BURR_RT;
  [[nodiscard]] const volume::Tissue& touched_tissue() const BURR_RT;
  void choose_friction() BURR_RT;
  [[nodiscard]] bool tooth_is_carried() const BURR_RT;
  [[nodiscard]] edit::Cutting cut_by_law(double push, double speed) BURR_RT;
  void cut_bone(const math::Vec3& force) BURR_RT;
  void brush_bone(const edit::Cut& cut) BURR_RT;
  void tell_heat() BURR_RT;
  void remember_path() BURR_RT;
  void write_bricks(std::size_t most) BURR_RT;
  void hash_row() BURR_RT;

  volume::Bone& bone_;
  volume::IsoVertices& surface_;
  device::Device& device_;
  ServoSettings settings_;
  double dt_;

  rt::Latest<TickRow>* watch_ = nullptr;
  edit::ChangedQueue changed_;
  edit::UndoStore undo_;
  edit::Carver carver_;
  edit::Brush brush_;
  edit::Chips chips_;
  TouchMethods touch_by_;
  haptics::EnergyGuard guard_;
  haptics::Vibration vibration_;
  haptics::ForceLimit limit_;
  tool::Spindle spindle_;
  haptics::Touch touch_;
  device::HandState hand_;
  math::Vec3 velocity_ = math::Vec3::Zero();
  Shed shed_ = Shed::none, shed_requested_ = Shed::none;
  bool engaged_ = false;                  // the proxy is somewhere free and follows the hand
  bool irrigated_ = false;                // coolant runs: for the worker that knows the heat
  bool deposited_ = false;                // material was put on in this session
  edit::Mirror mirror_;                   // across which everything is done to the bone likewise
  double last_push_ = 0;                  // of touch alone, along the normal [N]
  edit::Cutting cutting_;                 // in the last tick
  math::Vec3 drag_ = math::Vec3::Zero();  // of the bone on the burr, as the hand gets it [N]
  double drag_ratio_ = 0;                 // over the push, likewise
  double tooth_phase_ = 0;                // [rad]
  double untouched_ = 0;                  // since the last contact of the open stroke [s]

  // the way the proxy came, to go back on before an undo
  static constexpr std::size_t kPath = 1 << 16;
  std::vector<math::Vec3> path_;
  std::uint64_t path_end_ = 0;
  Restore restore_ = Restore::none;
  CommandKind restore_kind_ = CommandKind::undo;
  edit::UndoStore::Range range_;
  std::uint64_t restored_ = 0, path_at_ = 0;
  double lift_since_check_ = 0;

  rt::Ring<Command> commands_{256};
  rt::Latest<TickRow> view_;
  FaultKeeper faults_;
  std::atomic<double> burr_radius_;
  std::atomic<bool> let_go_ = false;
  Diary diary_;
  thermal::Worker* heat_ = nullptr;
  thermal::HeatRow heat_row_;
  TickRow row_;
  std::uint64_t next_tick_ = 0, last_hash_ = 0;
};

// Without what every good session raises: the start ramp, and waiting for it; the guard at work.
[[nodiscard]] constexpr std::uint32_t worth_telling(std::uint32_t flags) {
  return flags & ~(haptics::kFlagRamp | haptics::kFlagWaiting | haptics::kFlagSlewLimited |
                   haptics::kFlagGuarded);
}

// In words, one sentence a flag, with the cure where there is one.
[[nodiscard]] std::vector<std::string> words(std::uint32_t flags);

}  // namespace burr::tick
