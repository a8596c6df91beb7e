#include "burr/tick/cutting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "burr/edit/laws/thesis_law.h"
#include "burr/math/elementary.h"
#include "burr/math/sums.h"

namespace burr::tick {
namespace {

using math::Vec3;

constexpr double kCarried = 0.4;  // of the tick rate: what a force can be made to swing with [-]

}  // namespace

Cutting::Cutting(const volume::Bone& bone, edit::UndoStore& undo, edit::BoneWriter& writer,
                 const Controls& controls, const Hand& hand, std::size_t which)
    : bone_(bone),
      undo_(undo),
      controls_(controls),
      settings_(controls.settings),
      hand_(hand),
      dt_(1.0 / controls.settings.rate_hz),
      carver_(writer, controls.settings.carve, which),
      brush_(writer),
      chips_(bone),
      vibration_({.device_gain = controls.settings.vibration_gain}) {
  spindle_.full_speed = burr_speed_ = settings_.spindle_rad_s;
  spindle_.motor = settings_.motor;
  if (shaped() != nullptr) take_tool();
}

// ---- before touch

// What lies half a voxel under the point of contact.
const volume::Tissue& Cutting::touched_tissue() const BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  return tissue_at(touch.proxy - (settings_.burr.radius + 0.5 * bone_.grid().voxel) * cut_normal_);
}

// The same under the part that presses most, of a tool of several parts.
const volume::Tissue& Cutting::rubbed_tissue() const BURR_RT {
  const haptics::ToolContact* parts = hand_.parts();
  if (!settings_.tool_friction || parts == nullptr || !parts->by_part || parts->active == 0)
    return touched_tissue();
  const haptics::SixContact* most = parts->contacts.data();
  for (int a = 1; a < parts->active; ++a) {
    const haptics::SixContact& one = parts->contacts[static_cast<std::size_t>(a)];
    if (one.load > most->load) most = &one;
  }
  return tissue_at(hand_.tool() + most->arm - 0.5 * bone_.grid().voxel * most->normal);
}

const volume::Tissue& Cutting::tissue_at(const Vec3& world) const BURR_RT {
  const math::Ijk at = (bone_.grid().grid_from_world(world).array() + 0.5).floor().cast<int>();
  return bone_.tissues()[bone_.tissue(at.x(), at.y(), at.z())];
}

// Bone rubs as its tissue says while the spindle stands; a turning burr hardly at all.
// Parts that turn or stroke slide by themselves, a hundred times as fast as the hand: rub() has their
// force.
double Cutting::friction() const BURR_RT {
  const haptics::ToolContact* parts = hand_.parts();
  if (settings_.tool_friction && parts != nullptr && parts->by_part && spindle_.speed() != 0)
    return 0;
  if (spindle_.speed() != 0) return settings_.friction_turning;
  const bool rubs = hand_.touch().touching && !hand_.touch().slipping;
  return rubs ? rubbed_tissue().friction * settings_.friction_scale : 0;
}

// ---- on the hand

// Can a force change from tick to tick as fast as one tooth follows the other?
bool Cutting::tooth_is_carried() const BURR_RT {
  return teeth() * std::abs(spindle_.speed()) * dt_ < kCarried * 2 * std::numbers::pi;
}

// Pressing and being dragged aside feed each other in a hole that fits the burr, and would whirl a
// light device about: so the drag follows slowly, and goes with the push.
Vec3 Cutting::drag(const Vec3& touched) BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  const double share = 1 - math::exponential(-2 * std::numbers::pi * settings_.drag_hz * dt_);
  drag_ += share * (settings_.drag_gain * now_.drag - drag_);
  moment_ += share * (settings_.drag_gain * cut_moment_ - moment_);
  drag_share_ = 0;
  // a shaft that rubs presses too
  const double push = rubbing_.power > 0 ? last_load_ : last_push_;
  const double ratio = push > 0 ? settings_.drag_gain * math::norm(now_.drag) / push : 0;
  drag_ratio_ += share * (ratio - drag_ratio_);
  // once per tooth, where the ticks are quick enough to carry it
  const double tooth = teeth() * spindle_.speed() * dt_;  // [rad] a tick
  tooth_phase_ = std::remainder(tooth_phase_ + tooth, 2 * std::numbers::pi);
  if (!touch.touching) return Vec3::Zero();

  const Vec3 along = drag_ - math::dot(drag_, touch.normal) * touch.normal;
  const double is = math::norm(along);
  const double most = drag_ratio_ * std::max(0.0, math::dot(touched, touch.normal));
  if (is <= 0 || most <= 0) return Vec3::Zero();
  double gain = std::min(1.0, most / is);
  if (tooth_is_carried())
    gain *= 1 + std::min(1.0, settings_.drag_gain * now_.ripple / is) * math::cosine(tooth_phase_);
  drag_share_ = gain;
  return gain * along;
}

