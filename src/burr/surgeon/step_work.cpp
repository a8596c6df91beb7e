#include "burr/surgeon/step_work.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/volume/sample.h"

namespace burr::surgeon {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kCell = 2e-3;                           // over which the goal is averaged [m]
constexpr double kMost = 3e-3;                           // a goal above it counts as this [m]
constexpr double kFarTool = 6e-3, kMiddleTool = 3.5e-3;  // borders of BurrPolicy [m]
constexpr double kSmaller = 0.8;                         // the next burr if one does not fit
constexpr double kLeastOfStep = 0.4;  // a smaller share of the step's smallest burr is not taken
constexpr double kWorth = 0.1;        // a burr that reaches less of the plan is too wide [-]
constexpr double kTight = 0.02e-3;    // a burr fits if this much more goal would do [m]
constexpr double kInside = 0.1e-3;    // of the burr: bone there is cut [m]
// A stroke goes on where the plan is too narrow by less than this, and the hand lifts there: the
// plan is known on a grid and curves, and a stroke is straight [m].
constexpr double kSlack = 0.1e-3;
constexpr double kOutSlack =
    0.2e-3;                        // the same on the way out, which is known on the grid only [m]
constexpr double kClear = 0.3e-3;  // above the bone before a stroke [m]
constexpr double kAway = 60e-3;    // a way out is looked at this far [m]
constexpr int kDirections = 4;     // of a stroke that are tried
constexpr double kShort = 2e-3;    // a shorter stroke is worth another try [m]
constexpr double kHop = 5e-3;      // shorter ways are made close over the bone [m]
constexpr double kAbove = 5e-3;    // of the plan, for longer ways [m]
constexpr double kReread = 15e-3;  // around the hand [m]
constexpr double kTube = 8e-3;     // strokes follow a curve that lies this near [m]
constexpr double kSameTool = 3;    // bonus [mm]
constexpr double kLean = 1.5;      // of the shaft: a burr cuts with its side, not its pole [-]
constexpr std::uint32_t kBan = 8;  // calls in which a node is left out after a try
constexpr int kTries = 40;
constexpr std::uint32_t kPatience = 15;  // calls without progress before a smaller burr is taken
constexpr std::uint32_t kMostWaits = 5;  // a ban doubles with every try, so many times
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool is_bone(const volume::Bone& bone, const Ijk& at) {
  return bone.field(at.x(), at.y(), at.z()) >= volume::kIso;
}

bool in_air(const volume::Bone& bone, const Vec3& p) { return volume::depth_at(bone, p) <= 0; }

}  // namespace

StepWork::StepWork(const volume::Bone& bone, const scenario::Step& step,
                   const scenario::CaseLesson& lesson, const FieldGrid& goal,
                   const FieldGrid& allowed, const Spare& spare, const Skill& skill,
                   double case_diameter)
    : step_(step),
      lesson_(lesson),
      allowed_(allowed),
      spare_(spare),
      skill_(skill),
      case_diameter_(case_diameter),
      voxel_(bone.grid().voxel),
      smallest_(skill.burrs.smallest),
      approach_(approach_of(lesson, step)) {
  top_ = -std::numeric_limits<double>::infinity();
  take_nodes(bone, goal);
  all_ = left_ = left_then_ = nodes_.size();
}

void StepWork::take_nodes(const volume::Bone& bone, const FieldGrid& goal) {
  const int in_cell = std::max(1, static_cast<int>(std::lround(kCell / goal.spacing())));
  const Ijk cells = goal.size() / in_cell + Ijk::Ones();
  const auto x = static_cast<std::size_t>(goal.size().x());
  const auto y = static_cast<std::size_t>(goal.size().y());
  const std::size_t count = static_cast<std::size_t>(cells.x()) *
                            static_cast<std::size_t>(cells.y()) *
                            static_cast<std::size_t>(cells.z());
  sum_.assign(count, 0);
  many_.assign(count, 0);
  for (;;) {
    fit_ = 0;
    const double smallest = burr_for(0).radius;
    fit_ = 1;
    nodes_.clear();
    std::size_t wanted = 0;
    for (std::size_t n = 0; n < goal.nodes(); ++n) {
      if (static_cast<double>(goal.value[n]) < kSkin) continue;
      const Vec3 p = goal.node(n);
      Node node{};
      node.at = p.cast<float>();
      node.voxel = (bone.grid().grid_from_world(p).array() + 0.5).floor().cast<int>();
      if (!is_bone(bone, node.voxel)) continue;
      ++wanted;
      if (std::none_of(approach_.begin(), approach_.end(),
                       [&](const Vec3& out) { return place_for(p, out, smallest).has_value(); }))
        continue;
      const Ijk ijk(static_cast<int>(n % x), static_cast<int>(n / x % y),
                    static_cast<int>(n / (x * y)));
      const Ijk cell = ijk / in_cell;
      node.cell =
          static_cast<std::uint32_t>(cell.x() + cells.x() * (cell.y() + cells.y() * cell.z()));
      node.goal = allowed_.value[n];
      node.near = spare_.near.value[n];
      look(bone, node);
      top_ = std::max(top_, p.dot(approach_.front()));
      nodes_.push_back(node);
    }
    const double before = smallest_;
    smallest_ *= kSmaller;
    fit_ = 0;
    const bool least = burr_for(0).radius >= smallest;
    fit_ = 1;
    if (least || static_cast<double>(nodes_.size()) >= kWorth * static_cast<double>(wanted)) {
      smallest_ = before;
      return;
    }
  }
}

