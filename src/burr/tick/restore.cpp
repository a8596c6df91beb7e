#include "burr/tick/restore.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"
#include "burr/rt/flags.h"

namespace burr::tick {
namespace {

using math::Vec3;

constexpr double kRestorePerSecond = 16e3;  // bricks; about as many as a deep cut changes

}  // namespace

Restore::Restore(const volume::Bone& bone, const volume::IsoVertices& surface,
                 edit::UndoStore& undo, edit::BoneWriter& writer, const ServoSettings& settings,
                 Hand& hand)
    : bone_(bone),
      surface_(surface),
      undo_(undo),
      writer_(writer),
      settings_(settings),
      hand_(hand),
      dt_(1.0 / settings.rate_hz),
      path_(kPath) {}

bool Restore::begin(CommandKind kind) BURR_RT {
  if (active()) return false;
  if (undo_.stroke_open()) undo_.end_stroke(writer_.account().removed);
  if (kind == CommandKind::undo) {
    if (!undo_.can_undo()) return false;
    range_ = undo_.undo();
  } else if (kind == CommandKind::redo) {
    if (!undo_.can_redo()) return false;
    range_ = undo_.redo();
  } else {
    if (undo_.touched() == 0) return false;
    range_ = {0, undo_.touched(), 0, 0};
    undo_.forget_strokes();
  }
  kind_ = kind;
  state_ = State::lifting;
  restored_ = 0;
  path_at_ = path_end_;
  lift_since_check_ = settings_.burr.radius;  // look at once
  return true;
}

// The brick that comes back, 0 to range_.count.
const edit::KeptBrick& Restore::kept(std::uint64_t number) const BURR_RT {
  const edit::UndoStore& undo = undo_;
  return kind_ == CommandKind::reset ? undo.original(static_cast<std::size_t>(number))
                                     : undo.entry(range_.first + number);
}

bool Restore::clear_of_what_returns(const Vec3& p) const BURR_RT {
  const Vec3 centre = bone_.grid().grid_from_world(p);
  const double radius = settings_.burr.radius / bone_.grid().voxel;
  const Vec3 half = Vec3::Constant(volume::kBrickEdge / 2.0);
  for (std::uint64_t i = 0; i < range_.count; ++i) {
    const edit::KeptBrick& returns = kept(i);
    const Vec3 middle = bone_.brick_ijk(returns.brick).cast<double>() + half;
    if (math::norm(middle - centre) > radius + 9) continue;
    if (!writer_.clear_of(returns, centre, radius)) return false;
  }
  return true;
}

void Restore::step(std::uint32_t& flags) BURR_RT {
  if (state_ == State::lifting) {
    lift(flags);
  } else if (state_ == State::restoring) {
    put_back();
  } else {
    settle();
  }
  hand_.feel_held_tool();  // the hand feels the tool where it is held
}

void Restore::lift(std::uint32_t& flags) BURR_RT {
  if (settings_.tool >= 0) {
    // how it was turned on its way is not known: the hand is released, and engages again in free air
    hand_.release(rt::kFlagRestoring, flags);
    state_ = State::restoring;
    return;
  }
  double left = settings_.lift_speed * dt_;
  bool arrived = false;
  Vec3 at = hand_.tool();
  if (lift_since_check_ >= settings_.burr.radius / 4) {
    arrived = clear_of_what_returns(at);
    lift_since_check_ = 0;
  }
  const std::uint64_t oldest = path_end_ > kPath ? path_end_ - kPath : 0;
  while (!arrived && left > 0 && path_at_ > oldest) {
    const Vec3& goal = path_[(path_at_ - 1) % kPath];
    const double far = math::norm(goal - at);
    // a hand that hovers was set down from place to place, with bone between them: so is its tool
    const double go = hand_.hovers() ? far : std::min(far, left);
    if (far > 0) at += (goal - at) * (go / far);
    left -= go;
    lift_since_check_ += go;
    if (go >= far) --path_at_;
  }
  hand_.place(at);
  if (!arrived && path_at_ == oldest) {
    // no way back is known: release the hand; it engages again in free air
    hand_.release(rt::kFlagRestoring, flags);
    arrived = true;
  }
  if (arrived) state_ = State::restoring;
}

void Restore::put_back() BURR_RT {
  const auto most = static_cast<std::size_t>(std::max(1.0, std::ceil(kRestorePerSecond * dt_)));
  for (std::size_t n = 0; n < most && restored_ < range_.count; ++n, ++restored_) {
    if (kind_ == CommandKind::reset) {
      writer_.restore(undo_.original(static_cast<std::size_t>(restored_)));
    } else {
      writer_.swap(undo_.entry(range_.first + restored_));
    }
  }
  if (restored_ < range_.count) return;
  state_ = State::settling;
  edit::Account& account = writer_.account();
  if (kind_ == CommandKind::reset)
    account.undone = account.removed;
  else
    account.undone += kind_ == CommandKind::undo ? range_.removed : -range_.removed;
}

void Restore::settle() BURR_RT {
  if (surface_.stale() != 0) return;
  state_ = State::none;
  if ((settings_.tool >= 0 || haptics::begins_free(settings_.touch)) && !hand_.tool_is_free())
    hand_.disengage();  // never go on inside bone
}

void Restore::remember_path() BURR_RT {
  if (!hand_.engaged() || active() || hand_.touch().lagging) return;
  const double step = bone_.grid().voxel / 2;
  if (path_end_ > 0 && math::norm(path_[(path_end_ - 1) % kPath] - hand_.tool()) < step) return;
  path_[path_end_++ % kPath] = hand_.tool();
}

}  // namespace burr::tick
