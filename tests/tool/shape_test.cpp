// Shapes against brute force: points of the core's surface, laid out by formulas that the code under
// test does not use.
#include "burr/tool/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "burr/rt/lanes.h"
#include "burr/tool/shape_formulas.h"

namespace burr::tool {
namespace {

using math::Vec3;

// Points of the core's surface: round kinds give their profile (r, z), the others the whole surface.
struct Body {
  std::string name;
  Shape shape;
  bool round = true;
  std::vector<Vec3> points;                // round: (r, 0, z)
  std::function<bool(const Vec3&)> holds;  // is the place in the core?
};

void line(std::vector<Vec3>& out, const Vec3& from, const Vec3& to, int count = 4000) {
  for (int n = 0; n <= count; ++n) out.emplace_back(from + (to - from) * (1.0 * n / count));
}

// The triangle or parallelogram a + s u + t v, s and t in [0, 1] (triangle: s + t <= 1).
void face(std::vector<Vec3>& out, const Vec3& a, const Vec3& u, const Vec3& v, bool triangle) {
  constexpr int kSide = 60;
  for (int i = 0; i <= kSide; ++i)
    for (int j = 0; j <= (triangle ? kSide - i : kSide); ++j)
      out.emplace_back(a + u * (1.0 * i / kSide) + v * (1.0 * j / kSide));
}

Body box_body() {
  Body body{"box", {ShapeKind::box, 0.4, 2, 1.2, 0.1}, false, {}, {}};
  const Vec3 h(0.4, 2, 1.2);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const Vec3 u = Vec3::Unit((axis + 1) % 3), v = Vec3::Unit((axis + 2) % 3);
      const double hu = h[(axis + 1) % 3], hv = h[(axis + 2) % 3];
      face(body.points, side * h[axis] * Vec3::Unit(axis) - hu * u - hv * v, 2 * hu * u, 2 * hv * v,
           false);
    }
  body.holds = [h](const Vec3& p) { return (p.cwiseAbs() - h).maxCoeff() <= 0; };
  return body;
}

Body wedge_body() {
  Body body{"wedge", {ShapeKind::wedge, 0.7, 1.5, 2.5, 0.05}, false, {}, {}};
  const double a = 0.7, b = 1.5, c = 2.5;
  for (const double side : {-1.0, 1.0}) {
    face(body.points, {0, -b, 0}, {0, 2 * b, 0}, {side * a, 0, c}, false);
    face(body.points, {0, side * b, 0}, {a, 0, c}, {-a, 0, c}, true);
  }
  face(body.points, {-a, -b, c}, {2 * a, 0, 0}, {0, 2 * b, 0}, false);
  body.holds = [=](const Vec3& p) {
    return std::abs(p.y()) <= b && p.z() <= c && std::abs(p.x()) * c <= a * p.z();
  };
  return body;
}

std::vector<Body> make_bodies() {
  std::vector<Body> all;
  const auto never = [](const Vec3&) { return false; };
  all.push_back({"ball", {ShapeKind::ball, 0, 0, 0, 1.3}, true, {Vec3::Zero()}, never});
  Body capsule{"capsule", {ShapeKind::capsule, 0, 0, 3, 0.6}, true, {}, never};
  line(capsule.points, {0, 0, -3}, {0, 0, 3}, 20'000);
  all.push_back(capsule);
  for (const bool disc : {false, true}) {
    const double a = disc ? 4 : 1, c = disc ? 0.3 : 3;
    Body body{disc ? "disc" : "cylinder", {ShapeKind::cylinder, a, 0, c, 0.2}, true, {}, {}};
    line(body.points, {0, 0, -c}, {a, 0, -c});
    line(body.points, {a, 0, -c}, {a, 0, c});
    line(body.points, {a, 0, c}, {0, 0, c});
    body.holds = [=](const Vec3& p) {
      return std::hypot(p.x(), p.y()) <= a && std::abs(p.z()) <= c;
    };
    all.push_back(body);
  }
  for (const bool tip_wide : {false, true}) {
    const double a = tip_wide ? 1.5 : 0.4, b = tip_wide ? 0.3 : 1.1, c = 2;
    Body body{
        tip_wide ? "inverted_cone" : "frustum", {ShapeKind::frustum, a, b, c, 0.15}, true, {}, {}};
    line(body.points, {0, 0, -c}, {a, 0, -c});
    line(body.points, {a, 0, -c}, {b, 0, c});
    line(body.points, {b, 0, c}, {0, 0, c});
    body.holds = [=](const Vec3& p) {
      return std::abs(p.z()) <= c &&
             std::hypot(p.x(), p.y()) <= a + (b - a) * (p.z() + c) / (2 * c);
    };
    all.push_back(body);
  }
  {
    const double a = 0.9, c = 3, offset = (c * c - a * a) / (2 * a), arc = offset + a;
    Body body{"vesica", {ShapeKind::vesica, a, 0, c, 0.2}, true, {}, {}};
    const double most = std::asin(c / arc);
    for (int n = 0; n <= 8000; ++n) {
      const double angle = most * (n / 4000.0 - 1);
      body.points.emplace_back(arc * std::cos(angle) - offset, 0, arc * std::sin(angle));
    }
    body.holds = [=](const Vec3& p) {
      return std::hypot(std::hypot(p.x(), p.y()) + offset, p.z()) <= arc;
    };
    all.push_back(body);
  }
  {
    const double a = 2, b = 0.6;
    Body body{"half_shell", {ShapeKind::half_shell, a, b, 0, 0.3}, true, {}, never};
    const double most = std::asin(b / a);
    for (int n = 0; n <= 8000; ++n) {
      const double angle = -M_PI / 2 + (most + M_PI / 2) * n / 8000;
      body.points.emplace_back(a * std::cos(angle), 0, a * std::sin(angle));
    }
    all.push_back(body);
  }
  {
    const double a = 2, b = 1.2, c = 1.5;
    Body body{"tube", {ShapeKind::tube, a, b, c, 0.1}, true, {}, {}};
    line(body.points, {b, 0, -c}, {a, 0, -c});
    line(body.points, {a, 0, -c}, {a, 0, c});
    line(body.points, {a, 0, c}, {b, 0, c});
    line(body.points, {b, 0, c}, {b, 0, -c});
    body.holds = [=](const Vec3& p) {
      const double r = std::hypot(p.x(), p.y());
      return r >= b && r <= a && std::abs(p.z()) <= c;
    };
    all.push_back(body);
  }
  all.push_back(box_body());
  all.push_back(wedge_body());
  return all;
}

const std::vector<Body>& bodies() {
  static const std::vector<Body> all = make_bodies();
  return all;
}

// Signed distance to the rounded body.
double brute(const Body& body, const Vec3& p) {
  // the nearest point of a round body lies in the half plane of p
  const Vec3 at = body.round ? Vec3(std::hypot(p.x(), p.y()), 0, p.z()) : p;
  double least = 1e9;
  for (const Vec3& q : body.points) least = std::min(least, (q - at).squaredNorm());
  return (body.holds(p) ? -1 : 1) * std::sqrt(least) - body.shape.rounding;
}

class EachShape : public testing::TestWithParam<int> {
 protected:
  const Body& body = bodies()[static_cast<std::size_t>(GetParam())];
  std::mt19937 random{20261127};
  // Near a point of the surface: at tips, rims and corners more often than a place in a cube is.
  Vec3 beside_it() {
    std::uniform_real_distribution<double> angle(0, 2 * M_PI);
    std::uniform_int_distribution<std::size_t> any(0, body.points.size() - 1), few(0, 1);
    const Vec3& q = few(random) == 0 ? (few(random) == 0 ? body.points.front() : body.points.back())
                                     : body.points[any(random)];
    const double turn = body.round ? angle(random) : 0;
    return Vec3(q.x() * std::cos(turn) - q.y() * std::sin(turn),
                q.x() * std::sin(turn) + q.y() * std::cos(turn), q.z()) +
           somewhere(1);
  }
  Vec3 somewhere(double wide) {
    std::uniform_real_distribution<double> side(-wide, wide);
    return {side(random), side(random), side(random)};
  }
};

TEST_P(EachShape, DistanceIsThatOfItsSurfacePoints) {
  // half the distance between two neighbouring points of a face, at worst
  const double spacing = body.round ? 0.002 : 0.07;
  for (int n = 0; n < 120; ++n) {
    const Vec3 p = n % 2 == 0 ? beside_it() : somewhere(5);
    const double phi = distance(body.shape, p).phi, truth = brute(body, p);
    const double far = std::abs(truth + body.shape.rounding);
    // a grid of points is farther away than the face by spacing^2 / (2 far), or by the spacing
    const double error = std::min(spacing, spacing * spacing / std::max(far, 1e-9)) + 1e-9;
    EXPECT_NEAR(phi, truth, error) << "seed 20261127, place " << p.transpose();
  }
}

TEST_P(EachShape, GradientIsThatOfTheDistanceAndUnit) {
  constexpr double kStep = 1e-5;
  int compared = 0;
  for (int n = 0; n < 400; ++n) {
    const Vec3 p = somewhere(4);
    const Distance there = distance(body.shape, p);
    EXPECT_NEAR(there.gradient.norm(), 1, 1e-12);
    if (body.shape.kind == ShapeKind::half_shell && there.phi < 0) continue;
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = kStep * Vec3::Unit(axis);
      slope[axis] =
          (distance(body.shape, p + step).phi - distance(body.shape, p - step).phi) / (2 * kStep);
    }
    if (std::abs(slope.norm() - 1) > 1e-6) continue;  // a kink inside, or between two faces
    ++compared;
    EXPECT_LT((slope - there.gradient).norm(), 1e-4) << p.transpose();
  }
  EXPECT_GT(compared, 300);
}

TEST_P(EachShape, DistanceGrowsNoFasterThanThePlaceMoves) {
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = somewhere(4), q = p + somewhere(n % 2 == 0 ? 0.05 : 3);
    EXPECT_LE(std::abs(distance(body.shape, p).phi - distance(body.shape, q).phi),
              (p - q).norm() * (1 + 1e-12) + 1e-12);
  }
}

