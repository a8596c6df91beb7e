// sim/trial_interval.h - one interval of an experiment with people: the hand feels a wall of given
// stiffness, friction or vibration for some seconds, through the whole servo.
//
//     Wall wall([] { return scenes::wall(); }, WallSettings{});
//     Result<people::Felt> felt = wall.show(hand, {.stiffness = 400}, 3.0, {});
//
// Touch only, no cutting. Each interval begins without force, waits until the hand is in free air,
// raises the force by the start ramp, obeys every limit, and ends with a fade of 5 ms. A simulated
// hand runs as fast as possible; a real one in real time, in a Session of its own with its
// watchdog.
//
// Thread: one; with a real hand the session has its own threads. Memory: a bone and a servo for
// each interval. Frame: world. Units: SI.
#pragma once

#include <functional>
#include <memory>

#include "burr/device/device.h"
#include "burr/people/experiment.h"
#include "burr/people/felt.h"
#include "burr/volume/bone.h"
#include "burr/volume/iso_vertices.h"

namespace burr::sim {

// The properties of the wall.
struct WallProperties {
  double stiffness = 500;  // [N/m]
  double friction = 0;     // coefficient, static and dynamic alike [-]
  double vibration = 0;    // root mean square [N]
};

struct WallSettings {
  double rate_hz = 1000;
  double burr_radius = 2e-3;     // [m]
  double user_force = 3.3;       // the user's own limit [N]
  double vibration_hz = 200;     // middle of its band; 60 to 250 [Hz]
  double other_stiffness = 500;  // stiffness of the wall where the experiment is about another
                                 // quantity [N/m]
};

class Wall {
 public:
  static constexpr double kMostVibration = 0.15;  // haptics/vibration.h [N]

  using Bone = std::function<std::unique_ptr<volume::Bone>()>;
  Wall(Bone bone, const WallSettings& settings);
  ~Wall();

  // The wall that shows an experiment's value.
  [[nodiscard]] WallProperties of(people::Stimulus stimulus, double value) const;

  // Checks that this device can show it. The error says what it can show.
  [[nodiscard]] Status check_device(const device::DeviceSpec& spec,
                                    const WallProperties& shown) const;

  // The hand, already open, feels the wall for `seconds`, or until enough() is true. Returns what
  // it felt. Error: the device cannot show it, or the session could not be made.
  [[nodiscard]] Result<people::Felt> show(device::Device& hand, const WallProperties& shown,
                                          double seconds, const std::function<bool()>& enough);

  [[nodiscard]] const WallSettings& settings() const { return settings_; }

 private:
  Bone make_;
  WallSettings settings_;
  std::unique_ptr<volume::Bone> bone_;
  std::unique_ptr<volume::IsoVertices> surface_;
};

}  // namespace burr::sim