double StepWork::left() const {
  return all_ > 0 ? static_cast<double>(left_) / static_cast<double>(all_) : 0;
}

void StepWork::look(const volume::Bone& bone, Node& node) const {
  node.there = is_bone(bone, node.voxel);
  node.surface = false;
  if (!node.there) return;
  const int step = std::max(1, static_cast<int>(std::lround(allowed_.spacing() / voxel_)));
  for (int side = 0; side < 6 && !node.surface; ++side) {
    Ijk beside = node.voxel;
    beside[side / 2] += side % 2 == 0 ? step : -step;
    node.surface = !is_bone(bone, beside);
  }
}

void StepWork::look(const volume::Bone& bone, const Vec3& hand) {
  const math::Vec3f middle = hand.cast<float>();
  constexpr auto kSquare = static_cast<float>(kReread * kReread);
  for (Node& node : nodes_)
    if ((node.at - middle).squaredNorm() < kSquare) look(bone, node);
  nodes_.erase(
      std::remove_if(nodes_.begin(), nodes_.end(), [](const Node& node) { return !node.there; }),
      nodes_.end());
  left_ = nodes_.size();
}

// The burr for bone at this distance from what is spared.
HeldBurr StepWork::burr_for(double near) const {
  const BurrPolicy& policy = skill_.burrs;
  HeldBurr burr;
  const double share = near > kFarTool      ? policy.far
                       : near > kMiddleTool ? policy.middle
                                            : policy.near;
  double diameter = case_diameter_ * share;
  double smallest = case_diameter_ * smallest_;
  if (near < policy.diamond_below) {
    burr.kind = tool::BurrKind::diamond;
    diameter = case_diameter_ * policy.middle;
  }
  if (policy.heeds_step && step_.diameter) {
    // smaller than the step says only where that does not fit
    diameter = std::clamp(diameter, step_.diameter->first, step_.diameter->second);
    smallest = std::clamp(smallest, kLeastOfStep * step_.diameter->first, step_.diameter->first);
  }
  diameter = std::max(diameter * fit_, std::min(smallest, diameter));
  diameter =
      std::clamp(diameter, std::max(tool::kSmallestDiameter, 4 * voxel_), tool::kLargestDiameter);
  burr.radius = 0.5 * std::round(diameter * 1e4) * 1e-4;
  if (burr.radius < 2 * voxel_) burr.radius = 2 * voxel_;
  return burr;
}

// Where the burr's centre is when it touches q and stays in the goal.
std::optional<Vec3> StepWork::place_for(const Vec3& q, const Vec3& out, double radius) const {
  Vec3 centre = q + (radius - kSkin) * out;
  for (int n = 0; n < 5; ++n) {
    const double short_of = radius - allowed_.at(centre);
    if (short_of <= kTight) break;
    const Vec3 up = allowed_.slope(centre);
    const double steep = up.norm();
    if (steep < 0.2) return std::nullopt;
    centre += up * (short_of / steep);
  }
  if (allowed_.at(centre) < radius - kTight) return std::nullopt;
  if ((centre - q).norm() > radius - kInside) return std::nullopt;
  return centre;
}

