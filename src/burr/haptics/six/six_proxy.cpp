#include "burr/haptics/six/six_proxy.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "burr/math/sums.h"
#include "burr/math/turn.h"
#include "burr/rt/simd.h"

namespace burr::haptics {
namespace {

using math::Quat;
using math::Vec3;
using volume::kBrickEdge;

constexpr double kSkin = 1e-3;       // beyond what is needed now, for the next ticks    [m]
constexpr double kLeastMove = 0.02;  // points this near are always looked at      [voxel]
constexpr double kTurnError = 0.02;  // that a turn of one move may err by         [voxel]
constexpr int kSuper = 4;            // bricks along the edge of a block of bricks
constexpr int kRounds = 10;          // guesses of how far a move goes
constexpr double kRest = 0.1;        // of a move left over that counts as rest       [voxel]
constexpr double kLayer = 0.1;       // above the bone, that carries a face's load         [voxel]
constexpr double kRounding = 0.01;   // of floats, and more                           [voxel]
constexpr int kHoldMoves = 3;        // to where friction holds the tool
// A point so far to the side of an edge still carries it by its plane: a little more than half of the
// widest gap between points                                                           [voxel]
constexpr double kBeside = 0.7;

double length3(const Six& z, std::size_t first) BURR_RT {
  return std::sqrt(math::sum_of_three(z[first] * z[first], z[first + 1] * z[first + 1],
                                      z[first + 2] * z[first + 2]));
}

// Bone that curves away under a plane lets moves overshoot to and fro, with nearly the same length.
// Where a move turns back, the next ones are made shorter, by the secant through both (Irons & Tuck
// 1969).
class Settling {
 public:
  // The share of the move z to make. cut_short: z is not where it wanted to go.
  double share(const Six& z, bool cut_short) BURR_RT {
    constexpr double kLeast = 0.15;
    if (cut_short) {
      known_ = false;
      return share_ = 1;
    }
    if (known_ && dot6(last_, z) >= 0) share_ = std::min(1.0, 2 * share_);
    if (known_ && dot6(last_, z) < 0) {
      Six change = z;
      for (std::size_t k = 0; k < 6; ++k) change[k] -= last_[k];
      share_ = std::clamp(-share_ * dot6(last_, change) / dot6(change, change), kLeast, 1.0);
    }
    known_ = true;
    last_ = z;
    return share_;
  }

 private:
  Six last_ = {};
  double share_ = 1;
  bool known_ = false;
};

}  // namespace

RowKernel row_kernel() noexcept {
  if constexpr (rt::kWideKernels) {
    if (rt::simd() == rt::Simd::avx512)
      return {avx512::take_points, avx512::make_rows, avx512::press_points, avx512::worst_row};
    if (rt::simd() == rt::Simd::avx2)
      return {avx2::take_points, avx2::make_rows, avx2::press_points, avx2::worst_row};
  }
  return {scalar::take_points, scalar::make_rows, scalar::press_points, scalar::worst_row};
}

SixProxy::SixProxy(const volume::IsoVertices& surface, const tool::Tool& tool,
                   const SixSettings& settings, const math::Pose& hand)
    : surface_(surface),
      grid_(surface.bone().grid()),
      settings_(settings),
      kernel_(row_kernel()),
      lever_(settings.lever / grid_.voxel),
      rows_(std::make_unique<Rows>()),
      places_(std::make_unique<Rows>()),
      pressed_(std::make_unique<Pressed>()) {
  for (Near& near : near_) near.points = std::make_unique<NearPoints>();
  place(hand);
  take(tool);
}

void SixProxy::take(const tool::Tool& tool) BURR_RT {
  tool_ = tool;
  double farthest = 1;
  any_planes_ = false;
  for (int part = 0; part < tool.count; ++part) {
    const tool::Part& one = tool.parts[index(part)];
    shape_[index(part)] = tool::scaled(one.shape, 1 / grid_.voxel);
    const tool::BoundingBall ball = tool::bounding_ball(one.shape);
    far_[index(part)] = (math::norm(one.tool_from_part * ball.centre) + ball.radius) / grid_.voxel;
    if (one.role != tool::Role::seen) farthest = std::max(farthest, far_[index(part)]);
    near_[index(part)].reach = -1;
    const tool::ShapeKind kind = one.shape.kind;
    planes_[index(part)] = settings_.planes && surface_.largest_disc() > 0 && tool::convex(kind) &&
                           kind != tool::ShapeKind::ball && kind != tool::ShapeKind::capsule;
    any_planes_ = any_planes_ || planes_[index(part)];
  }
  most_ = {settings_.longest / grid_.voxel,
           std::min(settings_.most_turn, std::sqrt(2 * kTurnError / farthest))};
  last_ = {kLeastMove, kLeastMove / farthest};
}

void SixProxy::place(const math::Pose& pose) BURR_RT {
  c_ = grid_.grid_from_world(pose.p);
  r_ = math::normalized(math::product(grid_.frame.q.conjugate(), pose.q));
}

math::Pose SixProxy::pose() const BURR_RT {
  return {grid_.world_from_grid(c_), math::normalized(math::product(grid_.frame.q, r_))};
}

// ---- points of bone near a part

PartThere SixProxy::there(int part) const BURR_RT {
  const tool::Part& one = tool_.parts[index(part)];
  PartThere at;
  at.shape = shape_[index(part)];
  at.planes = planes_[index(part)];  // take() keeps the discs for them
  const Quat grid_from_part = math::product(r_, one.tool_from_part.q);
  const Vec3 middle = r_ * (one.tool_from_part.p / grid_.voxel);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 row = grid_from_part * Vec3(Vec3::Unit(axis));
    for (int k = 0; k < 3; ++k) at.part_from_grid[3 * axis + k] = static_cast<float>(row[k]);
    at.offset[axis] = static_cast<float>(-math::dot(row, middle));
    at.ball[axis] = static_cast<float>(middle[axis]);
  }
  return at;
}

