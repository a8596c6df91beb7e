#include "burr/tick/servo.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "burr/tick/mirror_plane.h"
#include "burr/tick/tick_hash.h"

namespace burr::tick {
namespace {

using math::Vec3;
using tick::Command;
using tick::CommandKind;

constexpr int kCommandsPerTick = 8;
constexpr double kRestorePerSecond = 16e3;  // bricks; about as many as a deep cut changes
constexpr double kRecovery = 5;  // of bone that grew under the burr pushes it out  [voxel/s]
// of the budgets of IsoSettings: they are those of a millisecond
constexpr double kRefreshRate = 1e3;
constexpr double kFastest = 1e5;  // spindle, either way  [rad/s]
constexpr double kCarried = 0.4;  // of the tick rate: what a force can be made to swing with [-]
constexpr double kHeatEvery = 10e-3;  // a row to the worker that knows the heat  [s]
constexpr int kFewMoves = 4;          // of the proxy, when even touch must do with less

}  // namespace

Servo::Servo(volume::Bone& bone, volume::IsoVertices& surface, device::Device& device,
             const ServoSettings& settings)
    : bone_(bone),
      surface_(surface),
      device_(device),
      settings_(settings),
      dt_(1.0 / settings.rate_hz),
      changed_(bone),
      undo_(bone, settings.undo_bricks),
      carver_(bone, surface, undo_, &changed_, settings.carve),
      brush_(bone, undo_, carver_),
      chips_(bone),
      touch_by_(surface, {.radius = settings.burr.radius, .recovery = kRecovery / settings.rate_hz},
                settings.touch),
      guard_({.slack = settings.guard_slack,
              .largest_force = std::min(device.spec().peak_force, settings.limit.user_force)}),
      vibration_({.device_gain = settings.vibration_gain}),
      limit_(device.spec(), settings.limit),
      path_(kPath),
      burr_radius_(settings.burr.radius) {
  spindle_.full_speed = settings.spindle_rad_s;
  spindle_.motor = settings.motor;
  irrigated_ = settings.irrigated;
}

const TickRow& Servo::tick(bool lost) BURR_RT {
  row_ = {};
  row_.tick = next_tick_++;
  std::uint32_t& flags = row_.contact.flags;

  // the hand
  hand_ = device_.state(dt_);
  row_.hand = hand_;
  if (lost) {
    limit_.restart();
    flags |= haptics::kFlagWatchdog;
    faults_.raise();
  }
  const bool believed = limit_.believe(hand_, flags);
  if ((hand_.buttons & device::kLifted) != 0) {  // it comes back in free air only
    limit_.lift();
    engaged_ = false;
  }
  if (!believed) faults_.raise();

  take_commands();
  note_tool();
  spindle_.step(believed ? hand_.pedal : 0, cutting_.torque, dt_);

  // touch
  if (believed) {
    const double blend = 1 - std::exp(-2 * M_PI * settings_.velocity_filter_hz * dt_);
    velocity_ += blend * (hand_.velocity - velocity_);
    if (restore_ != Restore::none) {
      step_restore();
      flags |= haptics::kFlagRestoring;
    } else {
      touch_bone(hand_.world_from_tool.p);
    }
  } else {
    touch_ = {};
    touch_.proxy = touch_by_.now().position();
    velocity_ = Vec3::Zero();
  }

  // force, bounded, to the hand
  const Vec3 wanted = haptics::force_law(touch_, velocity_, settings_.force);
  const Vec3 guarded = passive(wanted, lost || !believed);
  const Vec3 spinning = drag(guarded) + buzz();
  const Vec3 force = limit_.apply(guarded + spinning, dt_, flags);
  const Vec3 torque = turn(believed);
  device_.write_torque(torque);
  device_.write_force(force);
  const Vec3 touched = limit_.engaged() ? Vec3(force - spinning) : force;  // without the spindle
  guard_.sent(touched);

  // then the bone
  cut_bone(touched);
  // twice as much changes in a mirror, and the hand's side must not be later for it
  surface_.refresh((mirror_.on() ? 2 : 1) * kRefreshRate * dt_ / slices_of(shed_));
  tell_heat();
  remember_path();

  // and the account of it all
  let_go_.store(!engaged_ || !limit_.engaged(), std::memory_order_relaxed);
  haptics::Contact& contact = row_.contact;
  contact.proxy = touch_.proxy;
  contact.normal = touch_.normal;
  contact.force = force;
  contact.torque = torque;
  contact.depth = touch_.depth;
  contact.active = touch_.active;
  contact.candidates = touch_.candidates;
  contact.touching = touch_.touching;
  if (touch_.lagging) flags |= haptics::kFlagLagging;
  if (touch_.overflow) flags |= haptics::kFlagCandidates;
  if (surface_.exhausted()) flags |= haptics::kFlagReserve;
  if (shed_ >= Shed::removal_2) flags |= haptics::kFlagPutOff;
  row_.ledger = carver_.ledger();
  if (spindle_.stalled()) flags |= haptics::kFlagStalled;
  row_.spindle_rad_s = spindle_.speed();
  row_.cutting_nm = cutting_.torque;
  row_.cutting_w = cutting_.power;
  hash_row();
  faults_.note(row_);
  return row_;
}

// ---- touch

void Servo::touch_bone(const Vec3& hand) BURR_RT {
  if (!engaged_) {  // at the start, or after the hand was lost: wait until it is in free air
    touch_ = {};
    touch_.proxy = hand;
    if (!touch_by_.constraint().is_free(hand)) return;
    touch_by_.now().place(hand);
    engaged_ = true;
  }
  choose_friction();
  touch_by_.show(row_.tick);
  touch_ = touch_by_.now().step(hand);
}

// What of the wanted force may be sent without giving the hand more than it gave.
Vec3 Servo::passive(const Vec3& wanted, bool begins_anew) BURR_RT {
  if (!settings_.guarded) return wanted;
  if (begins_anew) guard_.restart();
  haptics::Exchange now;
  now.hand = hand_.world_from_tool.p;
  if (touch_.touching) now.stretch = touch_.depth * touch_.normal + touch_.trail;
  now.stiffness = settings_.force.stiffness;
  now.force = wanted;
  const Vec3 force = guard_.step(now, dt_);
  if (guard_.damping() > 0) row_.contact.flags |= haptics::kFlagGuarded;
  return force;
}

Vec3 Servo::buzz() BURR_RT {
  if (settings_.vibration_gain <= 0) return Vec3::Zero();
  haptics::Milling now;
  now.spindle_rad_s = spindle_.speed();
  now.axis = hand_.world_from_tool.q * Vec3::UnitZ();
  if (touch_.touching) now.normal = touch_.normal;
  now.cutting_force = last_push_;
  return vibration_.step(now, dt_);
}

// What the motor's torque does to the handpiece (tool/spindle.h), where the device can turn the
// hand: as the tip is where the device pushes, the force itself has no lever.
Vec3 Servo::turn(bool believed) BURR_RT {
  const Vec3 axis = hand_.world_from_tool.q * Vec3::UnitZ();
  const Vec3 wanted =
      believed ? Vec3(settings_.torque_gain * spindle_.reaction() * axis) : Vec3(Vec3::Zero());
  return limit_.apply_torque(wanted, dt_, row_.contact.flags);
}

// What the bone pulls at the burr along its surface. Pressing and being dragged aside feed each
// other in a hole that fits the burr, and would whirl a light device about: so it follows slowly,
// and goes with the push.
Vec3 Servo::drag(const Vec3& touched) BURR_RT {
  const double share = 1 - std::exp(-2 * M_PI * settings_.drag_hz * dt_);
  drag_ += share * (settings_.drag_gain * cutting_.drag - drag_);
  const double ratio = last_push_ > 0 ? settings_.drag_gain * cutting_.drag.norm() / last_push_ : 0;
  drag_ratio_ += share * (ratio - drag_ratio_);
  // once per tooth, where the ticks are quick enough to carry it
  const double tooth = settings_.burr.teeth * spindle_.speed() * dt_;  // [rad] a tick
  tooth_phase_ = std::remainder(tooth_phase_ + tooth, 2 * M_PI);
  if (!touch_.touching) return Vec3::Zero();

  const Vec3 along = drag_ - drag_.dot(touch_.normal) * touch_.normal;
  const double is = along.norm();
  const double most = drag_ratio_ * std::max(0.0, touched.dot(touch_.normal));
  if (is <= 0 || most <= 0) return Vec3::Zero();
  double gain = std::min(1.0, most / is);
  if (tooth_is_carried())
    gain *= 1 + std::min(1.0, settings_.drag_gain * cutting_.ripple / is) * std::cos(tooth_phase_);
  return gain * along;
}

// Can a force change from tick to tick as fast as one tooth follows the other?
bool Servo::tooth_is_carried() const BURR_RT {
  return settings_.burr.teeth * std::abs(spindle_.speed()) * dt_ < kCarried * 2 * M_PI;
}

edit::Cutting Servo::cut_by_law(double push, double speed) BURR_RT {
  const edit::Spin spin = {hand_.world_from_tool.q * Vec3::UnitZ(), speed};
  const tool::Burr& burr = settings_.burr;
  if (settings_.removal.law == edit::RemovalLaw::chips && burr.kind == tool::BurrKind::cutting)
    return chips_.step(burr, touch_.proxy, touch_.normal, push, spin, dt_, settings_.removal,
                       tooth_is_carried());
  return edit::energy_law(
      push, spin, burr.radius,
      tool::cutting_efficiency(burr.kind, speed) * touched_tissue().cutting_friction, touch_.normal,
      dt_, settings_.removal);
}

// The burr is in bone, where ours cannot begin: the force fades, and touch begins again in free
// air.
void Servo::let_go_in_bone() BURR_RT {
  limit_.fault(haptics::kFlagWaiting, row_.contact.flags);
  engaged_ = false;
}

// What lies half a voxel under the point of contact.
const volume::Tissue& Servo::touched_tissue() const BURR_RT {
  const Vec3 foot =
      touch_.proxy - (settings_.burr.radius + 0.5 * bone_.grid().voxel) * touch_.normal;
  const math::Ijk at = (bone_.grid().grid_from_world(foot).array() + 0.5).floor().cast<int>();
  return bone_.tissues()[bone_.tissue(at.x(), at.y(), at.z())];
}

// Bone rubs as its tissue says while the spindle stands; a turning burr hardly at all.
void Servo::choose_friction() BURR_RT {
  double mu = settings_.friction_turning;
  if (spindle_.speed() == 0) {
    mu = touch_.touching ? touched_tissue().friction * settings_.friction_scale : 0;
  }
  touch_by_.now().set_friction(mu, settings_.kinetic_share * mu);
}

// ---- the bone

void Servo::cut_bone(const Vec3& force) BURR_RT {
  std::uint32_t& flags = row_.contact.flags;
  const bool may =
      restore_ == Restore::none && touch_.touching && settings_.mode != ToolMode::touch;
  const double push = may ? std::max(0.0, force.dot(touch_.normal)) : 0;
  last_push_ = push;
  cutting_ = {};
  // what holds a standing burr is what would brake it if it crept
  if (settings_.mode == ToolMode::cut && push > 0 && spindle_.speed() == 0 && hand_.pedal > 0 &&
      settings_.removal.law != edit::RemovalLaw::thesis)
    cutting_.torque = cut_by_law(push, std::copysign(1.0, spindle_.full_speed)).torque;
  const bool works = settings_.mode == ToolMode::cut ? spindle_.speed() != 0 && push > 0
                                                     : hand_.pedal > 0 && push > 0;
  if (!works) {
    carver_.idle(dt_);
    untouched_ += dt_;
    if (undo_.stroke_open() && untouched_ > settings_.stroke_pause) undo_.end_stroke();
    return;
  }
  untouched_ = 0;
  if (!undo_.stroke_open()) undo_.begin_stroke(path_end_);

  const volume::Grid& grid = bone_.grid();
  edit::Cut cut;
  cut.centre = grid.grid_from_world(touch_.proxy);
  cut.push = grid.frame.q.conjugate() * (-touch_.normal);
  cut.radius = settings_.burr.radius / grid.voxel;
  cut.dt = dt_;
  cut.slices = slices_of(shed_);
  cut.mirror = mirror_;
  if (settings_.mode == ToolMode::cut && settings_.removal.law == edit::RemovalLaw::thesis) {
    const auto frame = static_cast<std::uint64_t>(std::max(1, settings_.removal.thesis_frame));
    if (row_.tick % frame == 0)
      carver_.lower(cut, 65536 * settings_.removal.thesis_rate * dt_ * static_cast<double>(frame),
                    flags);
    else
      carver_.idle(dt_);
  } else if (settings_.mode == ToolMode::cut) {
    cutting_ = cut_by_law(push, spindle_.speed());
    cut.energy = cutting_.energy;
    carver_.carve(cut, flags);
  } else if (settings_.mode != ToolMode::add) {
    brush_bone(cut);
  } else {
    cut.volume = settings_.deposit_rate * std::clamp(hand_.pedal, 0.0, 1.0) * dt_;
    cut.material = settings_.deposit_tissue;
    deposited_ = true;
    carver_.deposit(cut, flags);
  }
}

void Servo::brush_bone(const edit::Cut& cut) BURR_RT {
  edit::Brushing now;
  now.centre = cut.centre;
  now.push = cut.push;
  now.radius = cut.radius;
  now.strength = std::clamp(hand_.pedal, 0.0, 1.0);
  now.dt = dt_;
  now.slices = cut.slices;
  now.mirror = cut.mirror;
  carver_.idle(dt_);
  if (settings_.mode == ToolMode::smooth) {
    deposited_ = true;  // what grows into air gets a tissue
    brush_.smooth(now, row_.contact.flags);
  } else {
    brush_.restore(now, row_.contact.flags);
  }
}

// A row for every hundredth of a second: what the burr spent meanwhile, and where last.
void Servo::tell_heat() BURR_RT {
  if (heat_ == nullptr) return;
  const bool rubs = settings_.mode == ToolMode::cut && cutting_.power <= 0 && last_push_ > 0;
  double power = cutting_.power;
  if (rubs) {
    const Vec3 axis = hand_.world_from_tool.q * Vec3::UnitZ();
    power = settings_.friction_turning * last_push_ * std::abs(spindle_.speed()) *
            settings_.burr.radius *
            std::max(touch_.normal.cross(axis).norm(), settings_.removal.pole);
  }
  if (power > 0) {
    using thermal::Edge;
    heat_row_.energy += power * dt_;
    heat_row_.place = touch_.proxy - settings_.burr.radius * touch_.normal;
    heat_row_.edge = rubs                                             ? Edge::rubbing
                     : settings_.burr.kind == tool::BurrKind::diamond ? Edge::diamond
                                                                      : Edge::flute;
  } else if (heat_row_.energy <= 0) {
    heat_row_.place = touch_.proxy;  // where the coolant runs
  }
  const auto every = static_cast<std::uint64_t>(std::max(1.0, std::round(kHeatEvery / dt_)));
  if (row_.tick % every != 0 && !heat_row_.start_over) return;
  heat_row_.time_ns = std::llround(static_cast<double>(row_.tick) * dt_ * 1e9);
  heat_row_.radius = settings_.burr.radius;
  heat_row_.irrigated = irrigated_;
  static_cast<void>(heat_->push(heat_row_));
  heat_row_.energy = 0;
  heat_row_.start_over = false;
}

// ---- commands

void Servo::take_commands() BURR_RT {
  const auto take = [this](const Command& command) {
    if (diary_.commands != nullptr) diary_.commands->push({row_.tick, command});
    obey(command);
  };
  if (shed_requested_ != shed_) take({CommandKind::shed, static_cast<double>(shed_requested_)});
  Command command;
  for (int taken = 0; taken < kCommandsPerTick && commands_.pop(command);) {
    take(command);
    if (command.kind != CommandKind::shed)
      ++taken;  // the servo's own, from a recording: beside the eight
  }
}

// What is in the hand after this tick's commands, whether they were obeyed or refused.
void Servo::note_tool() BURR_RT {
  row_.tool.radius = settings_.burr.radius;
  row_.tool.full_speed = spindle_.full_speed;
  row_.tool.kind = settings_.burr.kind;
  row_.tool.mode = settings_.mode;
  row_.tool.mirror_axis = mirror_.axis;
  row_.tool.mirror_twice = mirror_.twice;
  row_.tool.irrigated = irrigated_;
}

void Servo::obey(const Command& command) BURR_RT {
  if (!std::isfinite(command.value)) return;
  switch (command.kind) {
    case CommandKind::spindle_speed:
      spindle_.full_speed = std::clamp(command.value, -kFastest, kFastest);
      break;
    case CommandKind::burr_radius:
      if (command.value >= 2 * bone_.grid().voxel &&
          command.value <= 0.5 * tool::kLargestDiameter + 1e-12 &&
          touch_by_.set_radius(command.value)) {
        settings_.burr.radius = command.value;
        burr_radius_.store(command.value, std::memory_order_relaxed);
      }
      break;
    case CommandKind::burr_kind:
      settings_.burr.kind = command.value > 0 ? tool::BurrKind::diamond : tool::BurrKind::cutting;
      break;
    case CommandKind::stiffness:
      settings_.force.stiffness = std::clamp(command.value, 0.0, device_.spec().max_stiffness);
      break;
    case CommandKind::user_force:
      limit_.set_user_force(command.value);
      guard_.set_largest_force(std::min(device_.spec().peak_force, command.value));
      break;
    case CommandKind::tool_mode:
      if (command.value >= 0 && command.value < kToolModes)
        settings_.mode = static_cast<ToolMode>(static_cast<int>(command.value));
      break;
    case CommandKind::friction:
      settings_.friction_scale = std::clamp(command.value, 0.0, 4.0);
      break;
    case CommandKind::shed:
      if (command.value < 0 || command.value >= kShedSteps) break;
      shed_ = shed_requested_ = static_cast<Shed>(static_cast<int>(command.value));
      touch_by_.constraint().set_max_moves(
          shed_ == Shed::touch ? kFewMoves : haptics::ProxySettings{}.max_moves);
      break;
    case CommandKind::touch_method:
      if (command.value >= 0 && command.value < haptics::kMethods) {
        settings_.touch = static_cast<haptics::Method>(static_cast<int>(command.value));
        if (!touch_by_.choose(settings_.touch)) let_go_in_bone();
      }
      break;
    case CommandKind::removal_law:
      if (command.value >= 0 && command.value < edit::kLaws)
        settings_.removal.law = static_cast<edit::RemovalLaw>(static_cast<int>(command.value));
      break;
    case CommandKind::irrigation:
      irrigated_ = command.value > 0;
      break;
    case CommandKind::mirror_i:
    case CommandKind::mirror_j:
    case CommandKind::mirror_k:
    case CommandKind::mirror_off:
      mirror_ = mirror_of(command, bone_.grid().size).value_or(mirror_);
      break;
    case CommandKind::undo:
    case CommandKind::redo:
    case CommandKind::reset:
      begin_restore(command.kind);
      break;
  }
}

// ---- undo, redo, reset: lift the burr back the way it came until what returns cannot touch it,
// then put the bricks back a few at a time, then let their surface settle; only then does the burr
// follow the hand again

void Servo::begin_restore(CommandKind kind) BURR_RT {
  if (restore_ != Restore::none) return;
  if (undo_.stroke_open()) undo_.end_stroke();
  if (kind == CommandKind::undo) {
    if (!undo_.can_undo()) return;
    range_ = undo_.undo();
  } else if (kind == CommandKind::redo) {
    if (!undo_.can_redo()) return;
    range_ = undo_.redo();
  } else {
    if (undo_.touched() == 0) return;
    range_ = {0, undo_.touched(), 0};
    undo_.forget_strokes();
    heat_row_.start_over = true;
  }
  restore_kind_ = kind;
  restore_ = Restore::lifting;
  restored_ = 0;
  path_at_ = path_end_;
  lift_since_check_ = settings_.burr.radius;  // look at once
}

bool Servo::clear_of_what_returns(const Vec3& p) const BURR_RT {
  const Vec3 centre = bone_.grid().grid_from_world(p);
  const double radius = settings_.burr.radius / bone_.grid().voxel;
  const Vec3 half = Vec3::Constant(volume::kBrickEdge / 2.0);
  for (std::uint64_t i = 0; i < range_.count; ++i) {
    const edit::KeptBrick& kept = restore_kind_ == CommandKind::reset
                                      ? undo_.original(static_cast<std::size_t>(i))
                                      : undo_.entry(range_.first + i);
    const Vec3 middle = bone_.brick_ijk(kept.brick).cast<double>() + half;
    if ((middle - centre).norm() > radius + 9) continue;
    if (!carver_.clear_of(kept, centre, radius)) return false;
  }
  return true;
}

void Servo::step_restore() BURR_RT {
  const Vec3 hand = hand_.world_from_tool.p;
  if (restore_ == Restore::lifting) {
    double left = settings_.lift_speed * dt_;
    bool arrived = false;
    Vec3 at = touch_by_.now().position();
    if (lift_since_check_ >= settings_.burr.radius / 4) {
      arrived = clear_of_what_returns(at);
      lift_since_check_ = 0;
    }
    const std::uint64_t oldest = path_end_ > kPath ? path_end_ - kPath : 0;
    while (!arrived && left > 0 && path_at_ > oldest) {
      const Vec3& goal = path_[(path_at_ - 1) % kPath];
      const double far = (goal - at).norm();
      const double go = std::min(far, left);
      if (far > 0) at += (goal - at) * (go / far);
      left -= go;
      lift_since_check_ += go;
      if (go >= far) --path_at_;
    }
    touch_by_.now().place(at);
    if (!arrived &&
        path_at_ == oldest) {  // no way back is known: let go of the hand, engage again in free air
      limit_.fault(haptics::kFlagRestoring, row_.contact.flags);
      engaged_ = false;
      arrived = true;
    }
    if (arrived) restore_ = Restore::restoring;
  } else if (restore_ == Restore::restoring) {
    const auto most = static_cast<std::size_t>(std::max(1.0, std::ceil(kRestorePerSecond * dt_)));
    for (std::size_t n = 0; n < most && restored_ < range_.count; ++n, ++restored_) {
      if (restore_kind_ == CommandKind::reset) {
        carver_.restore(undo_.original(static_cast<std::size_t>(restored_)));
      } else {
        carver_.swap(undo_.entry(range_.first + restored_));
      }
    }
    if (restored_ == range_.count) restore_ = Restore::settling;
  } else if (surface_.stale() == 0) {
    restore_ = Restore::none;
    if (settings_.touch == haptics::Method::constraint &&
        !touch_by_.constraint().is_free(touch_by_.now().position()))
      engaged_ = false;  // never resume inside bone
  }

  // the hand feels the burr where it is held
  touch_ = {};
  touch_.proxy = touch_by_.now().position();
  const Vec3 stretch = touch_.proxy - hand;
  touch_.depth = stretch.norm();
  if (engaged_ && touch_.depth > 1e-9) {
    touch_.normal = stretch / touch_.depth;
    touch_.touching = true;
  }
}

void Servo::remember_path() BURR_RT {
  if (!engaged_ || restore_ != Restore::none || touch_.lagging) return;
  const double step = bone_.grid().voxel / 2;
  if (path_end_ > 0 && (path_[(path_end_ - 1) % kPath] - touch_by_.now().position()).norm() < step)
    return;
  path_[path_end_++ % kPath] = touch_by_.now().position();
}

// ---- the diary

void Servo::write_bricks(std::size_t most) BURR_RT {
  if (diary_.bricks == nullptr) {
    while (changed_.pop() != volume::kNoBrick) {
    }
    return;
  }
  for (std::size_t n = 0; n < most && changed_.size() > 0; ++n) {
    if (diary_.bricks->size() == diary_.bricks->capacity())
      return;  // it waits in the queue, nothing is lost
    const volume::BrickIndex brick = changed_.pop();
    BrickRow row;
    row.tick = row_.tick;
    row.brick = brick;
    std::memcpy(&row.field, bone_.brick_field(brick), sizeof row.field);
    row.has_tissue = deposited_;  // nothing else changes it, but its undo does too
    if (row.has_tissue)
      std::memcpy(row.tissue.data(), bone_.brick_tissue(brick), row.tissue.size());
    diary_.bricks->push(row);
  }
}

void Servo::publish() BURR_RT {
  // each changed brick is written within 100 ms: a fiftieth of the queue per 2 ms, and at least one
  const auto ticks = static_cast<std::size_t>(std::max(1.0, 0.05 * settings_.rate_hz));
  write_bricks(changed_.size() / ticks + 1);
  if (diary_.ticks != nullptr) diary_.ticks->push(row_);
  view_.publish(row_);
  if (watch_ != nullptr) watch_->publish(row_);
}

void Servo::flush_bricks() BURR_RT { write_bricks(changed_.size()); }

void Servo::note_timing(double took_us, double late_us) BURR_RT {
  row_.took_us = static_cast<float>(took_us);
  row_.late_us = static_cast<float>(late_us);
  faults_.renew(row_);
}

// Chained, so that the first tick at which two runs part is the first whose hash differs.
void Servo::hash_row() BURR_RT { row_.hash = last_hash_ = tick_hash(row_, last_hash_); }

std::vector<std::string> words(std::uint32_t flags) {
  static_assert(haptics::kFlagReserve == 1U << 10 && haptics::kFlagUndoFull == 1U << 11 &&
                    haptics::kFlagNotCut == 1U << 14 && haptics::kFlagPutOff == 1U << 15,
                "edit/carve.cpp sets these bits by number");
  static const std::pair<std::uint32_t, const char*> kWords[] = {
      {haptics::kFlagNotFinite,
       "a hand position or a force was not a number; the force was let go and comes back by the "
       "start ramp"},
      {haptics::kFlagForceLimited, "the force was shortened to the device's or the user's limit"},
      {haptics::kFlagSlewLimited, "the force grew faster than allowed and was held back"},
      {haptics::kFlagRamp, "the start ramp was on"},
      {haptics::kFlagWaiting, "not engaged: the hand has to be in free air once"},
      {haptics::kFlagThermal, "the motors were warm: only the continuous force was given"},
      {haptics::kFlagWatchdog,
       "ticks were lost and the force was let go; close other programs or allow real-time "
       "scheduling (docs/troubleshooting.md)"},
      {haptics::kFlagJump,
       "the hand leapt more than 20 mm in one tick and was not believed; check the device's cable "
       "and calibration"},
      {haptics::kFlagLagging,
       "the burr had not come to rest within the tick: a very fast hand, or a tight hole"},
      {haptics::kFlagCandidates,
       "more contacts than the list holds; use a larger voxel or a smaller burr"},
      {haptics::kFlagPutOff,
       "the machine was too slow, or the burr too big, to cut every brick in every tick; they were "
       "cut in turn (docs/realtime.md, \"Too much at once\")"},
      {haptics::kFlagReserve,
       "no room was left for new material or new surface; raise --reserve-bricks"},
      {haptics::kFlagUndoFull,
       "undo memory was full, the oldest stroke was forgotten; raise --undo-bricks"},
      {haptics::kFlagHandLost, "the device lost the hand; the force was let go"},
      {haptics::kFlagRestoring, "an undo or reset was under way"},
      {haptics::kFlagGuarded,
       "the energy guard braked the hand: the spring is stiffer than this device can show; lower "
       "--stiffness"},
      {haptics::kFlagStalled,
       "the spindle stood still, held by the bone; press less, or give it more torque "
       "(--torque-mnm)"},
      {haptics::kFlagNotCut, "the burr was blocked and some of what was asked was not cut"},
  };
  std::vector<std::string> said;
  for (const auto& [flag, text] : kWords)
    if ((flags & flag) != 0) said.emplace_back(text);
  return said;
}

}  // namespace burr::tick