Vec3 StepWork::direction(const Vec3& q, const Vec3& into, people::RandomStream& random) const {
  const double angle = 2 * M_PI * random.uniform();
  const bool follows = random.uniform() < skill_.along;
  const Vec3 u = into.unitOrthogonal(), v = into.cross(u);
  Vec3 along = std::cos(angle) * u + std::sin(angle) * v;
  if (!follows) return along;
  double nearest = kTube;
  const auto follow = [&](const Vec3& from, const Vec3& to) {
    const Vec3 piece = to - from;
    const double t = std::clamp((q - from).dot(piece) / piece.squaredNorm(), 0.0, 1.0);
    const double far = (q - from - t * piece).norm();
    const Vec3 across = piece.normalized() - piece.normalized().dot(into) * into;
    if (far >= nearest || across.norm() < 0.5) return;
    nearest = far;
    along = across.normalized();
  };
  for (const scenario::Landmark& one : lesson_.landmarks)
    for (std::size_t n = 1; n < one.points.size(); ++n) follow(one.points[n - 1], one.points[n]);
  // a groove that is given by two points is followed like a curve
  if (const scenario::CaseRegion* region = lesson_.region(step_.region))
    for (const scenario::Shape& one : region->add)
      if (one.kind == scenario::ShapeKind::capsule) follow(one.a.at, one.b.at);
  return along;
}

// True if a burr that leaves p along `out` meets nothing that must stay whole. The plan holds every place
// that one of the directions to the surgeon reaches, so a direction is checked anew at each place.
bool StepWork::is_way_out(const Vec3& p, const Vec3& out, double radius) const {
  for (double s = 0; s < kAway; s += 0.5e-3)
    if (spare_.free.at(p + s * out) < radius - kOutSlack) return false;
  return true;
}

// Where a burr of this radius, raised from p along `up`, is clear of the bone on its side `from`.
Vec3 StepWork::above_bone(const volume::Bone& bone, const Vec3& p, const Vec3& from, const Vec3& up,
                          double radius) const {
  Vec3 start = p;
  double lifted = 0;
  while (lifted < radius + 2e-3 && !in_air(bone, start - (radius - voxel_) * from)) {
    start += 0.5 * voxel_ * up;
    lifted += 0.5 * voxel_;
  }
  return start + kClear * up;
}

void StepWork::set_way(const volume::Bone& bone, const Vec3& hand, NextStroke& next) const {
  Stroke& stroke = next.stroke;
  const Vec3 way = stroke.start - hand;
  const double far = way.norm();
  bool near = far < kHop;
  const Vec3 up = 1e-3 * next.out;
  for (double s = 0; near && s < far; s += 0.5e-3) {
    const Vec3 p = hand + up + way * (s / far);
    // soft tissue is no bone: only this keeps a turning burr out of it
    near = in_air(bone, p) && spare_.free.at(p) >= next.burr.radius - kSlack;
  }
  const auto above = [&](const Vec3& p, const Vec3& out) {
    const Vec3& first = approach_.front();  // top_ is the height along it
    // a direction across the first one never rises above the bone: there the burr goes as far as kAway
    const double rise = out.dot(first);
    const double high = rise > 0 ? std::min((top_ + kAbove - p.dot(first)) / rise, kAway) : kAway;
    return Vec3(p + out * std::max(2e-3, high));
  };
  // the place that is left may have another way out than the next one
  const auto leave = std::find_if(approach_.begin(), approach_.end(), [&](const Vec3& out) {
    return is_way_out(hand, out, next.burr.radius);
  });
  stroke.idle_way = !near;
  stroke.way[0] =
      near ? Vec3(hand + up) : above(hand, leave != approach_.end() ? *leave : next.out);
  if (!near) stroke.way[1] = above(stroke.start, next.out);
  stroke.points = near ? 2 : 3;
  stroke.way[static_cast<std::size_t>(stroke.points - 1)] = stroke.start + up;
}

