#include "burr/surgeon/fill_work.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/surgeon/step_work.h"
#include "burr/volume/sample.h"

namespace burr::surgeon {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kReread = 15e-3;  // around the hand [m]
constexpr double kClear = 0.3e-3;  // above the surface before a stroke [m]
constexpr double kAbove = 3e-3;    // of the next start, for the way [m]
constexpr double kSpread = 0.5;    // of the burr's radius: so far beside it material is added [-]
constexpr double kPiece = 0.5e-3;  // in which a stroke is looked at [m]
constexpr std::uint32_t kBan = 6;  // calls in which a node is left out after a try
constexpr std::uint32_t kMostWaits = 5;  // so often this time doubles
constexpr std::uint32_t kPatience = 40;  // calls without progress until a smaller burr is taken
constexpr double kSmaller = 0.7;         // the next burr
constexpr std::uint32_t kForever = std::numeric_limits<std::uint32_t>::max();  // for this burr
constexpr int kLooks = 40;        // places that are looked at in a call
constexpr double kHigh = 2e-3;    // above the place, where the burr cannot touch yet [m]
constexpr double kDown = 0.1e-3;  // in such steps it comes down [m]
constexpr int kFacing = 40;       // points of the burr's lower half
constexpr double kGolden = 2.399963229728653;  // [rad]
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool is_empty(const volume::Bone& bone, const Ijk& at) {
  return bone.field(at.x(), at.y(), at.z()) < volume::kIso;
}

}  // namespace

Filling filling_of(const scenario::CaseRegion& region, const Believed& believed, const Spare& spare,
                   const Vec3& out) {
  Filling filling;
  filling.gap = spare.outside;
  FieldGrid& gap = filling.gap;
  const Believed::Depth depth = believed.region(region);
  for (std::size_t n = 0; n < gap.nodes(); ++n)
    gap.value[n] = std::min(gap.value[n], static_cast<float>(std::max(-1.0, depth(gap.node(n)))));
  filling.rise = behind(gap, out);
  for (std::size_t n = 0; n < gap.nodes(); ++n)
    filling.rise.value[n] = std::min(filling.rise.value[n], spare.outside.value[n]);
  return filling;
}

FillWork::FillWork(const volume::Bone& bone, const scenario::Step& step, const Filling& plan,
                   const Vec3& out, const Skill& skill, double case_diameter)
    : plan_(plan), skill_(skill), out_(out) {
  double diameter = case_diameter * skill.burrs.middle;
  if (step.diameter && skill.burrs.heeds_step)
    diameter = std::clamp(diameter, step.diameter->first, step.diameter->second);
  const double least = std::max(tool::kSmallestDiameter, 4 * bone.grid().voxel);
  diameter = std::clamp(diameter, least, tool::kLargestDiameter);
  burr_.radius = 0.5 * diameter;
  // what a burr cannot reach, a smaller one of the step can
  smallest_ = 0.5 * std::max(least, step.diameter ? step.diameter->first : diameter);
  for (std::size_t n = 0; n < plan.gap.nodes(); ++n) {
    if (static_cast<double>(plan.gap.value[n]) < kSkin) continue;
    Node node{plan.gap.node(n), {}, 0, 0};
    node.voxel = (bone.grid().grid_from_world(node.at).array() + 0.5).floor().cast<int>();
    if (is_empty(bone, node.voxel)) nodes_.push_back(node);
  }
  all_ = left_then_ = nodes_.size();
}

double FillWork::left() const {
  return all_ > 0 ? static_cast<double>(nodes_.size()) / static_cast<double>(all_) : 0;
}

void FillWork::look(const volume::Bone& bone, const Vec3& hand) {
  nodes_.erase(std::remove_if(nodes_.begin(), nodes_.end(),
                              [&](const Node& node) {
                                return (node.at - hand).norm() < kReread &&
                                       !is_empty(bone, node.voxel);
                              }),
               nodes_.end());
}

// Is there bone just below, seen from the surgeon?
bool FillWork::on_surface(const volume::Bone& bone, const Node& node) const {
  return volume::depth_at(bone, node.at - plan_.gap.spacing() * out_) > 0;
}

