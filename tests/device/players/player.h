// A test that plays a device's user, the same for every driver: moves the hand, presses its
// buttons, pulls the plug, and feels what comes over the wire.
//
// Frame: burr's for a device, x right, y up, z to the user. Units: SI. Thread: the test's; what the
// false device shares with its own threads is under its own lock.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/device/device.h"
#include "burr/device/link.h"

namespace burr::test {

// A place that the device told, and the force that came next.
struct Felt {
  math::Vec3 told, force;
};

class Player {
 public:
  Player() = default;
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;
  virtual ~Player() = default;

  // The driver, with the false device behind it.
  [[nodiscard]] virtual std::unique_ptr<device::Device> device(
      const device::LinkSettings& link) = 0;

  // The hand is there and goes so fast.
  virtual void hold(const math::Vec3& place, const math::Vec3& velocity) = 0;
  // False: it has no such button, or none that is read.
  [[nodiscard]] virtual bool mill(bool down) = 0;
  [[nodiscard]] virtual bool clutch(bool down) = 0;
  virtual void unplug() = 0;
  virtual void plug_in() = 0;

  // On the wire just now, and the largest ever [N].
  [[nodiscard]] virtual math::Vec3 force() = 0;
  [[nodiscard]] virtual double largest() = 0;
  // All since it was asked last.
  [[nodiscard]] virtual std::vector<Felt> felt() = 0;

  // Never passed on the wire [N]; the maker's, written down once more.
  [[nodiscard]] virtual double limit() const = 0;
  // Forces that may still be of the place before, once the device told another.
  [[nodiscard]] virtual int most_late() const { return 0; }
  // What the driver did that the real one forbids; empty: nothing.
  [[nodiscard]] virtual std::string misuse() { return {}; }
};

}  // namespace burr::test
