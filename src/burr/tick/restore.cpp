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
                 Hand& hand, HeldPiece& piece)
    : bone_(bone),
      surface_(surface),
      undo_(undo),
      writer_(writer),
      settings_(settings),
      hand_(hand),
      piece_(piece),
      dt_(1.0 / settings.rate_hz),
      path_(kPath) {}

bool Restore::begin(CommandKind kind) BURR_RT {
  if (active()) return false;
  if (kind == CommandKind::leave_piece ? !lifted_.now : lifted_.now && kind == CommandKind::redo)
    return false;
  if (kind == CommandKind::leave_piece) kind = CommandKind::undo;
  if (undo_.stroke_open())
    undo_.end_stroke(writer_.account().removed, lifted_.now ? lifted_.lost : 0);
  back_ = lifted_.now;
  if (lifted_.now) piece_.drop();
  lifted_ = {};
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

bool Restore::lay_ready(const edit::MovedBricks& bricks) {
  const MoveState now = move_state();
  if (now == MoveState::waiting || now == MoveState::moving) return false;
  move_state_.store(MoveState::waiting, std::memory_order_relaxed);
  ready_.store(&bricks, std::memory_order_release);
  return true;
}

void Restore::take_back() {
  if (ready_.exchange(nullptr, std::memory_order_acq_rel) != nullptr)
    move_state_.store(MoveState::refused, std::memory_order_release);
}

bool Restore::has_room(const edit::MovedBricks& bricks) const BURR_RT {
  std::size_t fresh = 0;
  for (const edit::KeptBrick& brick : bricks.bricks)
    if (bone_.brick_field(brick.brick) == nullptr) ++fresh;
  return fresh <= bone_.free_slots();
}

// Are these the bricks of this command, and is there what they begin from?
bool Restore::may_move(const Command& command, const edit::MovedBricks& bricks) const BURR_RT {
  const edit::PieceMove& move = command.move;
  if (active() || bricks.hash != move.bricks || move.writes != writer_.writes_done()) return false;
  if (command.kind == CommandKind::lift_piece)
    return !lifted_.now && bricks.body.tool.count > 0 && bricks.body.hash == move.body;
  if (move.lifted != lifted_.now) return false;
  return !lifted_.now || (move.piece == lifted_.piece && lies_at(move));
}

// Bricks are prepared in some tenths of a second. A hand may have moved the piece since.
bool Restore::lies_at(const edit::PieceMove& move) const BURR_RT {
  constexpr double kSamePlace = 1e-6, kSameTurn = 1e-9;  // [m]; 1 - |cosine of half the angle|
  const math::Pose& at = piece_.pose();
  const math::Vec3 by(move.by[0], move.by[1], move.by[2]);
  const double cosine = at.q.x() * move.turn[0] + at.q.y() * move.turn[1] +
                        at.q.z() * move.turn[2] + at.q.w() * move.turn[3];
  return (at.p - lifted_.centre - by).norm() < kSamePlace && 1 - std::abs(cosine) < kSameTurn;
}

void Restore::begin_move(const Command& command, std::uint32_t& flags) BURR_RT {
  const edit::MovedBricks* const bricks = ready_.exchange(nullptr, std::memory_order_acquire);
  if (bricks == nullptr) return;
  const bool may = may_move(command, *bricks);
  const bool room = !may || has_room(*bricks);
  const bool undoable = !may || bricks->bricks.size() + lifted_.bricks <= undo_.room();
  if (!room) flags |= rt::kFlagReserve;
  if (!undoable) flags |= rt::kFlagUndoFull;
  if (!may || !room || !undoable) {
    move_state_.store(MoveState::refused, std::memory_order_release);
    return;
  }
  if (!lifted_.now) {
    if (undo_.stroke_open()) undo_.end_stroke(writer_.account().removed);
    undo_.begin_stroke(path_end_, writer_.account().removed);
  }
  piece_.drop();
  kind_ = command.kind;
  if (kind_ == CommandKind::lift_piece)
    lifted_ = {
        true, command.move.piece, bricks->bricks.size(), bricks->lost,
        bricks->body.at.p - math::Vec3(command.move.by[0], command.move.by[1], command.move.by[2])};
  state_ = State::lifting;
  restored_ = 0;
  moving_ = bricks;
  has_moved_ = true;
  move_state_.store(MoveState::moving, std::memory_order_release);
}

void Restore::take_splinter(const Command& command, std::uint32_t& flags) BURR_RT {
  const edit::MovedBricks* const splinter = ready_.exchange(nullptr, std::memory_order_acquire);
  if (splinter == nullptr) return;
  const bool may = !active() && !lifted_.now && splinter->hash == command.move.bricks &&
                   command.move.writes == writer_.writes_done() && splinter->body.tool.count == 0 &&
                   !splinter->bricks.empty() && splinter->bricks.size() <= kSplinterBricks;
  const bool undoable = !may || splinter->bricks.size() <= undo_.room();
  if (!undoable) flags |= rt::kFlagUndoFull;
  if (!may || !undoable) {
    move_state_.store(MoveState::refused, std::memory_order_release);
    return;
  }
  edit::Account& account = writer_.account();
  if (undo_.stroke_open()) undo_.end_stroke(account.removed);
  undo_.begin_stroke(path_end_, account.removed);
  for (const edit::KeptBrick& brick : splinter->bricks) writer_.put(brick, flags);
  account.moved += splinter->lost;
  undo_.end_stroke(account.removed, splinter->lost);
  if (command.value > 0) taken_by_second_ += splinter->lost;
  move_state_.store(MoveState::done, std::memory_order_release);
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
    put_back(flags);
  } else {
    settle();
  }
  hand_.feel_held_tool();  // the hand feels the tool where it is held
}