// Between two places the distance of a convex body is no larger than the straight line says: that is
// why a straight move between two free places is free.
TEST_P(EachShape, DistanceIsConvexWhereTheShapeIs) {
  int bulges = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = somewhere(4), q = somewhere(4);
    const double middle = distance(body.shape, 0.5 * (p + q)).phi;
    const double mean = 0.5 * (distance(body.shape, p).phi + distance(body.shape, q).phi);
    bulges += middle > mean + 1e-9 ? 1 : 0;
  }
  if (convex(body.shape.kind))
    EXPECT_EQ(bulges, 0);
  else
    EXPECT_GT(bulges, 10);
}

TEST_P(EachShape, SupportBoxAndBallAreThoseOfItsSurfacePoints) {
  const BoundingBall ball = bounding_ball(body.shape);
  const math::Aabb box = bounds(body.shape);
  for (int n = 0; n < 60; ++n) {
    const Vec3 way = somewhere(1);
    const double radial = std::hypot(way.x(), way.y());
    double most = -1e9;
    for (const Vec3& q : body.points) {
      most = std::max(most, body.round ? q.x() * radial + q.z() * way.z() : q.dot(way));
    }
    EXPECT_NEAR(support(body.shape, way), most + body.shape.rounding * way.norm(), 1e-5);
  }
  for (const Vec3& q : body.points) {
    ASSERT_LE((q - ball.centre).norm() + body.shape.rounding, ball.radius + 1e-9);
    ASSERT_TRUE((q.array() <= box.hi.array() - body.shape.rounding + 1e-9).all());
    ASSERT_TRUE((q.array() >= box.lo.array() + body.shape.rounding - 1e-9).all() ||
                (body.round && q.x() >= 0 && q.z() >= box.lo.z() + body.shape.rounding - 1e-9));
  }
}