// The points of one block of bricks. False: no room.
bool SixProxy::look_into(int part, const PartThere& at, const math::Ijk& super,
                         double reach) BURR_RT {
  const math::Ijk& n = surface_.bone().bricks();
  Near& near = near_[index(part)];
  const float none[3] = {0, 0, 0};
  const int bi = kSuper * super.x(), last = std::min(bi + kSuper, n.x());
  for (int bk = kSuper * super.z(); bk < std::min(kSuper * (super.z() + 1), n.z()); ++bk)
    for (int bj = kSuper * super.y(); bj < std::min(kSuper * (super.y() + 1), n.y()); ++bj) {
      const std::uint64_t* row = surface_.row(bj, bk);
      for (int i = bi; i < last; ++i) {
        if ((row[i / 64] >> (i % 64) & 1) == 0) continue;
        const volume::BrickIndex brick = surface_.bone().brick_at(i, bj, bk);
        const volume::BrickBall& ball = surface_.ball(brick);
        if (ball.radius < 0) continue;
        const Vec3 w = Vec3(static_cast<double>(ball.x), static_cast<double>(ball.y),
                            static_cast<double>(ball.z)) -
                       c_;
        const tool::Part& one = tool_.parts[index(part)];
        const Vec3 y = one.tool_from_part.q.conjugate() *
                       Vec3(r_.conjugate() * w - one.tool_from_part.p / grid_.voxel);
        if (tool::distance(shape_[index(part)], y).phi >
            reach + static_cast<double>(ball.radius) + 1e-3)
          continue;
        const std::int32_t first[3] = {kBrickEdge * i, kBrickEdge * bj, kBrickEdge * bk};
        if (!kernel_.take(surface_.blocks(brick).data(), surface_.count(brick), first,
                          near.centre.data(), none, at, static_cast<float>(reach), *near.points))
          return false;
      }
    }
  return true;
}