void Restore::lift(std::uint32_t& flags) BURR_RT {
  if (settings_.tool >= 0 || moving_ != nullptr || back_) {
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

void Restore::put_back(std::uint32_t& flags) BURR_RT {
  const auto most = static_cast<std::size_t>(std::max(1.0, std::ceil(kRestorePerSecond * dt_)));
  if (moving_ != nullptr) {
    lay(most, flags);
    return;
  }
  for (std::size_t n = 0; n < most && restored_ < range_.count; ++n, ++restored_) {
    if (kind_ == CommandKind::reset) {
      writer_.restore(undo_.original(static_cast<std::size_t>(restored_)));
    } else {
      writer_.swap(undo_.entry(range_.first + restored_));
    }
  }
  if (restored_ < range_.count) return;
  state_ = State::settling;
  if (back_ && kind_ == CommandKind::undo) undo_.forget_undone();  // nobody can hold it again
  edit::Account& account = writer_.account();
  if (kind_ == CommandKind::reset)
    account.moved = 0;
  else
    account.moved += kind_ == CommandKind::undo ? -range_.moved : range_.moved;
  if (kind_ == CommandKind::reset)
    account.undone = account.removed;
  else
    account.undone += kind_ == CommandKind::undo ? range_.removed : -range_.removed;
}

// Bricks of a move. The stroke of a lift stays open until the piece is put down.
void Restore::lay(std::size_t most, std::uint32_t& flags) BURR_RT {
  const std::size_t count = moving_->bricks.size();
  for (std::size_t n = 0; n < most && restored_ < count; ++n, ++restored_)
    writer_.put(moving_->bricks[static_cast<std::size_t>(restored_)], flags);
  if (restored_ < count) return;
  writer_.account().moved += moving_->lost;
  state_ = State::settling;
  if (kind_ == CommandKind::lift_piece) return;
  undo_.end_stroke(writer_.account().removed, lifted_.lost + moving_->lost);
  lifted_ = {};
}

void Restore::settle() BURR_RT {
  if (surface_.stale() != 0) return;
  state_ = State::none;
  back_ = false;
  if (moving_ != nullptr) {
    if (kind_ == CommandKind::lift_piece) piece_.lift(moving_->body);
    moving_ = nullptr;
    move_state_.store(MoveState::done, std::memory_order_release);
  }
  if ((settings_.tool >= 0 || haptics::begins_free(settings_.touch)) && !hand_.tool_is_free())
    hand_.disengage();  // never go on inside bone
}

void Restore::remember_path() BURR_RT {
  if (!hand_.engaged() || active() || lifted_.now || hand_.touch().lagging) return;
  const double step = bone_.grid().voxel / 2;
  if (path_end_ > 0 && math::norm(path_[(path_end_ - 1) % kPath] - hand_.tool()) < step) return;
  path_[path_end_++ % kPath] = hand_.tool();
}

}  // namespace burr::tick
