// The shortest allowed move against brute force over all corners, and against closed forms.
#include "burr/haptics/least_move.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

namespace burr::haptics {
namespace {

using math::Vec3;

struct Planes {
  std::unique_ptr<Candidates> all = std::make_unique<Candidates>();

  void add(const Vec3& normal, double gap) {
    const int n = all->count++;
    all->nx[n] = static_cast<float>(normal.x());
    all->ny[n] = static_cast<float>(normal.y());
    all->nz[n] = static_cast<float>(normal.z());
    all->gap[n] = static_cast<float>(gap);
  }
  [[nodiscard]] Vec3 normal(int n) const { return Vec3f(n).cast<double>(); }
  [[nodiscard]] double gap(int n) const { return static_cast<double>(all->gap[n]); }
  // How far a move oversteps the worst of them, 0: none.
  [[nodiscard]] double overstep(const Vec3& p) const {
    double worst = 0;
    for (int n = 0; n < all->count; ++n) worst = std::max(worst, -normal(n).dot(p) - gap(n));
    return worst;
  }

 private:
  [[nodiscard]] math::Vec3f Vec3f(int n) const { return {all->nx[n], all->ny[n], all->nz[n]}; }
};

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

// The nearest allowed point: of all points where up to three planes hold with equality, by least
// squares, the nearest that no plane forbids.
double brute_force(const Planes& planes, const Vec3& wanted) {
  const int count = planes.all->count;
  double least = planes.overstep(wanted) <= 1e-9 ? 0 : std::numeric_limits<double>::infinity();
  const auto look_at = [&](const std::vector<int>& members) {
    const auto rows = static_cast<Eigen::Index>(members.size());
    Eigen::MatrixXd a(rows, 3);
    Eigen::VectorXd b(rows);
    for (Eigen::Index r = 0; r < rows; ++r) {
      const int n = members[static_cast<std::size_t>(r)];
      a.row(r) = planes.normal(n).transpose();
      b(r) = -planes.gap(n) - planes.normal(n).dot(wanted);
    }
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(a);
    if (solver.rank() < rows) return;
    const Vec3 correction = solver.solve(b);  // the shortest
    if (planes.overstep(wanted + correction) <= 1e-9) least = std::min(least, correction.norm());
  };
  for (int i = 0; i < count; ++i) {
    look_at({i});
    for (int j = i + 1; j < count; ++j) {
      look_at({i, j});
      for (int k = j + 1; k < count; ++k) look_at({i, j, k});
    }
  }
  return least;
}

TEST(LeastMove, IsAsShortAsBruteForceFinds) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const MostViolated most_violated = scan_kernel().most_violated;
  int pressed[4] = {};
  for (int round = 0; round < 400; ++round) {
    Planes planes;
    const int count = 1 + static_cast<int>(14 * unit(random));
    const Vec3 up = direction(random);
    for (int n = 0; n < count; ++n) {  // every other time all face one way, as in a groove
      const Vec3 way = direction(random);
      planes.add(round % 2 == 0 ? way : Vec3(0.7 * way + up).normalized(), 0.5 * unit(random));
    }
    const Vec3 wanted = 2 * unit(random) * direction(random);
    const LeastMove move = least_move(*planes.all, wanted, most_violated);
    ASSERT_TRUE(move.solved);
    EXPECT_LE(planes.overstep(move.p), 1e-5);
    EXPECT_NEAR((move.p - wanted).norm(), brute_force(planes, wanted), 2e-4);
    // planes only push, and only those that it rests on
    Vec3 pushed = wanted;
    for (int i = 0; i < move.active; ++i) {
      EXPECT_GE(move.push[i], -1e-9);
      pushed += move.push[i] * planes.normal(move.index[i]);
      EXPECT_NEAR(planes.normal(move.index[i]).dot(move.p), -planes.gap(move.index[i]), 1e-6);
    }
    EXPECT_NEAR((pushed - move.p).norm(), 0, 1e-6);
    ++pressed[move.active];
  }
  for (const int times : pressed) EXPECT_GT(times, 0) << "every number of contacts is tried";
}

TEST(LeastMove, OfOneTwoAndThreePlanesIsTheClosedForm) {
  const MostViolated most_violated = scan_kernel().most_violated;
  Planes planes;
  const Vec3 wanted(-1, -2, -3);
  LeastMove move = least_move(*planes.all, wanted, most_violated);
  EXPECT_EQ(move.p, wanted) << "nothing in the way";
  EXPECT_EQ(move.active, 0);

  planes.add(Vec3::UnitZ(), 0.5);
  move = least_move(*planes.all, wanted, most_violated);
  EXPECT_NEAR((move.p - Vec3(-1, -2, -0.5)).norm(), 0, 1e-9);
  EXPECT_NEAR(move.push[0], 2.5, 1e-9);

  planes.add(Vec3::UnitY(), 0.25);
  move = least_move(*planes.all, wanted, most_violated);
  EXPECT_NEAR((move.p - Vec3(-1, -0.25, -0.5)).norm(), 0, 1e-9);

  planes.add(Vec3::UnitX(), 0.125);
  move = least_move(*planes.all, wanted, most_violated);
  EXPECT_NEAR((move.p - Vec3(-0.125, -0.25, -0.5)).norm(), 0, 1e-9);
  EXPECT_EQ(move.active, 3);

  // a wedge of a half angle of 30 degrees: the floor is where both faces meet
  Planes wedge;
  const double sine = 0.5, cosine = std::sqrt(0.75);
  wedge.add({cosine, 0, sine}, 0.1);
  wedge.add({-cosine, 0, sine}, 0.1);
  move = least_move(*wedge.all, {0, 0.3, -1}, most_violated);
  EXPECT_NEAR((move.p - Vec3(0, 0.3, -0.2)).norm(), 0, 1e-6);
  EXPECT_NEAR(move.push[0], 0.8, 1e-6) << "half of the way over the sine each";
  EXPECT_NEAR(move.push[1], 0.8, 1e-6);
}

TEST(LeastMove, BetweenPlanesThatLeaveNoRoomStaysPutAndSaysSo) {
  Planes planes;
  planes.add(Vec3::UnitZ(), -0.2);
  planes.add(-Vec3::UnitZ(), -0.2);
  const LeastMove move = least_move(*planes.all, {1, 0, 0}, scan_kernel().most_violated);
  EXPECT_FALSE(move.solved);
  EXPECT_EQ(move.p, Vec3(Vec3::Zero()));
}

}  // namespace
}  // namespace burr::haptics