// Stores all points nearer to the part than `reach`. False: there are too many.
bool SixProxy::look_around(int part, double reach) BURR_RT {
  Near& near = near_[index(part)];
  near.points->count = 0;
  near.centre = c_;
  near.turn = r_;
  near.revision = surface_.revision();
  near.reach = -1;
  const tool::Part& one = tool_.parts[index(part)];
  const tool::Shape& shape = shape_[index(part)];
  const Quat grid_from_part = math::product(r_, one.tool_from_part.q);
  const Vec3 middle = c_ + r_ * (one.tool_from_part.p / grid_.voxel);
  const math::Ijk& n = surface_.bone().bricks();
  constexpr double kEdge = kSuper * kBrickEdge;
  math::Ijk low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 way = grid_from_part.conjugate() * Vec3(Vec3::Unit(axis));
    const double hi = middle[axis] + tool::support(shape, way) + reach,
                 lo = middle[axis] - tool::support(shape, -way) - reach;
    const int supers = (n[axis] + kSuper - 1) / kSuper;
    // a brick's vertices lie in [first - 1, first + 8]
    low[axis] = static_cast<int>(
        std::clamp(std::floor((lo - kBrickEdge) / kEdge), 0.0, static_cast<double>(supers)));
    high[axis] = static_cast<int>(std::clamp(std::floor((hi + 1) / kEdge), -1.0, supers - 1.0));
  }
  const PartThere at = there(part);
  const double half = 0.5 * (kEdge + 1);
  const double around = half * std::sqrt(3.0) + reach;
  for (int k = low.z(); k <= high.z(); ++k)
    for (int j = low.y(); j <= high.y(); ++j)
      for (int i = low.x(); i <= high.x(); ++i) {
        const Vec3 w = Vec3(kEdge * i - 1 + half, kEdge * j - 1 + half, kEdge * k - 1 + half) - c_;
        const Vec3 y = one.tool_from_part.q.conjugate() *
                       Vec3(r_.conjugate() * w - one.tool_from_part.p / grid_.voxel);
        if (tool::distance(shape, y).phi > around) continue;
        if (!look_into(part, at, {i, j, k}, reach)) return false;
      }
  near.reach = reach;
  near.last = {c_, r_};
  near.way = 0;
  for (int group = 0; group * NearPoints::kGroup < near.points->count; ++group)
    near.points->clear[group] = -std::numeric_limits<float>::infinity();
  return true;
}

// No point that is stored for a part is farther from c while the list holds.  [voxel]
double SixProxy::most_lever(int part) const BURR_RT {
  return far_[index(part)] + 2 * near_[index(part)].reach + 1;
}

// How far the part has gone since its points were last looked at.
void SixProxy::note_way(int part) BURR_RT {
  Near& near = near_[index(part)];
  const Quat turn = math::product(r_, near.last.q.conjugate());
  const double sine =
      std::sqrt(math::sum_of_three(turn.x() * turn.x(), turn.y() * turn.y(), turn.z() * turn.z()));
  // sine of half the angle, which is small while the list holds
  near.way += math::norm(c_ - near.last.p) + 2.1 * sine * most_lever(part);
  near.last = {c_, r_};
  near.points->way = static_cast<float>(near.way);
}

// Are all points nearer than `need` still among those found?
bool SixProxy::still_holds(int part, double need) const BURR_RT {
  const Near& near = near_[index(part)];
  if (near.reach < need || near.revision != surface_.revision()) return false;
  const Quat since = math::product(r_, near.turn.conjugate());
  const double sine = std::sqrt(
      math::sum_of_three(since.x() * since.x(), since.y() * since.y(), since.z() * since.z()));
  if (sine > 0.3) return false;
  const double turn = 2.1 * sine;  // at least the angle
  return math::norm(c_ - near.centre) + turn * (far_[index(part)] + near.reach) + need <=
         near.reach;
}

// How far beyond its reach the points lie whose planes may carry an edge of the part.  [voxel]
double SixProxy::plane_reach(int part) const BURR_RT {
  const double rounding = shape_[index(part)].rounding;
  return std::sqrt(rounding * rounding + kBeside * kBeside) - rounding;
}

