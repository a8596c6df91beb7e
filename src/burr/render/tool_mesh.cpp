#include "burr/render/tool_mesh.h"
#include "burr/tool/shape_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace burr::render {
namespace {

using math::Vec3;
using tool::Shape;
using tool::ShapeKind;

constexpr double kPi = std::numbers::pi;

// A place of a profile in the half plane (r, z), with its normal.
struct Place {
  double r = 0, z = 0, nr = 0, nz = 0;
};
// Places between which the surface goes on; two of them at one place are an edge.
using Profile = std::vector<Place>;

// Number of steps so that a facet of an arc of this radius and angle is near enough.
int steps_of(double radius, double angle) {
  if (radius <= kToolFacet) return 2;
  const double step = 2 * std::acos(1 - kToolFacet / radius);
  return std::clamp(static_cast<int>(std::ceil(std::abs(angle) / step)), 2, 96);
}

// An arc around (r, z) from one direction to another; angles from +r towards +z.
void add_arc(Profile& profile, double r, double z, double radius, double from, double to) {
  const int steps = steps_of(radius, to - from);
  for (int n = 0; n <= steps; ++n) {
    const double angle = from + (to - from) * n / steps, c = std::cos(angle), s = std::sin(angle);
    profile.push_back({std::max(0.0, r + radius * c), z + radius * s, c, s});
  }
}

// A convex core of corners from the lower to the upper end of the axis, and the ball rolled around.
Profile rolled(const std::vector<std::array<double, 2>>& corners, double rounding) {
  Profile profile;
  double last = -kPi / 2;  // direction of the normal before the corner
  for (std::size_t n = 0; n < corners.size(); ++n) {
    const auto [r, z] = corners[n];
    double next = kPi / 2;
    if (n + 1 < corners.size()) next = std::atan2(-(corners[n + 1][0] - r), corners[n + 1][1] - z);
    add_arc(profile, r, z, rounding, last, next);
    last = next;
  }
  return profile;
}

// The arc of a vesica, with its tips rounded.
Profile vesica(const Shape& s) {
  const double offset = (s.c * s.c - s.a * s.a) / (2 * s.a), arc = offset + s.a;
  const double at_tip = std::asin(s.c / arc);
  Profile profile;
  add_arc(profile, 0, -s.c, s.rounding, -kPi / 2, -at_tip);
  add_arc(profile, -offset, 0, arc + s.rounding, -at_tip, at_tip);
  add_arc(profile, 0, s.c, s.rounding, at_tip, kPi / 2);
  return profile;
}

// Outside of a spoon from its pole to the rim, around the rim, and back inside.
Profile half_shell(const Shape& s) {
  const double rim = std::asin(std::clamp(s.b / s.a, -1.0, 1.0));
  Profile profile;
  add_arc(profile, 0, 0, s.a + s.rounding, -kPi / 2, rim);
  add_arc(profile, s.a * std::cos(rim), s.b, s.rounding, rim, rim + kPi);
  Profile inside;
  add_arc(inside, 0, 0, s.a - s.rounding, -kPi / 2, rim);
  std::reverse(inside.begin(), inside.end());
  for (Place& place : inside) {
    place.nr = -place.nr;
    place.nz = -place.nz;
    profile.push_back(place);
  }
  return profile;
}

// Around the wall of a tube, from the middle of its inner side on.
Profile tube(const Shape& s) {
  const double corners[][2] = {{s.b, -s.c}, {s.a, -s.c}, {s.a, s.c}, {s.b, s.c}};
  Profile profile;
  double last = -kPi;  // direction of the normal before the corner: to the axis
  profile.push_back({s.b - s.rounding, 0, -1, 0});
  for (const auto& [r, z] : corners) {
    add_arc(profile, r, z, s.rounding, last, last + kPi / 2);
    last += kPi / 2;
  }
  profile.push_back({s.b - s.rounding, 0, -1, 0});
  return profile;
}

Profile profile_of(const Shape& s) {
  switch (s.kind) {
    case ShapeKind::capsule:
      return rolled({{0, -s.c}, {0, s.c}}, s.rounding);
    case ShapeKind::cylinder:
      return rolled({{0, -s.c}, {s.a, -s.c}, {s.a, s.c}, {0, s.c}}, s.rounding);
    case ShapeKind::frustum:
      return rolled({{0, -s.c}, {s.a, -s.c}, {s.b, s.c}, {0, s.c}}, s.rounding);
    case ShapeKind::vesica:
      return vesica(s);
    case ShapeKind::half_shell:
      return half_shell(s);
    case ShapeKind::tube:
      return tube(s);
    case ShapeKind::ball:
    case ShapeKind::box:
    case ShapeKind::wedge:
    case ShapeKind::grid:
      break;
  }
  return rolled({{0, 0}}, s.rounding);
}

surface::Mesh turned(const Profile& profile) {
  double widest = 0;
  for (const Place& place : profile) widest = std::max(widest, place.r);
  const int around = std::max(12, steps_of(widest, 2 * kPi));
  surface::Mesh mesh;
  for (const Place& place : profile)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * kPi * i / around, c = std::cos(angle), s = std::sin(angle);
      surface::Vertex vertex;
      vertex.p = Vec3(place.r * c, place.r * s, place.z).cast<float>();
      vertex.n = Vec3(place.nr * c, place.nr * s, place.nz).cast<float>();
      mesh.vertices.push_back(vertex);
    }
  const auto index = [around](std::size_t ring, int i) {
    return static_cast<std::uint32_t>(ring * static_cast<std::size_t>(around) +
                                      static_cast<std::size_t>(i % around));
  };
  for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
    const Place &low = profile[ring], &high = profile[ring + 1];
    if (std::hypot(high.r - low.r, high.z - low.z) < 1e-12) continue;  // an edge
    for (int i = 0; i < around; ++i) {
      const std::uint32_t a = index(ring, i), b = index(ring, i + 1), c = index(ring + 1, i + 1),
                          d = index(ring + 1, i);
      if (low.r > 0) mesh.triangles.insert(mesh.triangles.end(), {a, b, c});
      if (high.r > 0) mesh.triangles.insert(mesh.triangles.end(), {a, c, d});
    }
  }
  return mesh;
}

