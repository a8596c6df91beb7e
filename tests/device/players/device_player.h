// A test's model of a device's user, the same for every driver: moves the hand, presses its
// buttons, unplugs the device, and reads the force on the wire.
//
// Frame: burr's for a device, x right, y up, z to the user. Units: SI. Thread: the test's; what the
// fake device shares with its own threads is protected by its own lock.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/device/device.h"
#include "burr/device/link.h"

namespace burr::test {

// A position that the device reported, and the force that came next.
struct Felt {
  math::Vec3 told, force;
};

class Player {
 public:
  Player() = default;
  Player(const Player&) = delete;
  Player& operator=(const Player&) = delete;
  virtual ~Player() = default;

  // The driver, connected to the fake device.
  [[nodiscard]] virtual std::unique_ptr<device::Device> device(
      const device::LinkSettings& link) = 0;

  // Sets the hand's position and velocity.
  virtual void hold(const math::Vec3& place, const math::Vec3& velocity) = 0;
  // False: the device has no such button, or the driver does not read it.
  [[nodiscard]] virtual bool mill(bool down) = 0;
  [[nodiscard]] virtual bool clutch(bool down) = 0;
  virtual void unplug() = 0;
  virtual void plug_in() = 0;

  // Present force on the wire, and the largest so far [N].
  [[nodiscard]] virtual math::Vec3 force() = 0;
  [[nodiscard]] virtual double largest() = 0;
  // All pairs since the last call.
  [[nodiscard]] virtual std::vector<Felt> felt() = 0;

  // Never exceeded on the wire [N]; the maker's value, written here independently of the driver.
  [[nodiscard]] virtual double limit() const = 0;
  // How many readings a force may be late.
  [[nodiscard]] virtual int most_late() const { return 0; }
  // Calls of the driver that the real device forbids; empty: none.
  [[nodiscard]] virtual std::string misuse() { return {}; }
};

}  // namespace burr::test