// All rows that a move within these limits could meet. False: too many.
bool SixProxy::collect(const Limits& limits, bool planes) BURR_RT {
  rows_->count = 0;
  rows_->full = false;
  RowBounds bounds = {static_cast<float>(limits.move), static_cast<float>(limits.turn),
                      static_cast<float>(1 / lever_), 0};
  if (any_planes_) bounds.inverse_disc = 1 / surface_.largest_disc();
  for (int part = 0; part < tool_.count; ++part) {
    first_row_[index(part)] = rows_->count;
    if (tool_.parts[index(part)].role == tool::Role::seen) continue;
    const bool by_planes = planes && touches_planes(part);
    const double beyond = by_planes ? plane_reach(part) : 0;
    const double need =
        limits.move + beyond + limits.turn * (far_[index(part)] + limits.move + 1) + 0.01;
    if (!still_holds(part, need) && !look_around(part, need + kSkin / grid_.voxel) &&
        !look_around(part, need))
      return false;
    const Near& near = near_[index(part)];
    const Vec3 offset = c_ - near.centre;
    const float c[3] = {static_cast<float>(offset.x()), static_cast<float>(offset.y()),
                        static_cast<float>(offset.z())};
    note_way(part);
    bounds.most = static_cast<float>(limits.move + limits.turn * most_lever(part) + kRounding);
    bounds.beyond = static_cast<float>(beyond);
    PartThere at = there(part);
    at.planes = by_planes;
    kernel_.make(*near.points, c, at, bounds, *rows_);
    if (rows_->full) return false;
  }
  for (int part = tool_.count; part <= tool::Tool::kMostParts; ++part)
    first_row_[index(part)] = rows_->count;
  return true;
}

bool SixProxy::is_free(const math::Pose& pose) BURR_RT {
  const Vec3 c = c_;
  const Quat r = r_;
  place(pose);
  bool free = collect({0, 0}, false);
  for (int j = 0; j < rows_->count && free; ++j) free = rows_->gap[j] >= 0;
  for (int part = 0; part < tool_.count && free; ++part) {
    const tool::Part& one = tool_.parts[index(part)];
    if (one.role == tool::Role::seen) continue;
    const Vec3 middle = c_ + r_ * (one.tool_from_part.p / grid_.voxel);
    const math::Ijk at = (middle.array() + 0.5).floor().cast<int>();
    free = surface_.bone().field(at.x(), at.y(), at.z()) < volume::kIso;
  }
  c_ = c;
  r_ = r;
  return free;
}

// ---- moves

Six SixProxy::wanted(const Vec3& x, const Quat& q) const BURR_RT {
  const Vec3 p = x - c_;
  const Vec3 t = lever_ * math::rotation_vector(math::product(q, r_.conjugate()));
  return {p.x(), p.y(), p.z(), t.x(), t.y(), t.z()};
}

LeastTwist SixProxy::solve(const Six& wanted) BURR_RT {
  // bone that grew under the tool pushes it out slowly
  const float deepest = -static_cast<float>(settings_.push_out_speed);
  for (int j = 0; j < rows_->count; ++j) rows_->gap[j] = std::max(rows_->gap[j], deepest);
  LeastTwist twist = least_twist(*rows_, wanted, kernel_.worst);
  if (twist.solved) return twist;
  for (int j = 0; j < rows_->count; ++j) rows_->gap[j] = std::max(rows_->gap[j], 0.0F);
  return least_twist(*rows_, wanted, kernel_.worst);
}

// The best move from here. Few rows are collected first, and more only if the move is longer than
// guessed.
LeastTwist SixProxy::move(const Six& wanted, Limits& guess, bool& cut_short,
                          SixTouch& touch) BURR_RT {
  Limits most = most_;
  Limits now = {std::clamp(guess.move, kLeastMove, most.move),
                std::clamp(guess.turn, 1e-6, most.turn)};
  cut_short = false;
  for (int round = 0; round < kRounds; ++round) {
    if (!collect(now)) {
      touch.overflow = true;
      most = {0.5 * now.move, 0.5 * now.turn};
      now = most;
      continue;
    }
    LeastTwist twist = solve(wanted);
    touch.candidates = std::max(touch.candidates, rows_->count);
    const double p = length3(twist.z, 0), t = length3(twist.z, 3) / lever_;
    if (p <= now.move && t <= now.turn) {
      guess = {1.3 * p, 1.3 * t};
      return twist;
    }
    if ((p > now.move && now.move >= most.move) || (t > now.turn && now.turn >= most.turn) ||
        round + 1 == kRounds) {
      // rows hold for every shorter move in the same direction
      const double share =
          std::min(p > now.move ? now.move / p : 1.0, t > now.turn ? now.turn / t : 1.0);
      for (double& part : twist.z) part *= share;
      cut_short = true;
      guess = now;
      return twist;
    }
    if (p > now.move) now.move = std::min({1.1 * p, 3 * now.move + 0.1, most.move});
    if (t > now.turn) now.turn = std::min({1.1 * t, 3 * now.turn + 1e-3, most.turn});
  }
  LeastTwist still;
  still.solved = false;
  cut_short = true;
  return still;
}

