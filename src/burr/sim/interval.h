// sim/interval.h - one interval of an experiment with people: a wall of given stiffness, friction
// or vibration in the hand for some seconds, through the whole servo.
//
//     Wall wall([] { return scenes::wall(); }, WallSettings{});
//     Result<people::Felt> felt = wall.show(hand, {.stiffness = 400}, 3.0, {});
//
// Touch only, nothing is cut. Each interval begins without force, waits for a hand in free air,
// comes by the start ramp, passes every limit, and ends in a fade of 5 ms. A simulated hand is
// ticked as fast as possible; a real one by the clock, in a Session of its own with its watchdog.
//
// Thread: one; with a real hand the session has its own. Memory: a bone and a servo for each
// interval. Frame: world. Units: SI.
#pragma once

#include <functional>
#include <memory>

#include "burr/device/device.h"
#include "burr/people/experiment.h"
#include "burr/people/felt.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::sim {

// What the wall does.
struct Shown {
  double stiffness = 500;  // [N/m]
  double friction = 0;     // coefficient, sticking and sliding alike [-]
  double vibration = 0;    // root mean square [N]
};

struct WallSettings {
  double rate_hz = 1000;
  double burr_radius = 2e-3;     // [m]
  double user_force = 3.3;       // the user's own limit [N]
  double vibration_hz = 200;     // middle of its band; 60 to 250
  double other_stiffness = 500;  // of the wall, where something else is asked [N/m]
};

class Wall {
 public:
  static constexpr double kMostVibration = 0.15;  // haptics/vibration.h [N]

  using Bone = std::function<std::unique_ptr<volume::Bone>()>;
  Wall(Bone bone, const WallSettings& settings);
  ~Wall();

  // What an experiment's value means.
  [[nodiscard]] Shown of(people::Stimulus stimulus, double value) const;

  // Can this device show it? The sentence says what it can.
  [[nodiscard]] Status possible(const device::DeviceSpec& spec, const Shown& shown) const;

  // The hand, open already, feels it for so long, or until enough() says so. What it felt is
  // returned. Error: the device cannot, or the session could not be made.
  [[nodiscard]] Result<people::Felt> show(device::Device& hand, const Shown& shown, double seconds,
                                          const std::function<bool()>& enough);

  [[nodiscard]] const WallSettings& settings() const { return settings_; }

 private:
  Bone make_;
  WallSettings settings_;
  std::unique_ptr<volume::Bone> bone_;
  std::unique_ptr<volume::IsoVertices> surface_;
};

}  // namespace burr::sim
