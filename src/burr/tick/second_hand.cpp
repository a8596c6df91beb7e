#include "burr/tick/second_hand.h"

#include <algorithm>
#include <cmath>

#include "burr/rt/flags.h"

namespace burr::tick {
namespace {

using math::Vec3;

// of the proxy in a tick: the first hand's tick is the one that must not be late
constexpr int kMoves = 6;

SecondHandSettings capped(SecondHandSettings settings, const device::DeviceSpec& spec,
                          double voxel) {
  settings.radius = std::max(settings.radius, 2 * voxel);
  settings.force.stiffness = std::min(settings.force.stiffness, spec.max_stiffness);
  settings.force.damping = std::min(settings.force.damping, spec.max_damping);
  return settings;
}

}  // namespace

SecondHand::SecondHand(const volume::IsoVertices& surface, device::Device& device,
                       const SecondHandSettings& settings, double rate_hz)
    : device_(device),
      settings_(capped(settings, device.spec(), surface.bone().grid().voxel)),
      dt_(1 / rate_hz),
      proxy_(surface,
             {.radius = settings_.radius,
              .friction_static = settings_.friction,
              .friction_kinetic = settings_.friction,
              .max_moves = kMoves,
              .recovery = 5 / rate_hz},
             surface.bone().grid().world_from_grid(Vec3::Constant(-1e4))),
      limit_(device.spec(), settings_.limit) {}

void SecondHand::step(bool lost, bool parted) BURR_RT {
  row_ = {};
  row_.tick = next_tick_++;
  std::uint32_t& flags = row_.contact.flags;
  row_.hand = device_.state(dt_);
  if (lost) {
    limit_.restart();
    flags |= rt::kFlagWatchdog;
    faults_.raise();
  }
  const bool believed = limit_.believe(row_.hand, flags);
  if (!believed) faults_.raise();
  if (parted || (row_.hand.buttons & device::kLifted) != 0) {
    limit_.lift();
    engaged_ = false;
  }

  haptics::Touch touched;
  touched.proxy = proxy_.position();
  if (believed) {
    const double blend = 1 - std::exp(-2 * M_PI * settings_.velocity_filter_hz * dt_);
    velocity_ += blend * (row_.hand.velocity - velocity_);
    touched = touch(row_.hand.world_from_tool.p);
  } else {
    velocity_ = Vec3::Zero();
  }

  const Vec3 wanted = haptics::force_law(touched, velocity_, settings_.force);
  haptics::Contact& contact = row_.contact;
  contact.force = limit_.apply(wanted, dt_, flags);
  device_.write_force(contact.force);
  contact.proxy = touched.proxy;
  contact.normal = touched.normal;
  contact.depth = touched.depth;
  contact.active = touched.active;
  contact.candidates = touched.candidates;
  contact.touching = touched.touching;
  if (touched.lagging) flags |= rt::kFlagLagging;
  if (touched.overflow) flags |= rt::kFlagCandidates;
  faults_.note(row_);
  view_.publish(row_);
}

haptics::Touch SecondHand::touch(const Vec3& hand) BURR_RT {
  if (!engaged_) {  // at the start, or after it was lifted: wait until it is in free air
    haptics::Touch none;
    none.proxy = hand;
    if (!proxy_.is_free(hand)) return none;
    proxy_.place(hand);
    engaged_ = true;
  }
  return proxy_.step(hand);
}

}  // namespace burr::tick