void SixProxy::go(const Six& z) BURR_RT {
  c_ += Vec3(z[0], z[1], z[2]);
  r_ = math::turned(r_, Vec3(z[3], z[4], z[5]) / lever_);
}

// Where the point of a row is, seen from c, in the grid: a row holds the normal and w x n, so w is
// known but for its part along n. Along the normal the distance to a convex part falls by as much as
// one goes, so one look from far outside finds it; for a spoon the nearest of many looks.  [voxel]
Vec3 SixProxy::arm_of(int part, const Vec3& normal, const Vec3& across, double gap) const BURR_RT {
  const tool::Part& one = tool_.parts[index(part)];
  const Quat part_from_grid = math::product(r_, one.tool_from_part.q).conjugate();
  const Vec3 middle = r_ * Vec3(one.tool_from_part.p / grid_.voxel);
  const auto phi = [&](double along) BURR_RT {
    const Vec3 w = across + along * normal - middle;
    return tool::distance(shape_[index(part)], part_from_grid * w).phi - gap;
  };
  const double far = far_[index(part)] + 2;
  if (tool::convex(one.shape.kind)) return across + (phi(-far) - far) * normal;
  double best = 0, least = far;
  // quarters of a voxel to go for each voxel that a look is worse than the best: a distance changes by no
  // more than the way. A grid's is linear in each cell and may change up to sqrt(3) times as fast
  const double quarters = one.shape.kind == tool::ShapeKind::grid ? 2 : 3.9;
  for (double along = -far; along <= far;) {
    const double here = along, off = std::abs(phi(here));
    along += 0.25 * std::max(1.0, std::floor(quarters * (off - least)));
    if (off >= least) continue;
    least = off;
    best = here;
  }
  return across + best * normal;
}

void SixProxy::report(const LeastTwist& last, const Vec3& x, const Quat& q,
                      SixTouch& touch) const BURR_RT {
  const Quat& frame = grid_.frame.q;
  touch.world_from_tool = pose();
  touch.stretch = frame * Vec3((c_ - x) * grid_.voxel);
  touch.turn = frame * math::rotation_vector(math::product(r_, q.conjugate()));
  touch.active = last.active;
  for (int a = 0; a < last.active; ++a) {
    const int j = last.index[a];
    SixContact& contact = touch.contacts[static_cast<std::size_t>(a)];
    while (contact.part + 1 < tool_.count && first_row_[index(contact.part + 1)] <= j)
      ++contact.part;
    const Vec3 n(static_cast<double>(rows_->n[0][j]), static_cast<double>(rows_->n[1][j]),
                 static_cast<double>(rows_->n[2][j]));
    const Vec3 m(static_cast<double>(rows_->m[0][j]), static_cast<double>(rows_->m[1][j]),
                 static_cast<double>(rows_->m[2][j]));
    contact.normal = frame * n;
    // m is over L
    contact.arm = frame * Vec3(grid_.voxel * arm_of(contact.part, n, n.cross(lever_ * m),
                                                    static_cast<double>(rows_->gap[j])));
    contact.lever = frame * Vec3(m * settings_.lever);
    contact.load = last.push[a] * grid_.voxel;
  }
}

// Which places of the tool press, and how hard. False: too many.
bool SixProxy::press(const LeastTwist& last, const Six& wanted) BURR_RT {
  Six pushed = {};
  double load = 0;
  std::array<Six, 6> rows = {};
  for (int a = 0; a < last.active; ++a) {
    const int j = last.index[a];
    Six& row = rows[static_cast<std::size_t>(a)];
    for (std::size_t k = 0; k < 3; ++k) {
      row[k] = static_cast<double>(rows_->n[k][j]);
      row[k + 3] = static_cast<double>(rows_->m[k][j]);
    }
    for (std::size_t k = 0; k < 6; ++k) pushed[k] += last.push[a] * row[k];
    load += last.push[a];
  }
  rest_on(std::span<const Six>(rows).first(static_cast<std::size_t>(last.active)), *pressed_);
  if (settings_.wedge > 0) load = std::min(load, settings_.wedge * std::sqrt(dot6(wanted, wanted)));
  places_->count = 0;
  places_->full = false;
  const RowBounds bounds = {static_cast<float>(kLayer), 0, static_cast<float>(1 / lever_),
                            static_cast<float>(kLayer + kRounding)};
  for (int part = 0; part < tool_.count; ++part) {
    if (tool_.parts[index(part)].role == tool::Role::seen) continue;
    const double need = kLayer + 0.01;
    if (!still_holds(part, need) && !look_around(part, need + kSkin / grid_.voxel)) return false;
    const Near& near = near_[index(part)];
    const Vec3 offset = c_ - near.centre;
    const float c[3] = {static_cast<float>(offset.x()), static_cast<float>(offset.y()),
                        static_cast<float>(offset.z())};
    note_way(part);
    kernel_.press(*near.points, c, there(part), bounds, *places_);
    if (places_->full) return false;
  }
  share_load(*places_, kLayer, pushed, load, *pressed_);
  return true;
}

