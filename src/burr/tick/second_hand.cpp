#include "burr/tick/second_hand.h"

#include <algorithm>

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
    : settings_(capped(settings, device.spec(), surface.bone().grid().voxel)),
      proxy_(surface,
             {.radius = settings_.radius,
              .friction_static = settings_.friction,
              .friction_kinetic = settings_.friction,
              .wedge = 0,
              .slip = settings_.slip_m_s / rate_hz,
              .max_moves = kMoves,
              .push_out_speed = 5 / rate_hz},
             surface.bone().grid().world_from_grid(Vec3::Constant(-1e4))),
      hand_(device, proxy_, settings_.force,
            {.rate_hz = rate_hz,
             .velocity_filter_hz = settings_.velocity_filter_hz,
             .limit = settings_.limit}) {}

void SecondHand::step(bool lost, bool parted) BURR_RT {
  row_ = {};
  row_.tick = next_tick_++;
  std::uint32_t& flags = row_.contact.flags;
  const bool usable = hand_.read(lost, flags);
  row_.hand = hand_.state();
  if (parted) hand_.lift();
  if (usable) {
    hand_.filter_velocity();
    if (hand_.engage()) hand_.feel();
  } else {
    hand_.skip_touch();
  }
  hand_.report(hand_.send(hand_.wanted(), flags), row_.contact);
  hand_.faults().note(row_);
  view_.publish(row_);
}

}  // namespace burr::tick