TEST_P(EachShape, SixteenLanesAgreeWithOneNumber) {
  using rt::lanes::Floats;
  const Sizes<float> sizes = sizes_of<float>(body.shape);
  for (int n = 0; n < 50; ++n) {
    Floats x, y, z;
    Vec3 places[16];
    for (int l = 0; l < 16; ++l) {
      places[l] = somewhere(4).cast<float>().cast<double>();
      x[l] = static_cast<float>(places[l].x());
      y[l] = static_cast<float>(places[l].y());
      z[l] = static_cast<float>(places[l].z());
    }
    Field<rt::lanes::SixteenNumbers> lanes;
    field_of<rt::lanes::SixteenNumbers>(body.shape.kind, sizes, x, y, z, lanes);
    for (int l = 0; l < 16; ++l) {
      const Distance one = distance(body.shape, places[l]);
      EXPECT_NEAR(static_cast<double>(lanes.phi[l]), one.phi, 3e-6);
      const double error = std::hypot(static_cast<double>(lanes.x[l]) - one.gradient.x(),
                                      static_cast<double>(lanes.y[l]) - one.gradient.y(),
                                      static_cast<double>(lanes.z[l]) - one.gradient.z());
      if (std::abs(one.phi) > 0.3) {
        EXPECT_LT(error, 1e-4);
      }
    }
  }
}

TEST_P(EachShape, ScalingScalesTheDistance) {
  for (int n = 0; n < 20; ++n) {
    const Vec3 p = somewhere(4);
    EXPECT_NEAR(distance(scaled(body.shape, 4), 4 * p).phi, 4 * distance(body.shape, p).phi, 1e-9);
  }
  EXPECT_TRUE(is_body(body.shape));
}

INSTANTIATE_TEST_SUITE_P(Kinds, EachShape, testing::Range(0, static_cast<int>(bodies().size())),
                         [](const auto& which) {
                           return bodies()[static_cast<std::size_t>(which.param)].name;
                         });

TEST(Shape, SizesThatDescribeNoBodyAreRefused) {
  EXPECT_FALSE(is_body({ShapeKind::ball, 0, 0, 0, 0}));
  EXPECT_FALSE(is_body({ShapeKind::capsule, 0, 0, -1, 1}));
  EXPECT_FALSE(is_body({ShapeKind::vesica, 3, 0, 2, 0.1}));
  EXPECT_FALSE(is_body({ShapeKind::half_shell, 1, 1, 0, 0.1}));
  EXPECT_FALSE(is_body({ShapeKind::box, NAN, 1, 1, 0.1}));
  EXPECT_FALSE(is_body({ShapeKind::wedge, 0, 1, 1, 0.1}));
}

}  // namespace
}  // namespace burr::tool
