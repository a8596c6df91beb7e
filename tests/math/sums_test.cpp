#include "burr/math/sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace burr::math {
namespace {

// 2^53 + 1 is rounded to 2^53, 2^53 + 2 is not rounded: the two orders give different numbers.
constexpr double kLarge = 9007199254740992.0;
constexpr float kLargeFloat = 16777216.0F;

TEST(Sums, OfThreeDoublesAreAddedFromTheLeft) {
  EXPECT_EQ(dot(Vec3(kLarge, 1, 1), Vec3(1, 1, 1)), kLarge);
  EXPECT_EQ(dot(Vec3(1, 1, kLarge), Vec3(1, 1, 1)), kLarge + 2);
  const double root = 94906265.62425156;  // its square is 2^53, and even when rounded
  EXPECT_EQ(squared_norm(Vec3(root, 1, 1)), (root * root + 1) + 1);
  EXPECT_EQ(squared_norm(Vec3(1, 1, root)), 2 + root * root);
}

TEST(Sums, OfThreeFloatsAreAddedFromTheRight) {
  EXPECT_EQ(dot(Vec3f(kLargeFloat, 1, 1), Vec3f(1, 1, 1)), kLargeFloat + 2);
  EXPECT_EQ(dot(Vec3f(1, 1, kLargeFloat), Vec3f(1, 1, 1)), kLargeFloat);
}

TEST(Sums, OfAQuaternionAreAddedInPairsFarApart) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> any(0.5, 1);
  int other_order = 0;
  for (int i = 0; i < 1000; ++i) {
    const double w = any(random), x = any(random), y = any(random), z = any(random);
    const double square = (x * x + z * z) + (y * y + w * w);
    const Quat q = normalized(Quat(w, x, y, z));
    EXPECT_EQ(q.w(), w / std::sqrt(square));
    EXPECT_EQ(q.y(), y / std::sqrt(square));
    other_order += q.w() != w / std::sqrt((x * x + y * y) + (z * z + w * w)) ? 1 : 0;
  }
  EXPECT_GT(other_order, 10);
}

TEST(Sums, TakeExpressionsAndLeaveZeroAlone) {
  const Vec3 a(1, 2, 3), b(4, 6, 3);
  EXPECT_EQ(norm(b - a), 5);
  EXPECT_EQ(dot(2 * a, b - a), 22);
  EXPECT_EQ(normalized(b - a), Vec3(3.0 / 5, 4.0 / 5, 0));
  EXPECT_EQ(normalized(Vec3(Vec3::Zero())), Vec3::Zero());
  EXPECT_EQ(normalized(Vec3f(0, 0, 2)), Vec3f(0, 0, 1));
}

#ifdef EIGEN_VECTORIZE_SSE2
// Recordings from before math/sums.h was written hold what Eigen computed on x86-64.
TEST(Sums, AreThoseOfEigenOnThisProcessor) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(seed);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> any;
  int other_order = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3 a(any(random), any(random), any(random)), b(any(random), any(random), any(random));
    ASSERT_EQ(dot(a, b), a.dot(b));
    ASSERT_EQ(squared_norm(a), a.squaredNorm());
    ASSERT_EQ(norm(a - b), (a - b).norm());
    ASSERT_EQ(normalized(a), a.normalized());
    ASSERT_EQ(normalized(a.cross(b)), a.cross(b).normalized());
    const Vec3f c = a.cast<float>(), d = b.cast<float>();
    ASSERT_EQ(dot(c, d), c.dot(d));
    ASSERT_EQ(norm(c - d), (c - d).norm());
    const Quat q(any(random), a.x(), a.y(), a.z());
    ASSERT_EQ(normalized(q).coeffs(), q.normalized().coeffs());
    other_order += a.squaredNorm() != a.x() * a.x() + (a.y() * a.y() + a.z() * a.z()) ? 1 : 0;
  }
  EXPECT_GT(other_order, 1000);  // so the numbers above do tell one order from the other
}
#endif

}  // namespace
}  // namespace burr::math