Vec3 Cutting::vibration() BURR_RT {
  if (settings_.vibration_gain <= 0) return Vec3::Zero();
  haptics::Milling now;
  now.spindle_rad_s = spindle_.speed();
  now.axis = hand_.axis();
  if (hand_.touch().touching) now.normal = hand_.touch().normal;
  // Vibration turns about `axis` and acts across axis and normal. A saw vibrates along its stroke, so
  // the axis is at right angles to stroke and normal
  if (shaped() != nullptr && settings_.tool_friction && tool::stroke_speed(shaped()->cutter) > 0 &&
      hand_.touch().touching)
    now.axis = now.normal.cross(Vec3(hand_.tool_turn() * shaped()->cutter.way));
  now.cutting_force = last_push_;
  return vibration_.step(now, dt_);
}

Vec3 Cutting::moment() const BURR_RT {
  const Vec3 axis = hand_.axis(), felt = drag_share_ * moment_;
  return felt - math::dot(felt, axis) * axis;
}

// tool/spindle.h; felt where the device can turn the hand: as the tip is where the device pushes,
// the force itself has no lever.
Vec3 Cutting::torque() const BURR_RT {
  if (shaped() != nullptr && shaped()->cutter.drive != tool::Drive::turning) return Vec3::Zero();
  return settings_.torque_gain * spindle_.reaction() * hand_.axis();
}

// ---- the bone

// The share of the force with which cutting parts press; of a ball alone it is all.
Cutting::Press Cutting::press(const Vec3& touched) const BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  Press press{touch.normal, std::max(0.0, math::dot(touched, touch.normal))};
  const haptics::ToolContact* parts = hand_.parts();
  if (parts == nullptr || !parts->by_part) return press;
  const double carried = math::norm(parts->head);
  press.push = touch.depth > 0 ? press.push * (carried / touch.depth) : 0;
  if (carried > 0) press.normal = parts->head / carried;
  return press;
}

edit::Cutting Cutting::by_law(const Press& press, double speed) BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  const edit::Spin spin = {hand_.axis(), speed};
  const tool::Burr& burr = settings_.burr;
  if (settings_.removal.law == edit::RemovalLaw::chips && burr.kind == tool::BurrKind::cutting)
    return chips_.step(burr, touch.proxy, press.normal, press.push, spin, dt_, settings_.removal,
                       tooth_is_carried());
  return edit::energy_law(
      press.push, spin, burr.radius,
      tool::cutting_efficiency(burr.kind, speed) * touched_tissue().cutting_friction, press.normal,
      dt_, settings_.removal);
}

// What a custom law pays for, no more than the motor can give. Where less of its force reached the
// hand, it cuts less in proportion.
edit::Cutting Cutting::by_own_law(const Press& press) const BURR_RT {
  const double wanted = math::dot(law_->force, press.normal);
  const double share = wanted > press.push ? press.push / wanted : 1;
  edit::Cutting cutting;
  cutting.energy = std::min(share * law_->energy, settings_.removal.max_power * dt_);
  cutting.power = cutting.energy / dt_;
  cutting.torque = share * law_->torque;
  return cutting;
}

// Is the bone worked on in this tick? If not, the debt and the open stroke run out.
// may: not while bone is put back, whose stroke is not ours.
bool Cutting::works(double push, bool may) BURR_RT {
  const double pedal = hand_.state().pedal;
  const bool works = shaped() != nullptr               ? drive_moves(push)
                     : settings_.mode == ToolMode::cut ? spindle_.speed() != 0 && push > 0
                                                       : pedal > 0 && push > 0;
  if (works) {
    untouched_ = 0;
    return true;
  }
  carver_.idle(dt_);
  untouched_ += dt_;
  if (may && undo_.stroke_open() && rests_long() && (beside_ == nullptr || beside_->rests_long()))
    undo_.end_stroke(carver_.removed_units());
  return false;
}

void Cutting::cut(std::uint64_t tick, const Vec3& touched, bool may, std::uint64_t path_mark,
                  std::uint32_t& flags) BURR_RT {
  cut_tool(tick, touched, may, path_mark, flags);
  rubbing_ = {};
  if (settings_.tool_friction && may) rub(touched);
}

