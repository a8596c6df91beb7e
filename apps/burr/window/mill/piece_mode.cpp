#include "window/mill/piece_mode.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <utility>

#include "burr/math/turn.h"
#include "burr/rt/flags.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;

constexpr double kDegree = std::numbers::pi / 180;
constexpr render::Colour kFrame = {0.95F, 0.70F, 0.12F};

constexpr double kAround =
    1.5;  // the frame lies so far outside of the outermost voxels' middles [voxels]

// Corners of the frame around a piece, low and high, in p_grid.
std::array<Vec3, 2> box_of(const volume::Bone& piece) {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (volume::BrickIndex brick = 0; brick < piece.brick_count(); ++brick) {
    const volume::Field* const field = piece.brick_field(brick);
    if (field == nullptr) continue;
    const math::Ijk first = piece.brick_ijk(brick);
    for (int v = 0; v < volume::kBrickVoxels; ++v) {
      if (field[v] < volume::kIso) continue;
      const Vec3 p = (first + math::Ijk(v & 7, v >> 3 & 7, v >> 6)).cast<double>();
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  }
  return {Vec3(low.array() - kAround), Vec3(high.array() + kAround)};
}

constexpr double kLeastNewsMm3 = 0.05;

double degrees_of(const Quat& q) { return math::rotation_vector(q).norm() / kDegree; }

}  // namespace

PieceMode::PieceMode(sim::Session& session, const scenario::CaseLesson* lesson,
                     edit::PieceStore moved)
    : session_(session), lesson_(lesson), mover_(session, std::move(moved)) {}

std::string PieceMode::look(bool open, const tick::TickRow& row) {
  std::string text;
  held_ = row.piece;
  for (const sim::PieceMover::News& news : mover_.look(row.piece)) {
    if (news.dust && news.volume < kLeastNewsMm3 * 1e-9) continue;  // it would read as 0.0 mm³
    text = news.sucked ? say(Word::piece_sucked, 1e9 * news.volume)
           : news.dust ? say(Word::piece_dust, news.count, 1e9 * news.volume)
                       : say(Word::piece_free, 1e9 * news.volume);
  }
  const sim::PieceMover::State state = mover_.state();
  if (putting_ && state == sim::PieceMover::State::put) {
    putting_ = false;
    taken_.reset();
    text = mover_.overlap() > 0.05e-9 ? say(Word::piece_overlaps, 1e9 * mover_.overlap())
                                      : std::string(word(Word::piece_lies));
  } else if (putting_ && (mover_.take_refusal() || state == sim::PieceMover::State::refused)) {
    putting_ = false;
    text = say(Word::piece_refused, mover_.why());
  } else if (putting_ && !mover_.busy()) {
    putting_ = false;  // an undo or a reset came first
  }
  follow();
  if (!open) {
    leave();
    list_.reset();
    asked_ = false;
    return text;
  }
  const std::uint64_t writes = session_.writes();
  if (taken_ || putting_ || mover_.lifts()) return text;
  if (list_ && writes != listed_writes_) {  // it was cut, undone, put down
    list_.reset();
    asked_ = false;
  }
  if (!list_ && !asked_) {
    mover_.take();
    asked_ = true;
    listed_writes_ = writes;
  }
  if (list_) return text;
  list_ = mover_.list();
  boxes_.clear();
  if (list_)
    for (const edit::PieceStore::Found& piece : *list_) boxes_.push_back(box_of(*piece.bone));
  return text;
}

// The ghost is where the bone stopped the piece.
void PieceMode::follow() {
  if (!taken_ || !taken_->lifts) return;
  Taken& taken = *taken_;
  if (!mover_.lifts()) {
    if (mover_.state() == sim::PieceMover::State::refused)
      taken.lifts = false;  // it cannot come out: a picture only
    else if (!putting_)
      taken_.reset();  // an undo or a reset has put it back
    return;
  }
  if (!out()) return;
  const Quat turn(held_.turn[3], held_.turn[0], held_.turn[1], held_.turn[2]);
  const Vec3 by = held_.p - taken.piece.now * taken.piece.centre;
  const Quat further = math::normalized(math::product(turn, taken.piece.now.q.conjugate()));
  if (!std::exchange(taken.seen_out, true) && taken.asked) {
    want();  // it was moved while it was still on its way out
    return;
  }
  taken.by = by;
  taken.turn = further;
}

// The piece goes where it was wanted, as far as the bone lets it.
void PieceMode::want() {
  Taken& taken = *taken_;
  taken.asked = true;
  if (!taken.lifts || !out()) return;
  const Pose to = pose_of(taken);
  mover_.shift({to * taken.piece.centre, to.q});
}

void PieceMode::leave() {
  if (!taken_ || putting_) return;
  if (taken_->lifts) mover_.leave();
  taken_.reset();
}

void PieceMode::end() {
  constexpr auto kPause = std::chrono::milliseconds(10);
  constexpr int kPauses = 1000;
  leave();
  tick::TickRow row;
  const auto restoring = [&row] { return (row.contact.flags & rt::kFlagRestoring) != 0; };
  for (int n = 0; n < kPauses && (n == 0 || mover_.busy() || restoring()); ++n) {
    if (mover_.take_refusal()) mover_.leave();  // it could not be put down
    std::this_thread::sleep_for(kPause);
    if (session_.view(row)) held_ = row.piece;
    static_cast<void>(mover_.look(held_));
  }
  putting_ = false;
  taken_.reset();
}

