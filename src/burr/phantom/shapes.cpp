#include "burr/phantom/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace burr::phantom {
namespace {

// Distance of (x, z), x >= 0, to the ray from the origin along (sin a, cos a).
double to_wall(double x, double z, double sin_a, double cos_a) {
  const double along = x * sin_a + z * cos_a;
  return along > 0 ? std::abs(x * cos_a - z * sin_a) : std::hypot(x, z);
}

// Exact distance to a box centred on the origin, negative inside; any dimension.
template <class Vector>
double to_box(const Vector& p, const Vector& half) {
  const Vector out = p.cwiseAbs() - half;
  return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
}

}  // namespace

Depth slab(const Vec3& outward, const Vec3& point) {
  const Vec3 n = outward.normalized();
  const double offset = n.dot(point);
  return [n, offset](const Vec3& p) { return offset - n.dot(p); };
}

Depth ball(double radius, const Vec3& centre) {
  return [radius, centre](const Vec3& p) { return radius - (p - centre).norm(); };
}

Depth bowl(double radius, const Vec3& centre) {
  return [radius, centre](const Vec3& p) { return (p - centre).norm() - radius; };
}

Depth box(const Vec3& half_extent) {
  return [half_extent](const Vec3& p) { return -to_box(p, half_extent); };
}

Depth cylinder(double radius, double half_height) {
  using Vec2 = Eigen::Vector2d;
  const Vec2 half(radius, half_height);
  return [half](const Vec3& p) {
    const Vec2 out(std::hypot(p.x(), p.y()) - half.x(), std::abs(p.z()) - half.y());
    return -(out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0));
  };
}

Depth capsule(const Vec3& a, const Vec3& b, double radius) {
  const Vec3 along = b - a;
  const double length2 = std::max(along.squaredNorm(), 1e-30);
  return [a, along, length2, radius](const Vec3& p) {
    const double t = std::clamp((p - a).dot(along) / length2, 0.0, 1.0);
    return radius - (p - a - t * along).norm();
  };
}

Depth groove(double half_angle) {
  const double sin_a = std::sin(half_angle), cos_a = std::cos(half_angle);
  return [sin_a, cos_a](const Vec3& p) {
    const double x = std::abs(p.x()), z = p.z();
    const bool air = x * cos_a < z * sin_a;  // between the walls
    const double distance = to_wall(x, z, sin_a, cos_a);
    return air ? -distance : distance;
  };
}

Depth wedge(double half_angle) {
  return [open = groove(half_angle)](const Vec3& p) { return -open(p); };
}

Depth torus(double ring, double tube) {
  return [ring, tube](const Vec3& p) {
    return tube - std::hypot(std::hypot(p.x(), p.y()) - ring, p.z());
  };
}

Depth plate(double thickness, const Vec3& normal, const Vec3& point) {
  const Vec3 n = normal.normalized();
  const double offset = n.dot(point);
  return [n, offset, half = 0.5 * thickness](const Vec3& p) {
    return half - std::abs(n.dot(p) - offset);
  };
}

Depth two_balls(double radius, double half_distance) {
  return either(ball(radius, {-half_distance, 0, 0}), ball(radius, {half_distance, 0, 0}));
}

Depth gyroid(double period, double fill) {
  const double k = 2 * std::numbers::pi / period;
  // the share of space where g > level is 0.5 - level / 3.06, within 0.5 % of space for fill 0.2 ..
  // 0.8 (from a sampling of the unit cell)
  const double level = 3.06 * (0.5 - fill);
  return [k, level](const Vec3& p) {
    const double sx = std::sin(k * p.x()), cx = std::cos(k * p.x());
    const double sy = std::sin(k * p.y()), cy = std::cos(k * p.y());
    const double sz = std::sin(k * p.z()), cz = std::cos(k * p.z());
    const double g = sx * cy + sy * cz + sz * cx - level;
    const Vec3 slope(cx * cy - sz * sx, cy * cz - sx * sy, cz * cx - sy * sz);
    // first-order estimate, where the slope is large enough
    return g / (k * std::max(slope.norm(), 0.8));
  };
}

Depth either(Depth a, Depth b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) { return std::max(a(p), b(p)); };
}

Depth common(Depth a, Depth b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) { return std::min(a(p), b(p)); };
}

Depth without(Depth a, Depth b) {
  return [a = std::move(a), b = std::move(b)](const Vec3& p) { return std::min(a(p), -b(p)); };
}

Depth placed(Depth shape, const Pose& world_from_shape) {
  return [shape = std::move(shape), shape_from_world = world_from_shape.inverse()](const Vec3& p) {
    return shape(shape_from_world * p);
  };
}

}  // namespace burr::phantom