// A polygon in a plane, counter-clockwise seen from outside.
void add_face(surface::Mesh& mesh, const std::vector<Vec3>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const Vec3 n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  for (const Vec3& corner : corners) {
    surface::Vertex vertex;
    vertex.p = corner.cast<float>();
    vertex.n = n.cast<float>();
    mesh.vertices.push_back(vertex);
  }
  for (std::uint32_t n1 = 1; n1 + 1 < corners.size(); ++n1)
    mesh.triangles.insert(mesh.triangles.end(), {first, first + n1, first + n1 + 1});
}

// A convex outline in (x, z), counter-clockwise seen from -y, drawn out to |y| <= half.
surface::Mesh drawn_out(const std::vector<std::array<double, 2>>& outline, double half) {
  surface::Mesh mesh;
  std::vector<Vec3> near, far;
  for (const auto& [x, z] : outline) {
    near.emplace_back(x, -half, z);
    far.emplace_back(x, half, z);
  }
  add_face(mesh, near);
  for (std::size_t n = 0; n < near.size(); ++n) {
    const std::size_t next = (n + 1) % near.size();
    add_face(mesh, {near[n], far[n], far[next], near[next]});
  }
  std::reverse(far.begin(), far.end());
  add_face(mesh, far);
  return mesh;
}

surface::Mesh mesh_of_grid(const Shape& shape) {
  const tool::GridSurface found = tool::surface_of(*shape.grid);
  surface::Mesh mesh;
  for (const Vec3& point : found.points) {
    const Vec3 p = shape.a * point;
    surface::Vertex vertex;
    vertex.p = p.cast<float>();
    vertex.n = tool::distance(shape, p).gradient.cast<float>();
    mesh.vertices.push_back(vertex);
  }
  mesh.triangles.assign(found.triangles.begin(), found.triangles.end());
  return mesh;
}

}  // namespace

surface::Mesh mesh_of(const Shape& shape) {
  if (shape.kind == ShapeKind::grid) return mesh_of_grid(shape);
  const double x = shape.a + shape.rounding, y = shape.b + shape.rounding,
               z = shape.c + shape.rounding;
  if (shape.kind == ShapeKind::box) return drawn_out({{-x, -z}, {x, -z}, {x, z}, {-x, z}}, y);
  if (shape.kind == ShapeKind::wedge) return drawn_out({{0, -shape.rounding}, {x, z}, {-x, z}}, y);
  return turned(profile_of(shape));
}

surface::Mesh mesh_of(const tool::Tool& tool, tool::Role role) {
  surface::Mesh all;
  for (int n = 0; n < tool.count; ++n) {
    const tool::Part& part = tool.parts[static_cast<std::size_t>(n)];
    if (part.role != role) continue;
    const surface::Mesh mesh = mesh_of(part.shape);
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    for (surface::Vertex vertex : mesh.vertices) {
      vertex.p = (part.tool_from_part * Vec3(vertex.p.cast<double>())).cast<float>();
      vertex.n = (part.tool_from_part.q * Vec3(vertex.n.cast<double>())).cast<float>();
      all.vertices.push_back(vertex);
    }
    for (const std::uint32_t corner : mesh.triangles) all.triangles.push_back(first + corner);
  }
  return all;
}

}  // namespace burr::render