Pose PieceMode::pose_of(const Taken& taken) const {
  const Vec3 centre = taken.piece.now * taken.piece.centre;
  const Pose further = {centre + taken.by - taken.turn * centre, taken.turn};
  return further * taken.piece.now;
}

void PieceMode::take(std::size_t row) {
  // one after the other: another may still be on its way back
  if (!list_ || row >= list_->size() || taken_ || mover_.busy()) return;
  Taken taken;
  taken.piece = (*list_)[row];
  taken.row = row;
  taken.mesh = workshop::mesh_of_piece(*taken.piece.bone);
  if (lesson_ != nullptr) taken.plan = workshop::plan_of(*lesson_, *taken.piece.bone);
  taken.lifts = mover_.lift(taken.piece);
  taken_ = std::move(taken);
}

void PieceMode::put_down() {
  if (!taken_ || putting_) return;
  putting_ =
      taken_->lifts ? mover_.put_down() : mover_.put(taken_->piece, taken_->by, taken_->turn);
}

void PieceMode::carry(const Carrier& by) {
  if (!taken_ || putting_) return;
  Taken& taken = *taken_;
  if (out()) {  // the tick does it
    taken.grip.reset();
    return;
  }
  if (!by.grabs) {
    taken.grip.reset();
    taken.may_grab = true;
    return;
  }
  if (!taken.may_grab) return;
  if (taken.grip && taken.grip->which != by.which) taken.grip.reset();  // the other hand takes over
  if (!taken.grip) taken.grip = {by.hand.p, taken.by, by.hand.q, taken.turn, by.which};
  const Taken::Grip& grip = *taken.grip;
  taken.by = grip.by + (by.hand.p - grip.hand);
  if (by.turns)
    taken.turn =
        math::normalized(math::product(math::product(by.hand.q, grip.held.conjugate()), grip.turn));
  want();
}

void PieceMode::shift(const Vec3& by) {
  if (!taken_ || putting_) return;
  taken_->grip.reset();  // the hand grabs anew, from here
  taken_->by += by;
  want();
}

void PieceMode::turn(const Vec3& axis, double degrees) {
  if (!taken_ || putting_) return;
  taken_->grip.reset();
  taken_->turn = math::normalized(
      math::product(Quat(Eigen::AngleAxisd(degrees * kDegree, axis)), taken_->turn));
  want();
}

void PieceMode::set(const std::array<double, 3>& mm, const std::array<double, 3>& degrees) {
  if (!taken_ || putting_) return;
  taken_->grip.reset();
  taken_->by = Vec3(mm[0], mm[1], mm[2]) * 1e-3;
  const Vec3 turn = Vec3(degrees[0], degrees[1], degrees[2]) * kDegree;
  const double angle = turn.norm();
  taken_->turn = angle > 0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat(Quat::Identity());
  want();
}

std::string PieceMode::plan_text() const {
  if (!taken_ || taken_->plan == nullptr) return {};
  const Pose whole = pose_of(*taken_);
  const Vec3 by = whole * taken_->piece.centre - taken_->piece.centre;
  const workshop::OffPlan off = workshop::off_plan(*taken_->plan, by, whole.q);
  return say(Word::piece_plan, 1e3 * off.way, 1e3 * off.wanted_way, 1e3 * off.off,
             off.turned_off / kDegree);
}

PiecesState PieceMode::state() const {
  PiecesState state;
  state.looking = list_ == nullptr;
  state.putting = putting_ || (!taken_ && mover_.busy());
  if (list_)
    for (const edit::PieceStore::Found& piece : *list_)
      state.rows.push_back({1e9 * piece.volume,
                            1e3 * (piece.now * piece.centre - piece.centre).norm(),
                            degrees_of(piece.now.q)});
  if (!taken_) return state;
  state.taken = taken_->row;
  state.felt = taken_->lifts;
  const Vec3 turn = math::rotation_vector(taken_->turn) / kDegree;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    state.mm[axis] = 1e3 * taken_->by[static_cast<int>(axis)];
    state.degrees[axis] = turn[static_cast<int>(axis)];
  }
  state.plan = plan_text();
  return state;
}

void PieceMode::frame(render::Scene& scene, const edit::PieceStore::Found& piece,
                      double line) const {
  const auto n = static_cast<std::size_t>(&piece - list_->data());
  const volume::Grid& grid = piece.bone->grid();
  const auto corner = [&](int c) {
    const std::array<Vec3, 2>& box = boxes_[n];
    const Vec3 p((c & 1) != 0 ? box[1].x() : box[0].x(), (c & 2) != 0 ? box[1].y() : box[0].y(),
                 (c & 4) != 0 ? box[1].z() : box[0].z());
    return Vec3(piece.now * grid.world_from_grid(p));
  };
  for (int c = 0; c < 8; ++c)
    for (const int edge : {1, 2, 4})
      if ((c & edge) == 0)
        scene.rods.push_back({corner(c), corner(c | edge), line, kFrame, false, false});
}

void PieceMode::show(render::Scene& scene, bool shown) {
  // what was drawn before
  std::erase_if(scene.rods,
                [this](const render::Rod& rod) { return line_ > 0 && rod.radius == line_; });
  line_ = 0;
  ghost_.take_away(scene);
  if (!shown || !list_) return;
  line_ = 0.00121 * scene.camera.view_height();
  for (const edit::PieceStore::Found& piece : *list_) frame(scene, piece, line_);
  if (taken_)
    ghost_.put(scene, taken_->mesh, pose_of(*taken_), session_.bone_tissues().tissues.size());
}

}  // namespace burr::app
