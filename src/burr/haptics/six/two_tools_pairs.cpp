// haptics/six/two_tools_pairs.cpp - the pairs of parts of two tools that may meet, as rows of their programme.
#include <algorithm>
#include <cmath>
#include <limits>

#include "burr/haptics/six/held_rows.h"
#include "burr/haptics/six/lattice_gap.h"
#include "burr/haptics/six/two_tools.h"
#include "burr/math/sums.h"
#include "burr/math/turn.h"

namespace burr::haptics {
namespace {

using math::Quat;
using math::Vec3;
using twelve::kExact;
using twelve::kTolerance;

constexpr double kMargin = 0.2e-3;  // tools this near are solved together                  [m]

PartPlace place_of(const tool::Part& part, const tool::Shape& shape, const Vec3& c, const Quat& r,
                   double voxel) BURR_RT {
  return {shape, c + r * Vec3(part.tool_from_part.p / voxel),
          math::product(r, part.tool_from_part.q)};
}

}  // namespace

// use(place of a part of a, place of a part of b), for every pair of parts that touch
template <class Use>
void TwoTools::each_pair(const SixProxy& a, const SixProxy& b, const Use& use) BURR_RT {
  for (int i = 0; i < a.tool_.count; ++i)
    for (int j = 0; j < b.tool_.count; ++j) {
      const tool::Part &one = a.tool_.parts[SixProxy::index(i)],
                       &other = b.tool_.parts[SixProxy::index(j)];
      if (one.role == tool::Role::seen || other.role == tool::Role::seen) continue;
      const double voxel = a.grid_.voxel;
      use(place_of(one, a.shape_[SixProxy::index(i)], a.c_, a.r_, voxel),
          place_of(other, b.shape_[SixProxy::index(j)], b.c_, b.r_, voxel));
    }
}

double TwoTools::least_gap(const SixProxy& a, const SixProxy& b, double below) const BURR_RT {
  double least = std::numeric_limits<double>::infinity();
  each_pair(a, b, [&least, below](const PartPlace& one, const PartPlace& other) BURR_RT {
    least =
        std::min(least, has_lattice(one, other) ? lattice_gap(one, other, std::min(below, least))
                                                : part_gap(one, other).gap);
  });
  return least;
}

void TwoTools::add_pair(const PartGap& gap, const SixProxy& a, const SixProxy& b,
                        double tolerance) BURR_RT {
  if (count_ == kMostPairs) return;
  Pair& pair = pairs_[static_cast<std::size_t>(count_++)];
  const Vec3& n = gap.normal;
  const Vec3 of_a = Vec3(gap.a - a.c_).cross(n) / a.lever_,
             of_b = Vec3(gap.b - b.c_).cross(n) / b.lever_;
  pair.a = {n.x(), n.y(), n.z(), of_a.x(), of_a.y(), of_a.z()};
  pair.b = {-n.x(), -n.y(), -n.z(), -of_b.x(), -of_b.y(), -of_b.z()};
  pair.normal = n;
  pair.gap = gap.gap;
  pair.tolerance = tolerance;
}

bool TwoTools::find_pairs(const SixProxy& a, const SixProxy& b, const SixProxy::Limits& limits_a,
                          const SixProxy::Limits& limits_b) BURR_RT {
  count_ = 0;
  bool all = true;
  const auto reach = [](const SixProxy& one, const SixProxy::Limits& limits) BURR_RT {
    double farthest = 0;
    for (int part = 0; part < one.tool_.count; ++part)
      farthest = std::max(farthest, one.far_[SixProxy::index(part)]);
    return limits.move + limits.turn * (farthest + limits.move + 1) + 0.01;
  };
  const double within = reach(a, limits_a) + reach(b, limits_b);
  each_pair(
      a, b, [this, &a, &b, &all, within](const PartPlace& one, const PartPlace& other) BURR_RT {
        if (has_lattice(one, other)) {
          const int found = lattice_gaps(one, other, within, points_);
          all = all && found <= static_cast<int>(points_.size()) && count_ + found <= kMostPairs;
          for (int n = 0; n < found && all; ++n)
            add_pair(points_[static_cast<std::size_t>(n)], a, b, kTolerance);
          return;
        }
        add_pair(part_gap(one, other), a, b, kExact);
        PartGap ends[4];
        const int more = gaps_at_ends(one, other, ends);
        for (int n = 0; n < more; ++n) add_pair(ends[n], a, b, kExact);
      });
  return all;
}

bool TwoTools::near(const HeldTool& a, const HeldTool& b) BURR_RT {
  // no move of this tick goes farther than what is wanted
  const auto may_go = [](const HeldTool& one) BURR_RT {
    const SixProxy& proxy = one.proxy;
    const Six zd =
        proxy.wanted(proxy.grid_.grid_from_world(one.hand.p),
                     math::normalized(math::product(proxy.grid_.frame.q.conjugate(), one.hand.q)));
    double farthest = 0;
    for (int part = 0; part < proxy.tool_.count; ++part)
      if (proxy.tool_.parts[SixProxy::index(part)].role != tool::Role::seen)
        farthest = std::max(farthest, proxy.far_[SixProxy::index(part)]);
    return std::sqrt(dot6(zd, zd)) * (1 + farthest / proxy.lever_);
  };
  const double may_meet = kMargin / a.proxy.grid_.voxel + may_go(a) + may_go(b);
  const double gap = least_gap(a.proxy, b.proxy, may_meet);
  apart_ = apart_ || gap >= 0;
  const bool near = apart_ && gap < may_meet;
  if (!near) rests_a_ = rests_b_ = {};
  return near;
}

}  // namespace burr::haptics