NextStroke FillWork::stroke_at(const volume::Bone& bone, const Node& node,
                               people::RandomStream& random) const {
  NextStroke next;
  next.at = node.at;
  next.burr = burr_;
  next.out = out_;
  Stroke& stroke = next.stroke;
  const double angle = 2 * M_PI * random.uniform();
  const Vec3 u = out_.unitOrthogonal(), v = out_.cross(u);
  stroke.along = std::cos(angle) * u + std::sin(angle) * v;
  stroke.out = out_;
  stroke.into = -out_;
  stroke.shaft = out_;
  // on the line from the place onwards, as far as the gap is still empty there: a stroke that begins
  // on ground that is full already never comes down to the place. Material spreads to the sides.
  const double wide = kSpread * burr_.radius;
  const auto fits = [&](double s) {
    return plan_.rise.at(node.at + (s + std::copysign(wide, s)) * stroke.along) > 0 &&
           volume::depth_at(bone, node.at + s * stroke.along) <= 0;
  };
  const double length = skill_.stroke * std::exp(0.3 * random.normal());
  double ahead = 0, behind = 0;
  while (ahead < length && fits(ahead + kPiece)) ahead += kPiece;
  while (behind < length && fits(-behind - kPiece)) behind += kPiece;
  if (behind > ahead) stroke.along = -stroke.along;
  stroke.length = std::max({kPiece, ahead, behind});
  // down to the place from where the burr is free of the surface
  stroke.start = node.at + burr_.radius * out_;
  while (volume::depth_at(bone, stroke.start - burr_.radius * out_) > 0)
    stroke.start += kClear * out_;
  stroke.start += kClear * out_;
  return next;
}

// The burr comes down along the way in: is what it meets first still below the border?
bool FillWork::reaches(const volume::Bone& bone, const Node& node) const {
  const Vec3 u = out_.unitOrthogonal(), v = out_.cross(u);
  Vec3 centre = node.at + (burr_.radius + kHigh) * out_;
  for (double s = 0; s < burr_.radius + 2 * kHigh; s += kDown, centre -= kDown * out_)
    for (int n = 0; n < kFacing; ++n) {
      const double down = (n + 0.5) / kFacing, side = std::sqrt(1 - down * down),
                   turn = kGolden * n;
      const Vec3 to = side * (std::cos(turn) * u + std::sin(turn) * v) - down * out_;
      const Vec3 at = centre + burr_.radius * to;
      if (volume::depth_at(bone, at) > 0)
        return plan_.rise.at(at) > SurgeonHand::ring(burr_.radius, down);
    }
  return true;
}

// The surface node at which the next stroke begins; kNone if none is free now.
std::size_t FillWork::best(const volume::Bone& bone, const Vec3& hand, double luck) {
  for (int tries = 0; tries < kLooks; ++tries) {
    std::size_t found = kNone;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Node& node = nodes_[n];
      if (node.banned > calls_ || !on_surface(bone, node)) continue;
      double worth = -1e3 * node.at.dot(out_) - 0.1e3 * (node.at - hand).norm();
      const double beside =
          kSpread * burr_.radius - plan_.rise.at(node.at);  // too near to the border
      worth -= 0.5e3 * std::max(0.0, beside);
      worth += 0.5 * std::fmod(luck + 0.6180339887498949 * static_cast<double>(n), 1.0);
      if (worth <= most) continue;
      most = worth;
      found = n;
    }
    if (found == kNone || reaches(bone, nodes_[found])) return found;
    nodes_[found].banned = kForever;
  }
  return kNone;
}

// False: this is the smallest one already.
bool FillWork::take_smaller() {
  if (burr_.radius <= smallest_) return false;
  burr_.radius = std::max(smallest_, kSmaller * burr_.radius);
  calls_then_ = calls_;
  for (Node& node : nodes_) node.banned = node.tries = 0;
  return true;
}

std::optional<NextStroke> FillWork::next(const volume::Bone& bone, const Vec3& hand,
                                         const HeldBurr& held, people::RandomStream& random) {
  ++calls_;
  if (nodes_.size() < left_then_) {
    left_then_ = nodes_.size();
    calls_then_ = calls_;
  }
  const std::size_t found = best(bone, hand, random.uniform());
  const bool none =
      found == kNone && std::none_of(nodes_.begin(), nodes_.end(), [&](const Node& n) {
        return n.banned != kForever && on_surface(bone, n);
      });
  if (none || calls_ - calls_then_ > kPatience) {
    exhausted_ = !take_smaller();
    return std::nullopt;
  }
  if (found == kNone) return std::nullopt;
  Node& tried = nodes_[found];
  tried.banned = calls_ + (kBan << std::min(tried.tries, kMostWaits));
  ++tried.tries;
  NextStroke next = stroke_at(bone, tried, random);
  if (!(next.burr == held)) return next;
  Stroke& stroke = next.stroke;
  const double rise = std::max(kAbove, kAbove + (stroke.start - hand).dot(out_));
  stroke.idle_way = true;
  stroke.way[0] = hand + rise * out_;
  stroke.way[1] = stroke.start + kAbove * out_;
  stroke.points = 2;
  return next;
}

}  // namespace burr::surgeon
