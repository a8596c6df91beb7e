// apps/burr/verify/workbench.h - one bone, one hand, one burr: a tick without devices, force limits
// and recordings, in which one thing can be changed while the rest is as in the servo. The hand is
// the servo's (tick/hand.h); its force goes to the simulated arm without a limit.
//
// Thread: one. Frame: world. Units: SI.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "burr/device/device.h"
#include "burr/device/simulated_hand.h"
#include "burr/edit/carve.h"
#include "burr/edit/laws/removal.h"
#include "burr/haptics/force_law.h"
#include "burr/phantom/build.h"
#include "burr/tick/hand.h"
#include "burr/tick/touch_methods.h"

namespace burr::app {

struct WorkSettings {
  double rate_hz = 1000;
  double radius = 2e-3;      // [m]
  double spindle = 4188.79;  // [rad/s]
  double stiffness = 1000;   // [N/m]
  double damping = 0.5;      // [N s/m]
  double slip_m_s = 30e-3;   // as the servo's [m/s]
  int carve_every = 1;       // ticks between two cuts; a cut removes for all of them
  haptics::Method touch = haptics::Method::constraint;
  edit::RemovalSettings removal = {};
};

// A simulated arm whose path can be replaced; the hand of the bench stays the same.
class BenchArm final : public device::Device {
 public:
  void follow_path(const device::HandPath& path, const device::ArmSettings& arm) {
    now_ = std::make_unique<device::SimulatedHand>(path, arm);
  }
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override { return now_->state(dt); }
  void write_force(const math::Vec3& force) BURR_RT override { now_->write_force(force); }

 private:
  device::DeviceSpec spec_;
  std::unique_ptr<device::SimulatedHand> now_;
};

class Workbench {
 public:
  // One row per tick.
  struct Row {
    double t = 0;
    math::Vec3 hand, proxy, force = math::Vec3::Zero();
    double push = 0;     // component along the contact normal [N]
    double energy = 0;   // spent on cutting since the start [J]
    double removed = 0;  // since the start                  [m^3]
  };

  Workbench(const phantom::Depth& depth, const volume::Grid& grid,
            const volume::TissueTable& tissues, const WorkSettings& settings);

  Workbench(std::unique_ptr<volume::Bone> bone, const WorkSettings& settings);

  // Called in every tick between touch and cutting.
  std::function<void(const haptics::Touch&, const math::Vec3& hand)> watch;
  // Follows the path with this arm; cut: whether the burr cuts.
  std::vector<Row> work(const device::HandPath& path, const device::ArmSettings& arm, bool cut);

  [[nodiscard]] volume::Bone& bone() { return *bone_; }
  [[nodiscard]] const volume::IsoVertices& surface() const { return surface_; }
  [[nodiscard]] edit::Ledger ledger() const { return carver_.ledger(); }

 private:
  NoProgress quiet_;
  WorkSettings settings_;
  std::unique_ptr<volume::Bone> bone_;
  volume::IsoVertices surface_;
  edit::UndoStore undo_;
  edit::BoneWriter writer_;
  edit::Carver carver_;
  tick::TouchMethods touch_by_;
  haptics::ForceSettings force_;
  BenchArm arm_;
  tick::Hand hand_;
  std::uint64_t tick_ = 0;
  double energy_ = 0;
};

// A path through points at these times; the pedal is down from the second point on.
struct Knot {
  double t;
  math::Vec3 p;
};
[[nodiscard]] device::HandPath path_through(const std::vector<Knot>& knots);

// Depth of the hole below z = top on the line (x, y), from the field. [m]
[[nodiscard]] double depth_of_hole(const volume::Bone& bone, double x, double y, double top);

// Amplitude of frequency f [Hz] in values sampled at rate_hz, after subtracting their mean.
[[nodiscard]] double wave_at(const std::vector<double>& values, double rate_hz, double f);

}  // namespace burr::app
