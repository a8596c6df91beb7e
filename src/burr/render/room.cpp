#include "burr/render/room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "burr/render/ray_box.h"

namespace burr::render {

using math::Vec3;

namespace {

// Places along the ray; from > to: none.
struct Span {
  double from = std::numeric_limits<double>::infinity();
  double to = -std::numeric_limits<double>::infinity();

  void add(double place) {
    from = std::min(from, place);
    to = std::max(to, place);
  }
};

// In the frame of the ray: z along it, the ray at x = y = 0.
using Corners = std::array<Vec3, 3>;

void add_corner(const Vec3& a, double radius, Span& span) {
  const double left = radius * radius - a.x() * a.x() - a.y() * a.y();
  if (left < 0) return;
  span.add(a.z() - std::sqrt(left));
  span.add(a.z() + std::sqrt(left));
}

// The places at which the ball touches the inside of the edge.
void add_edge(const Vec3& a, const Vec3& b, double radius, Span& span) {
  const double length = (b - a).norm();
  if (length <= 0) return;
  const Vec3 along = (b - a) / length;
  const double far = -a.dot(along);  // of the ray's origin, along the edge from a
  const double square = 1 - along.z() * along.z();
  if (square < 1e-12) return;  // along the ray: its corners tell
  const double half = -a.z() - far * along.z();
  const double root = half * half - square * (a.squaredNorm() - far * far - radius * radius);
  if (root < 0) return;
  for (const double sign : {-1.0, 1.0}) {
    const double z = (-half + sign * std::sqrt(root)) / square;
    const double at = far + z * along.z();
    if (at >= 0 && at <= length) span.add(z);
  }
}

// The places at which the ball touches the inside of the face.
void add_face(const Corners& c, double radius, Span& span) {
  const Vec3 ab = c[1] - c[0], ac = c[2] - c[0];
  const Vec3 across = ab.cross(ac);
  const double area = across.norm();
  if (area <= 0) return;
  const Vec3 n = across / area;
  if (std::abs(n.z()) < 1e-9) return;  // along the ray: its edges tell
  for (const double side : {-radius, radius}) {
    const double z = (side + n.dot(c[0])) / n.z();
    const Vec3 foot = Vec3(0, 0, z) - side * n - c[0];
    const double v = ab.cross(foot).dot(n), w = foot.cross(ac).dot(n);
    if (v >= 0 && w >= 0 && v + w <= area) span.add(z);
  }
}

// All places at which the ball touches the triangle: one span, because the distance to a convex
// body is a convex function along a line.
Span touched(const Corners& c, double radius) {
  Span span;
  for (std::size_t n = 0; n < c.size(); ++n) {
    add_corner(c[n], radius, span);
    add_edge(c[n], c[(n + 1) % c.size()], radius, span);
  }
  add_face(c, radius, span);
  return span;
}

bool beside(double a, double b, double c, double radius) {
  return std::min({a, b, c}) > radius || std::max({a, b, c}) < -radius;
}

}  // namespace

std::optional<double> room_before(const Scene& scene, const Ray& ray, double farthest,
                                  double radius) {
  const Vec3 inverse = ray.direction.cwiseInverse();
  const Vec3 aside = ray.direction.unitOrthogonal(), up = ray.direction.cross(aside);
  std::vector<Span> spans;
  for (const ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr || entry(patch.box.inflated(radius), ray, inverse) > farthest)
      continue;
    const SkinMesh& mesh = *patch.mesh;
    for (std::size_t t = 0; t + 2 < mesh.index_count(); t += 3) {
      Corners c;
      for (std::size_t n = 0; n < c.size(); ++n) {
        const Vec3 p = mesh.vertices()[mesh.index(t + n)].p.cast<double>() - ray.origin;
        c[n] = {p.dot(aside), p.dot(up), p.dot(ray.direction)};
      }
      if (beside(c[0].x(), c[1].x(), c[2].x(), radius) ||
          beside(c[0].y(), c[1].y(), c[2].y(), radius) ||
          std::min({c[0].z(), c[1].z(), c[2].z()}) > farthest + radius)
        continue;
      const Span span = touched(c, radius);
      if (span.from < farthest && span.to >= 0) spans.push_back(span);
    }
  }
  std::sort(spans.begin(), spans.end(), [](const Span& a, const Span& b) { return a.to > b.to; });
  double place = farthest;
  for (const Span& span : spans) {
    if (span.to < place) break;  // this one and all that follow lie nearer to the eye
    place = std::min(place, span.from);
  }
  if (place < 0) return std::nullopt;
  return place;
}

}  // namespace burr::render