std::optional<NextStroke> StepWork::stroke_at(const volume::Bone& bone, const Node& node,
                                              const Vec3& hand, const HeldBurr& held,
                                              people::RandomStream& random) const {
  const Vec3 q = node.at.cast<double>();
  NextStroke next;
  next.at = q;
  next.burr = burr_for(static_cast<double>(node.near));
  const double radius = next.burr.radius;
  Vec3 normal = volume::normal(bone, bone.grid().grid_from_world(q));
  if (normal.norm() < 0.5) normal = approach_.front();
  for (const Vec3& out : approach_) {
    // bone that faces away is met from the side
    Vec3 from = normal;
    if (from.dot(out) < 0.3) from = (from - from.dot(out) * out + 0.3 * out).normalized();
    auto deepest = place_for(q, from, radius);
    if (!deepest) {  // in a corner
      deepest = place_for(q, out, radius);
      if (!deepest) continue;
      from = (*deepest - q).normalized();
    }
    // the burr is let down along the normal, or in a narrow place along the way out
    Vec3 start;
    bool clear = false;
    for (const Vec3& up : {from, out}) {
      start = above_bone(bone, *deepest, from, up, radius);
      clear = is_way_out(start, out, radius);
      for (double s = 0; clear && s < kAway; s += 1e-3) clear = in_air(bone, start + s * out);
      if (clear) break;
    }
    if (!clear) continue;
    Stroke& stroke = next.stroke;
    next.out = out;
    stroke.into = -from;
    stroke.out = out;
    const double length = skill_.stroke * std::exp(0.3 * random.normal());
    constexpr double kPiece = 0.5e-3;
    const auto fits = [&](const Vec3& way, double s) {
      return allowed_.at(*deepest + s * way) >= radius - kSlack;
    };
    double ahead = 0, behind = 0;
    // another direction is taken where the burr has no room for a stroke
    for (int n = 0; n < kDirections && ahead + behind < std::min(kShort, length); ++n) {
      const Vec3 way = direction(q, stroke.into, random);
      double onwards = 0, back = 0;
      while (onwards < length && fits(way, onwards + kPiece)) onwards += kPiece;
      while (back < 0.5 * length && fits(way, -back - kPiece) &&
             in_air(bone, start - (back + kPiece) * way))
        back += kPiece;
      if (n > 0 && onwards + back <= ahead + behind) continue;
      stroke.along = way;
      ahead = onwards;
      behind = back;
    }
    stroke.start = start - behind * stroke.along;
    stroke.length = std::max(kPiece, std::min(length, ahead + behind));
    stroke.shaft = (out + kLean * std::abs(out.dot(from)) * stroke.along).normalized();
    if (next.burr == held) set_way(bone, hand, next);
    return next;
  }
  return std::nullopt;
}

void StepWork::smooth() {
  for (const Node& node : nodes_) {
    sum_[node.cell] = 0;
    many_[node.cell] = 0;
  }
  for (const Node& node : nodes_) {
    if (!node.surface) continue;
    sum_[node.cell] += std::min(node.goal, static_cast<float>(kMost));
    ++many_[node.cell];
  }
}

std::size_t StepWork::best(const Vec3& hand, const HeldBurr& held, people::RandomStream& random) {
  const Vec3& out = approach_.front();
  std::size_t found = kNone;
  double most = -std::numeric_limits<double>::infinity();
  const double luck = random.uniform();
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    if (!node.surface || node.banned > calls_) continue;
    const Vec3 q = node.at.cast<double>();
    double worth = 1e3 * static_cast<double>(sum_[node.cell]) / std::max(1U, many_[node.cell]);
    worth += 0.5e3 * skill_.saucer * (q.dot(out) - top_) - 0.3e3 * (q - hand).norm();
    if (burr_for(static_cast<double>(node.near)) == held) worth += kSameTool;
    worth += 0.3 * std::fmod(luck + 0.6180339887498949 * static_cast<double>(n), 1.0);
    if (worth <= most) continue;
    most = worth;
    found = n;
  }
  return found;
}

std::optional<NextStroke> StepWork::next(const volume::Bone& bone, const Vec3& hand,
                                         const HeldBurr& held, people::RandomStream& random) {
  ++calls_;
  if (left_then_ - left_ > std::max<std::size_t>(2, all_ / 2000)) {
    left_then_ = left_;
    calls_then_ = calls_;
  }
  bool smaller = calls_ - calls_then_ > kPatience;
  smooth();
  for (;;) {
    for (int n = 0; !smaller && n < kTries; ++n) {
      const std::size_t found = best(hand, held, random);
      if (found == kNone) break;
      Node& tried = nodes_[found];
      tried.banned = calls_ + (kBan << std::min(tried.tries, kMostWaits));
      ++tried.tries;
      auto next = stroke_at(bone, nodes_[found], hand, held, random);
      if (next) return next;
      tried.banned = calls_ + 10 * kBan;
      if (n + 1 == kTries) return std::nullopt;  // others are tried in the next call
    }
    // no place for this burr: the next smaller one, until there is none
    const HeldBurr before = burr_for(0);
    fit_ *= kSmaller;
    smaller = false;
    calls_then_ = calls_;
    left_then_ = left_;
    if (burr_for(0) == before && fit_ < 0.1) {
      exhausted_ = true;
      return std::nullopt;
    }
    for (Node& node : nodes_) node.banned = node.tries = 0;
  }
}

}  // namespace burr::surgeon
