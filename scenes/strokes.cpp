#include "scenes/strokes.h"

#include <algorithm>
#include <cmath>

#include "burr/phantom/build.h"

namespace burr::scenes {
namespace {

constexpr double kMm = 1e-3;

// The grid that holds everything the burr can reach on its way, and the bone below it.
volume::Grid about(const Stroke& stroke, double r, double h) {
  Vec3 lo = stroke.start, hi = stroke.start;
  for (int n = 0; n <= 100; ++n) {
    const Vec3 at = stroke.true_centre(stroke.hand(n / 100.0));
    lo = lo.cwiseMin(at);
    hi = hi.cwiseMax(at);
  }
  const Vec3 around = Vec3::Constant(r + 1.5 * kMm + 6 * h);
  // voxel centres at whole multiples of h/2 from the origin, whatever the size of the box
  lo = ((lo - around) / h).array().floor() * h;
  hi = ((hi + around) / h).array().ceil() * h;
  return phantom::box_grid(lo, hi, h);
}

}  // namespace

std::vector<Stroke> strokes(double r, double h, double deep) {
  std::vector<Stroke> all;
  const double above = 2 * kMm;
  const Vec3 a(1, 0, 0), b(0, 0.8, 0.6);
  const auto on = [a, b](double s) { return Vec3(std::cos(s) * a + std::sin(s) * b); };
  {
    Stroke one;
    one.name = "plane";
    const Vec3 n = Vec3(0.3, -0.5, 0.8).normalized(), along = n.unitOrthogonal();
    one.depth = phantom::slab(n);
    one.start = (r + above) * n;
    one.hand = [=](double s) { return Vec3((r - deep) * n + (8 * s - 4) * kMm * along); };
    one.true_centre = [=](const Vec3& x) { return Vec3(x + (r - n.dot(x)) * n); };
    one.convex = INFINITY;
    all.push_back(one);
  }
  {
    Stroke one;
    one.name = "ball";
    const double R = 5 * kMm;
    one.depth = phantom::ball(R);
    one.start = (R + r + above) * on(0);
    one.hand = [=](double s) { return Vec3((R + r - deep) * on(1.5 * s)); };
    one.true_centre = [=](const Vec3& x) { return Vec3((R + r) * x.normalized()); };
    one.convex = R;
    all.push_back(one);
  }
  {
    Stroke one;
    one.name = "cavity";
    const double R = std::max(6 * kMm, 1.5 * r);
    one.depth = phantom::bowl(R);
    one.start = Vec3::Zero();
    one.hand = [=](double s) { return Vec3((R - r + deep) * on(1.5 * s)); };
    one.true_centre = [=](const Vec3& x) { return Vec3((R - r) * x.normalized()); };
    // against a wall that curves almost like the burr, small errors move it far sideways
    one.radius_error_factor = R / (R - r);
    all.push_back(one);
  }
  {
    // along a face, over the edge, down the side
    Stroke one;
    one.name = "edge";
    one.sharp = true;
    const double side = std::ceil(5 * kMm / h) * h + h / 2, flat = 3 * kMm, turn = M_PI / 2 * r,
                 total = 2 * flat + turn;
    one.depth = phantom::box(Vec3::Constant(side));
    const auto way = [=](double s, double away) {
      const double at = s * total;
      if (at < flat) return Vec3(side - flat + at, 0.4 * kMm, side + away);
      if (at > flat + turn) return Vec3(side + away, 0.4 * kMm, side - (at - flat - turn));
      const double angle = (at - flat) / r;
      return Vec3(side + away * std::sin(angle), 0.4 * kMm, side + away * std::cos(angle));
    };
    one.start = way(0, r + above);
    one.hand = [=](double s) { return way(s, r - deep); };
    one.true_centre = [=](const Vec3& x) {
      const Vec3 foot(std::min(x.x(), side), x.y(), std::min(x.z(), side));
      return Vec3(foot + r * (x - foot).normalized());
    };
    all.push_back(one);
  }
  {
    Stroke one;
    one.name = "corner";
    one.sharp = true;
    const double side = std::ceil(5 * kMm / h) * h + h / 2;
    one.depth = phantom::box(Vec3::Constant(side));
    const Vec3 corner = Vec3::Constant(side), u = Vec3(1, 1, 1).normalized(),
               t = u.unitOrthogonal(), q = u.cross(t);
    const auto out = [=](double s) {
      return Vec3((u + 0.3 * std::cos(6 * s) * t + 0.3 * std::sin(6 * s) * q).normalized());
    };
    one.start = corner + (r + above) * out(0);
    one.hand = [=](double s) { return Vec3(corner + (r - deep) * out(s)); };
    one.true_centre = [=](const Vec3& x) { return Vec3(corner + r * (x - corner).normalized()); };
    all.push_back(one);
  }
  {
    Stroke one;
    one.name = "torus";
    const double ring = 6 * kMm, tube = 2 * kMm;
    one.depth = phantom::torus(ring, tube);
    const auto hand = [=](double s) {
      const double round = 0.8 * s, up = 0.4 + 0.9 * s;
      const Vec3 out(std::cos(round), std::sin(round), 0);
      return Vec3(ring * out +
                  (tube + r - deep) * (std::cos(up) * out + std::sin(up) * Vec3::UnitZ()));
    };
    const auto middle = [=](const Vec3& x) {
      return Vec3(ring * Vec3(x.x(), x.y(), 0).normalized());
    };
    one.hand = hand;
    one.start = hand(0) + (above + deep) * (hand(0) - middle(hand(0))).normalized();
    one.true_centre = [=](const Vec3& x) {
      const Vec3 q = middle(x);
      return Vec3(q + (tube + r) * (x - q).normalized());
    };
    one.convex = tube;
    all.push_back(one);
  }
  {
    // larger than the hole: rests on the ring
    Stroke one;
    one.name = "hole";
    const double tube = 2 * kMm, ring = tube + 0.6 * r;
    one.depth = phantom::torus(ring, tube);
    const double z = std::sqrt((tube + r) * (tube + r) - ring * ring);
    one.start = {0, 0, z + above};
    one.hand = [=](double s) { return Vec3(0, 0, z - deep * (0.5 + s / 2)); };
    one.true_centre = [=](const Vec3&) { return Vec3(0, 0, z); };
    one.radius_error_factor = (tube + r) / z;
    all.push_back(one);
  }
  for (const double half : {45.0, 30.0}) {
    Stroke one;
    one.name = half > 40 ? "groove 90" : "groove 60";
    const double angle = half * M_PI / 180, z = r / std::sin(angle);
    one.depth = phantom::groove(angle);
    one.start = {0, -3 * kMm, z + above};
    one.hand = [=](double s) { return Vec3(0, (6 * s - 3) * kMm, z - deep); };
    one.true_centre = [=](const Vec3& x) { return Vec3(0, x.y(), z); };
    one.centre_hand = [=](double s) {
      return Vec3(-0.1 * kMm - r * s * s, (6 * s - 3) * kMm, -deep);
    };
    one.radius_error_factor = 1 / std::sin(angle);
    all.push_back(one);
  }
  {
    Stroke one;
    one.name = "two balls";
    const double rho = 3 * kMm, apart = std::min(3.5 * kMm, 0.8 * (rho + r));
    one.depth = phantom::two_balls(rho, apart);
    const double z = std::sqrt((rho + r) * (rho + r) - apart * apart);
    one.start = {0, 0, z + above};
    one.hand = [=](double s) { return Vec3(0, 0, z - deep * (0.5 + s / 2)); };
    one.true_centre = [=](const Vec3&) { return Vec3(0, 0, z); };
    one.radius_error_factor = (rho + r) / z;
    all.push_back(one);
  }
  for (Stroke& one : all) one.grid = about(one, r, h);
  return all;
}

}  // namespace burr::scenes