// From where it would rest to where friction holds it, as far as the bone lets it. before: the pose
// of the tick before, in the grid.
void SixProxy::rub(const LeastTwist& last, const math::Pose& before, const Vec3& x, const Quat& q,
                   SixTouch& touch) BURR_RT {
  const Grip was = grip_;
  grip_ = {};
  if (touch.active == 0 || !last.solved || !(friction_.sticks > 0)) return;
  if (!press(last, wanted(x, q))) return;
  const Vec3 c = c_;
  const Grip held = hold(*pressed_, friction_, wanted(before.p, before.q), was);
  // held whole it goes back to where it was; while it slides the springs are at their least energy, with
  // this push, as if the hand were there
  const math::Pose from = held.whole ? math::Pose{c, r_} : math::Pose{x, q};
  const math::Pose goal{from.p + Vec3(held.f[0], held.f[1], held.f[2]),
                        math::turned(from.q, Vec3(held.f[3], held.f[4], held.f[5]) / lever_)};
  Limits guess = {1.1 * length3(held.f, 0), 1.1 * length3(held.f, 3) / lever_};
  for (int moves = 0; moves < kHoldMoves; ++moves) {
    bool cut_short = false;
    const LeastTwist to = move(wanted(goal.p, goal.q), guess, cut_short, touch);
    if (!to.solved) break;
    go(to.z);
    if (!cut_short && std::sqrt(dot6(to.z, to.z)) < settings_.close / grid_.voxel) break;
  }
  grip_ = held;
  touch.stuck = held.stuck;
  const Quat& frame = grid_.frame.q;
  touch.held = frame * Vec3((c_ - c) * grid_.voxel);
  touch.world_from_tool = pose();
  const Vec3 without = touch.turn;
  touch.turn = frame * math::rotation_vector(math::product(r_, q.conjugate()));
  touch.held_turn = touch.turn - without;
  touch.stretch = frame * Vec3((c_ - x) * grid_.voxel);
  // the contacts are those of the rest without friction, seen from where the tool is now
  for (int a = 0; a < touch.active; ++a)
    touch.contacts[static_cast<std::size_t>(a)].arm -= touch.held;
}

SixTouch SixProxy::step(const math::Pose& hand) BURR_RT {
  const math::Pose before{c_, r_};
  const Vec3 x = grid_.grid_from_world(hand.p);
  const Quat q = math::normalized(math::product(grid_.frame.q.conjugate(), hand.q));
  SixTouch touch;
  LeastTwist last;
  Limits guess = last_;
  bool cut_short = true;
  double left = 1;
  Settling settling;
  const double close = settings_.close / grid_.voxel;
  for (touch.moves = 0; touch.moves < settings_.max_moves;) {
    last = move(wanted(x, q), guess, cut_short, touch);
    if (touch.moves++ == 0) last_ = guess;
    if (!last.solved) break;
    left = std::sqrt(dot6(last.z, last.z));
    Six z = last.z;
    if (any_planes_ && !(friction_.sticks > 0) && left >= close)
      for (const double share = settling.share(last.z, cut_short); double& part : z) part *= share;
    go(z);
    if (!cut_short && (left < close || last.active == 0)) break;
  }
  touch.lagging = !last.solved || cut_short || (last.active > 0 && left > kRest);
  report(last, x, q, touch);
  rub(last, before, x, q, touch);
  return touch;
}

}  // namespace burr::haptics
