#include "burr/sim/piece_mover.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include "burr/sim/move_pieces.h"
#include "burr/tick/restore.h"
#include "burr/volume/shared_copy.h"
#include "burr/volume/volume_of.h"

namespace burr::sim {
namespace {

constexpr auto kLook = std::chrono::milliseconds(500);
constexpr auto kLookSucking = std::chrono::milliseconds(150);
constexpr int kTries = 20;  // to copy the bone between two writes
// The recorder has every brick by then: a reader of the recording finds the bone that was copied.
constexpr auto kRest = std::chrono::milliseconds(150);

bool boxes_meet(const volume::Piece& a, const volume::Piece& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

// The same piece, perhaps cut a little since, or moved.
bool same(const volume::Piece& a, const volume::Piece& b) {
  constexpr double kAlike = 0.03;  // of the volume: resampling changes a little
  if (boxes_meet(a, b)) return true;
  return std::abs(static_cast<double>(a.voxels - b.voxels)) <=
         kAlike * static_cast<double>(std::max(a.voxels, b.voxels));
}

// Whether a tube draws it in, by the box around it.
bool may_be_sucked(const volume::Piece& piece, const volume::Grid& grid,
                   const PieceMover::Suction& by) {
  const math::Vec3 low = piece.low.cast<double>(), high = piece.high.cast<double>(),
                   mouth = grid.grid_from_world(by.mouth),
                   nearest = mouth.cwiseMax(low).cwiseMin(high);
  if ((nearest - mouth).norm() * grid.voxel > by.reach) return false;
  std::array<int, 3> side;
  for (std::size_t axis = 0; axis < 3; ++axis)
    side[axis] = piece.high[static_cast<int>(axis)] - piece.low[static_cast<int>(axis)] + 1;
  std::sort(side.begin(), side.end());
  return side[1] * grid.voxel <= 2 * by.bore;
}

// From the mouth to the nearest voxel that the bone loses by these bricks  [m]
double distance_to(const math::Vec3& mouth, const volume::Bone& bone,
                   const edit::MovedBricks& bricks) {
  const math::Vec3 at = bone.grid().grid_from_world(mouth);
  double least = std::numeric_limits<double>::infinity();
  for (const edit::KeptBrick& now : bricks.bricks) {
    const volume::Field* const was = bone.brick_field(now.brick);
    if (was == nullptr) continue;
    const math::Ijk first = bone.brick_ijk(now.brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (was[v] < volume::kIso || now.field.voxel[v] >= volume::kIso) continue;
      const math::Ijk voxel = first + math::Ijk(v & 7, v >> 3 & 7, v >> 6);
      least = std::min(least, (voxel.cast<double>() - at).norm());
    }
  }
  return least * bone.grid().voxel;
}

}  // namespace

PieceMover::PieceMover(Session& session, edit::PieceStore moved)
    : session_(session),
      finder_(session.bone()),
      changed_(session.bone().add_watcher()),
      store_(std::move(moved)) {
  seen_ = seen_before_ = session_.writes();
  thread_ = std::thread([this] { run(); });
}

PieceMover::~PieceMover() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void PieceMover::run() {
  // Reads the whole bone once, here and not where the page opens. What is in pieces already is no news.
  while (finder_.update() > 0) {
    {
      const std::lock_guard lock(mutex_);
      if (stopping_) return;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  known_ = finder_.pieces();
  for (std::size_t n = 1; n < known_.size(); ++n)
    if (edit::is_dust(session_.bone(), finder_, n)) old_splinters_.push_back(known_[n]);
  for (;;) {
    std::optional<Suction> suction;
    std::optional<Wanted> move;
    bool list = false, away = false;
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, suction_ ? kLookSucking : kLook,
                     [this] { return stopping_ || list_wanted_ || move_wanted_; });
      if (stopping_) return;
      move = std::exchange(move_wanted_, {});
      list = std::exchange(list_wanted_, false);
      away = away_;
      if (!splinter_) suction = suction_;
    }
    if (move) prepare(*move);
    if (list) list_pieces();
    if (!move && !list && !away) notice();
    if (!move && !list && !away && suction) {
      prepare_splinter(*suction);
      ++looks_;
    }
  }
}

// The first splinter in reach; the next one in the next look.
void PieceMover::prepare_splinter(const Suction& by) {
  if (session_.writes() != seen_) return;  // the finder knows the bone as it is
  const volume::Grid& grid = session_.bone().grid();
  const std::vector<volume::Piece>& now = finder_.pieces();
  for (std::size_t n = 1; n < now.size(); ++n) {
    const volume::Piece& piece = now[n];
    if (!edit::is_dust(session_.bone(), finder_, n) || !may_be_sucked(piece, grid, by)) continue;
    if (std::any_of(old_splinters_.begin(), old_splinters_.end(),
                    [&](const volume::Piece& old) { return boxes_meet(old, piece); }))
      continue;
    const auto copied = copy();
    if (!copied) return;
    Splinter splinter;
    splinter.second = by.second;
    splinter.move.writes = copied->writes;
    for (std::size_t axis = 0; axis < 3; ++axis)
      splinter.move.seed[axis] = piece.seed[static_cast<int>(axis)];
    const auto bricks = edit::PieceStore{}.prepare_splinter(*copied->bone, splinter.move);
    if (!bricks || (*bricks)->bricks.size() > tick::Restore::kSplinterBricks ||
        distance_to(by.mouth, *copied->bone, **bricks) > by.reach)
      continue;
    splinter.move.bricks = (*bricks)->hash;
    splinter.bricks = *bricks;
    const std::lock_guard lock(mutex_);
    splinter_ = std::move(splinter);
    return;
  }
}

void PieceMover::suck(const std::optional<Suction>& by) {
  const std::lock_guard lock(mutex_);
  suction_ = by;
}

// Sends what has been prepared, and tells when it is taken. One that is refused, because the bone was
// written meanwhile, is prepared anew.
std::optional<PieceMover::News> PieceMover::look_at_splinter(bool may_send) {
  std::optional<News> news;
  if (sucked_) {
    const tick::MoveState now = session_.move_state();
    if (now == tick::MoveState::waiting || now == tick::MoveState::moving) return news;
    const double voxel = session_.bone().grid().voxel;
    if (now == tick::MoveState::done)
      news = News{static_cast<double>(sucked_->bricks->lost) * voxel * voxel * voxel /
                      static_cast<double>(volume::kVoxelUnits),
                  true, 1, true};
    sucked_.reset();
  }
  std::optional<Splinter> next;
  {
    const std::lock_guard lock(mutex_);
    next = std::exchange(splinter_, {});
    if (!suction_) next.reset();  // it was lifted, or stopped
  }
  if (next && may_send && session_.take_splinter(next->move, next->second, next->bricks))
    sucked_ = std::move(next);
  return news;
}

// Only when the bone rests: two looks that find the same number of writes.
void PieceMover::notice() {
  const std::uint64_t writes = session_.writes();
  const bool rests = writes == std::exchange(seen_before_, writes);
  if (!rests || writes == seen_) return;
  if (finder_.update() > 0) return;
  seen_ = writes;
  const std::vector<volume::Piece>& now = finder_.pieces();
  const double voxel = session_.bone().grid().voxel, one = voxel * voxel * voxel;
  News dust;
  dust.dust = true;
  dust.count = 0;
  std::vector<News> news;
  for (std::size_t n = 1; n < now.size(); ++n) {
    const bool known =
        std::any_of(known_.begin() + std::min<std::ptrdiff_t>(1, std::ssize(known_)), known_.end(),
                    [&](const volume::Piece& before) { return same(before, now[n]); });
    if (known) continue;
    const double size = static_cast<double>(now[n].voxels) * one;
    if (edit::is_dust(session_.bone(), finder_, n)) {
      ++dust.count;
      dust.volume += size;
    } else {
      news.push_back({size, false, 1});
    }
  }
  known_ = now;
  if (dust.count > 0) news.push_back(dust);
  const std::lock_guard lock(mutex_);
  list_.reset();
  news_.insert(news_.end(), news.begin(), news.end());
}

Result<PieceMover::Copy> PieceMover::copy() {
  NoProgress quiet;
  for (int n = 0; n < kTries; ++n) {
    Copy copied;
    copied.writes = session_.writes();
    std::this_thread::sleep_for(kRest);
    if (session_.writes() != copied.writes) continue;
    auto bone = volume::shared_copy(session_.bone(), changed_, quiet);
    if (!bone) return bone.error();
    if (session_.writes_begun() != copied.writes) continue;
    copied.bone = std::move(*bone);
    return copied;
  }
  return error("the bone is being cut; lift the tool, and try again");
}

void PieceMover::list_pieces() {
  auto copied = copy();
  auto pieces = std::make_shared<std::vector<edit::PieceStore::Found>>();
  edit::PieceStore store;
  {
    const std::lock_guard lock(mutex_);
    store = store_;  // shares the pieces
  }
  if (copied) *pieces = store.list(*copied->bone);
  const std::lock_guard lock(mutex_);
  if (copied) list_ = std::move(pieces);
}

void PieceMover::prepare(Wanted wanted) {
  edit::PieceMove& move = wanted.move;
  auto copied = copy();
  edit::PieceStore store;
  {
    const std::lock_guard lock(mutex_);
    store = store_;
  }
  std::optional<Result<ToSend>> ready;
  if (!copied) {
    ready.emplace(copied.error());
  } else {
    move.writes = copied->writes;
    auto bricks =
        wanted.lifts ? store.prepare_lift(*copied->bone, move) : store.prepare(*copied->bone, move);
    if (bricks) {
      move.bricks = bricks->bricks->hash;
      move.body = bricks->bricks->body.hash;
      ready.emplace(ToSend{move, std::move(*bricks), wanted.lifts});
    } else {
      ready.emplace(bricks.error());
    }
  }
  const std::lock_guard lock(mutex_);
  ready_ = std::move(ready);
}

void PieceMover::want(const Wanted& wanted) {
  state_ = State::preparing;
  {
    const std::lock_guard lock(mutex_);
    move_wanted_ = wanted;
    away_ = away_ || wanted.lifts;
  }
  wake_.notify_all();
}

// What has been prepared goes to the servo.
void PieceMover::send(Result<ToSend>& ready) {
  if (!ready) {
    why_ = ready.error().text;
    state_ = State::refused;
    return;
  }
  if (ready->lifts && lifted_ && lifted_->leaves) {  // it need not come out any more
    lifted_.reset();
    state_ = State::none;
    return;
  }
  under_way_ = std::move(*ready);
  const bool sent = under_way_->lifts
                        ? session_.lift_piece(under_way_->move, under_way_->bricks.bricks)
                        : session_.move_piece(under_way_->move, under_way_->bricks.bricks);
  state_ = sent ? State::sent : State::refused;
  if (!sent) why_ = "another piece is being moved";
}

// What the servo made of it.
void PieceMover::see_end() {
  const tick::MoveState now = session_.move_state();
  if (now == tick::MoveState::refused) {
    why_ = "the bone was changed, or there is no room for the piece";
    state_ = State::refused;
    return;
  }
  if (now != tick::MoveState::done) return;
  const double voxel = session_.bone().grid().voxel;
  overlap_ = static_cast<double>(under_way_->bricks.bricks->overlap) * voxel * voxel * voxel /
             static_cast<double>(volume::kVoxelUnits);
  state_ = under_way_->lifts ? State::lifted : State::put;
  if (state_ == State::put) lifted_.reset();
  const std::lock_guard lock(mutex_);
  store_.accept(under_way_->bricks);
  list_.reset();
}

// Of a piece that is out of the bone, or was a moment ago.
void PieceMover::see_lifted(const tick::PieceRow& piece) {
  const bool there = piece.state != tick::PieceRow::kNone;
  if (lifted_ && state_ == State::refused && !lifted_->seen) lifted_.reset();  // it never came out
  if (lifted_ && state_ == State::refused) {  // it could not be put down
    state_ = State::lifted;
    refusal_ = true;
  }
  if (lifted_ && state_ == State::lifted) {
    lifted_->seen = lifted_->seen || there;
    // the servo has obeyed earlier commands, for example where to go, when the piece rests for some looks
    constexpr int kLooks = 3;
    lifted_->rested = there && piece.p == lifted_->last && piece.turn == lifted_->last_turn
                          ? lifted_->rested + 1
                          : 0;
    lifted_->last = piece.p;
    lifted_->last_turn = piece.turn;
    const bool rested = lifted_->rested >= kLooks;
    // an undo may have put it back before a row showed it out
    constexpr int kUnseen = 100, kAgain = 50;
    const bool never_seen = !lifted_->seen && ++lifted_->unseen >= kUnseen;
    if ((lifted_->seen && !there) || never_seen) {
      lifted_.reset();
      state_ = State::none;
    } else if (lifted_->seen && lifted_->leaves) {
      // again where it did not reach the servo
      if (lifted_->left++ % kAgain == 0) session_.command({tick::CommandKind::leave_piece, 0});
    } else if (lifted_->puts_down && piece.state != tick::PieceRow::kLies && there) {
      session_.command({tick::CommandKind::let_go, 0});
    } else if (lifted_->puts_down && rested) {
      lifted_->puts_down = false;
      const math::Quat turn(piece.turn[3], piece.turn[0], piece.turn[1], piece.turn[2]);
      want({put_at(lifted_->number, lifted_->centre, {piece.p, turn}), false});
    }
  }
  const std::lock_guard lock(mutex_);
  away_ = lifted_.has_value();
}

std::vector<PieceMover::News> PieceMover::look(const tick::PieceRow& piece) {
  std::optional<Result<ToSend>> ready;
  std::vector<News> news;
  {
    const std::lock_guard lock(mutex_);
    if (!sucked_) ready = std::exchange(ready_, {});
    news = std::exchange(news_, {});
  }
  const bool free = !ready && !lifted_ && state_ != State::preparing && state_ != State::sent;
  if (const auto sucked = look_at_splinter(free)) news.push_back(*sucked);
  if (ready) send(*ready);
  if (state_ == State::sent) see_end();
  see_lifted(piece);
  return news;
}

bool PieceMover::lift(const edit::PieceStore::Found& piece) {
  if (lifted_ || state_ == State::preparing || state_ == State::sent) return false;
  lifted_ = Lifted{piece.number, piece.centre};
  refusal_ = false;
  want({further(piece, math::Vec3::Zero(), math::Quat::Identity()), true});
  return true;
}

void PieceMover::shift(const math::Pose& body) {
  if (state_ != State::lifted) return;
  edit::PieceMove to = put_at(lifted_->number, math::Vec3::Zero(), body);
  session_.command({tick::CommandKind::shift_piece, static_cast<double>(to.piece), to});
}

bool PieceMover::put_down() {
  if (!lifted_) return false;
  lifted_->puts_down = true;
  return true;
}

void PieceMover::leave() {
  if (!lifted_) return;
  lifted_->leaves = true;
  lifted_->puts_down = false;
}

void PieceMover::take() {
  {
    const std::lock_guard lock(mutex_);
    list_.reset();  // it may be older than an undo
    list_wanted_ = true;
  }
  wake_.notify_all();
}

std::shared_ptr<const std::vector<edit::PieceStore::Found>> PieceMover::list() const {
  const std::lock_guard lock(mutex_);
  return list_;
}

bool PieceMover::put(const edit::PieceStore::Found& piece, const math::Vec3& by,
                     const math::Quat& turn) {
  if (lifted_ || state_ == State::preparing || state_ == State::sent) return false;
  want({further(piece, by, turn), false});
  return true;
}

}  // namespace burr::sim
