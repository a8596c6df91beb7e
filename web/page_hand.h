// web/page_hand.h - the hand of a session in the page: the mouse's, or for a while that of a recording, which brings a session back that
// a reload or a crash has ended. Thread: one.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "burr/device/device.h"
#include "burr/mouse/mouse_hand.h"
#include "burr/tick/command.h"

namespace burr::web {

// A tick of a recording: its reading, and the hash of what it gave. From the module that reads recordings to the one that ticks.
struct RedoTick {
  std::uint64_t tick = 0, hash = 0;
  device::HandState hand;
};
// What was taken at its start.
struct RedoCommand {
  std::uint64_t tick = 0;
  std::int32_t kind = 0;  // tick::CommandKind
  double value = 0;
};

class PageHand final : public device::Device {
 public:
  explicit PageHand(const math::Pose& start) : mouse_(start) {}

  void aim(const mouse::MouseHand::Aim& aim) { mouse_.aim(aim); }
  // The reading of the next tick, in place of the mouse's.
  void repeat(const device::HandState& reading) { repeated_ = reading; }

  Status open() override { return mouse_.open(); }
  void close() override { mouse_.close(); }
  [[nodiscard]] const device::DeviceSpec& spec() const override { return mouse_.spec(); }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override {
    if (!repeated_) return mouse_.state(dt);
    return *std::exchange(repeated_, std::nullopt);
  }
  void write_force(const math::Vec3& force) BURR_RT override { mouse_.write_force(force); }
  void scale_force(double scale) BURR_RT override { mouse_.scale_force(scale); }

 private:
  mouse::MouseHand mouse_;
  std::optional<device::HandState> repeated_;
};

}  // namespace burr::web
