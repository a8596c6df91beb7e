#include "burr/haptics/baselines/triangles.h"

#include <algorithm>
#include <cmath>

#include "burr/math/sums.h"

namespace burr::haptics {
namespace {

using math::Vec3;
using math::Vec3f;

constexpr int kMoves = 4;        // per tick
constexpr double kClose = 0.02;  // a shorter move ends the search  [voxel]

// The nearest point on a triangle: C. Ericson, Real-Time Collision Detection, 2005, 5.1.5, by the
// region of the corner, edge or face that p projects to.
Vec3f nearest_on(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a;
  const float d1 = math::dot(ab, ap), d2 = math::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const Vec3f bp = p - b;
  const float d3 = math::dot(ab, bp), d4 = math::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const float vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const Vec3f cp = p - c;
  const float d5 = math::dot(ab, cp), d6 = math::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const float vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const float va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  const float whole = va + vb + vc;
  return a + vb / whole * ab + vc / whole * ac;
}

}  // namespace

TriangleProxy::TriangleProxy(double voxel, const ProxySettings& settings, const Vec3& hand)
    : voxel_(voxel),
      radius_(settings.radius),
      most_violated_(scan_kernel().most_violated),
      candidates_(std::make_unique<Candidates>()),
      c_(hand) {
  triangles_.reserve(kMost);
}

bool TriangleProxy::set_radius(double radius) BURR_RT {
  radius_ = radius;
  return true;
}

bool TriangleProxy::add(const Triangle& triangle) BURR_RT {
  if (triangles_.size() == kMost) return false;
  const Vec3f across = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
  const float twice = math::norm(across);
  if (!(twice > 0)) return true;  // degenerate to a line: its neighbours hold the burr
  const Vec3f middle = (triangle.a + triangle.b + triangle.c) / 3;
  const float reach = std::sqrt(
      std::max({math::squared_norm(triangle.a - middle), math::squared_norm(triangle.b - middle),
                math::squared_norm(triangle.c - middle)}));
  triangles_.push_back({triangle.a, triangle.b, triangle.c, across / twice, middle, reach});
  return true;
}

// Collects the triangles that a move of `within` could bring the ball to, as planes. [voxel]
void TriangleProxy::collect(double within) BURR_RT {
  Candidates& all = *candidates_;
  all.count = 0;
  all.full = false;
  const Vec3f p = c_.cast<float>();
  const auto near = static_cast<float>(radius_ + within), r = static_cast<float>(radius_),
             h = static_cast<float>(voxel_);
  for (const Known& one : triangles_) {
    const float far = near + one.reach;
    if (math::squared_norm(p - one.middle) > far * far) continue;
    if (math::dot(one.normal, p - one.a) <= 0) continue;  // seen from behind: not rendered
    const Vec3f away = p - nearest_on(p, one.a, one.b, one.c);
    const float distance = math::norm(away);
    if (distance > near || distance <= 0) continue;
    if (all.count == Candidates::kMost) {
      all.full = true;
      return;
    }
    const auto n = static_cast<std::size_t>(all.count++);
    all.nx[n] = away.x() / distance;
    all.ny[n] = away.y() / distance;
    all.nz[n] = away.z() / distance;
    all.gap[n] = (distance - r) / h;
  }
}

Touch TriangleProxy::step(const Vec3& hand) BURR_RT {
  Touch touch;
  bool pressed = false;
  for (int n = 0; n < kMoves; ++n) {
    Vec3 move = hand - c_;
    const double far = math::norm(move), longest = 0.5 * radius_;
    if (far > longest) move *= longest / far;
    collect(std::min(far, longest) + voxel_);
    const LeastMove least = least_move(*candidates_, move / voxel_, most_violated_);
    c_ += voxel_ * least.p;
    pressed = least.active > 0 || !least.solved;
    touch.active = least.active;
    touch.candidates = std::max(touch.candidates, candidates_->count);
    touch.overflow |= candidates_->full;
    touch.lagging = math::norm(least.p) >= kClose;
    if (!touch.lagging) break;
  }
  touch.proxy = c_;
  const Vec3 stretch = c_ - hand;
  const double depth = math::norm(stretch);
  touch.touching = pressed && depth > 1e-12;
  if (!touch.touching) return touch;
  touch.normal = stretch / depth;
  touch.depth = touch.pressing = depth;
  return touch;
}

}  // namespace burr::haptics