void Cutting::cut_tool(std::uint64_t tick, const Vec3& touched, bool may, std::uint64_t path_mark,
                       std::uint32_t& flags) BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  const bool pushes = may && touch.touching && !touch.slipping && settings_.mode != ToolMode::touch;
  const Press now = press(touched);
  const double push = pushes ? now.push : 0;
  cut_normal_ = now.normal;
  last_push_ = push;
  now_ = {};
  cut_moment_ = Vec3::Zero();
  if (shaped() != nullptr) {
    cut_shaped(push, may, flags, path_mark);
    return;
  }
  // what holds a standing burr is what would brake it if it crept
  if (settings_.mode == ToolMode::cut && push > 0 && spindle_.speed() == 0 &&
      hand_.state().pedal > 0 && settings_.removal.law != edit::RemovalLaw::thesis)
    now_.torque = by_law({now.normal, push}, std::copysign(1.0, spindle_.full_speed)).torque;
  if (!works(push, may)) return;
  if (!undo_.stroke_open()) undo_.begin_stroke(path_mark, carver_.removed_units());

  const volume::Grid& grid = bone_.grid();
  edit::Cut cut;
  cut.centre = grid.grid_from_world(touch.proxy);
  cut.push = grid.frame.q.conjugate() * (-now.normal);
  cut.radius = settings_.burr.radius / grid.voxel;
  cut.dt = dt_;
  cut.slices = slices_of(controls_.shed);
  cut.mirror = controls_.mirror;
  const bool pays = law_ != nullptr && law_->state == LawRow::kActs && law_->energy >= 0;
  if (settings_.mode == ToolMode::cut && pays) {
    now_ = by_own_law({now.normal, push});
    cut.energy = now_.energy;
    carver_.carve(cut, flags);
  } else if (settings_.mode == ToolMode::cut && settings_.removal.law == edit::RemovalLaw::thesis) {
    const auto frame =
        static_cast<std::uint64_t>(std::max(1, settings_.removal.thesis_frame_ticks));
    if (tick % frame == 0)
      edit::lower(carver_, cut,
                  65536 * settings_.removal.thesis_rate * dt_ * static_cast<double>(frame), flags);
    else
      carver_.idle(dt_);
  } else if (settings_.mode == ToolMode::cut) {
    now_ = by_law({now.normal, push}, spindle_.speed());
    cut.energy = now_.energy;
    carver_.carve(cut, flags);
  } else if (settings_.mode != ToolMode::add) {
    brush(cut, flags);
  } else {
    cut.volume = settings_.deposit_rate * std::clamp(hand_.state().pedal, 0.0, 1.0) * dt_;
    cut.material = settings_.deposit_tissue;
    deposited_ = true;
    carver_.deposit(cut, flags);
  }
}

void Cutting::brush(const edit::Cut& cut, std::uint32_t& flags) BURR_RT {
  edit::Brushing now;
  now.centre = cut.centre;
  now.push = cut.push;
  now.radius = cut.radius;
  now.strength = std::clamp(hand_.state().pedal, 0.0, 1.0);
  now.dt = dt_;
  now.slices = cut.slices;
  now.mirror = cut.mirror;
  carver_.idle(dt_);
  if (settings_.mode == ToolMode::smooth) {
    deposited_ = true;  // what grows into air gets a tissue
    brush_.smooth(now, flags);
  } else {
    brush_.restore(now, flags);
  }
}

Cutting::Warming Cutting::warming() const BURR_RT {
  const haptics::Touch& touch = hand_.touch();
  if (shaped() != nullptr) return {now_.power, warm_place_, thermal::Edge::flute, warm_radius_};
  const bool rubs = settings_.mode == ToolMode::cut && now_.power <= 0 && last_push_ > 0;
  Warming warming;
  warming.radius = settings_.burr.radius;
  warming.power = now_.power;
  if (rubs)
    warming.power = settings_.friction_turning * last_push_ * std::abs(spindle_.speed()) *
                    settings_.burr.radius *
                    std::max(math::norm(cut_normal_.cross(hand_.axis())), settings_.removal.pole);
  warming.place = touch.proxy;
  if (warming.power > 0) warming.place = touch.proxy - settings_.burr.radius * cut_normal_;
  using thermal::Edge;
  warming.edge = rubs                                             ? Edge::rubbing
                 : settings_.burr.kind == tool::BurrKind::diamond ? Edge::diamond
                                                                  : Edge::flute;
  return warming;
}

}  // namespace burr::tick
