// A device that is tried by a hand that does not follow the instructions, and by one that presses
// too hard.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "devices/trial.h"

namespace burr::app {
namespace {

using math::Vec3;

// Position and velocity of the hand t seconds after instruction n (0: rest, 1 to 3: an axis, 4: the
// wall).
struct At {
  Vec3 place = Vec3::Zero(), velocity = Vec3::Zero();
  bool valid = true;
};
using Way = std::function<At(int words, double t)>;

class Clumsy final : public device::Device {
 public:
  explicit Clumsy(Way way) : way_(std::move(way)) { forces_.reserve(1 << 16); }
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override {
    if (const int now = words.load(); now != doing_) {
      doing_ = now;
      since_ = 0;
    }
    since_ += dt;
    const At at = way_(doing_, since_);
    device::HandState hand;
    hand.world_from_tool.p = at.place;
    hand.velocity = at.velocity;
    hand.valid = at.valid;
    return hand;
  }
  void write_force(const Vec3& force) BURR_RT override {
    const std::lock_guard lock(mutex_);
    forces_.push_back(force.y());
  }
  [[nodiscard]] std::vector<double> forces() {
    const std::lock_guard lock(mutex_);
    return forces_;
  }
  std::atomic<int> words = 0;

 private:
  Way way_;
  device::DeviceSpec spec_{.name = "clumsy", .peak_force = 3.3, .max_stiffness = 1000};
  double since_ = 0;
  int doing_ = 0;
  std::mutex mutex_;
  std::vector<double> forces_;
};

TrialMeasurements tried(
    Clumsy& device, const TrialSettings& settings,
    const std::function<bool()>& stop = [] { return false; }) {
  int told = 0;
  return try_device(
      device, settings, [&](const std::string&) { device.words = told++; }, stop);
}

// Along the axis as instructed, then at rest.
At obeys(int words, double t) {
  At at;
  if (words >= 1 && words <= 3) at.place[words - 1] = std::min(0.04, 0.1 * std::max(0.0, t - 0.1));
  return at;
}

TEST(TrialTrouble, AHandThatIsNeverFoundIsCountedAndLeftOut) {
  Clumsy device([](int, double) { return At{.valid = false}; });
  const TrialMeasurements seen = tried(device, {.rest_s = 0.1, .longest_s = 0.05});
  EXPECT_GT(seen.ticks, 0U);
  EXPECT_EQ(seen.invalid, seen.ticks);
  EXPECT_EQ(seen.left_out.size(), 5U) << "rest, three axes, the wall";
}

TEST(TrialTrouble, NoiseIsAboutTheMeanWhereverTheHandRests) {
  Clumsy device([](int words, double t) {
    At at = obeys(words, t);
    if (words == 0 && t > 0.01) at.place.x() += 1e-3;  // a push at the beginning, then rest
    return at;
  });
  const TrialMeasurements seen = tried(device, {.rest_s = 0.5, .longest_s = 0.05});
  EXPECT_LT(seen.noise.x(), 0.5e-3) << "it is a millimetre from where it was first seen";
}

TEST(TrialTrouble, AnAxisBeginsWhereTheHandIsStill) {
  Clumsy device([](int words, double t) {
    At at = obeys(words, std::max(0.0, t - 0.3));
    if (words == 0) at.velocity.z() = 0.2;
    if (words == 1 && t < 0.3) {  // first, fast, to its preferred starting place: near
      at.velocity.z() = 0.2;
      at.place.z() = 0.2 * t;
    } else if (words == 1) {
      at.place.z() = 0.06;
    }
    return at;
  });
  const TrialMeasurements seen = tried(device, {.rest_s = 0.05, .longest_s = 3, .presses = 0});
  EXPECT_TRUE(seen.axes[0].done);
  EXPECT_LT(seen.axes[0].off_deg, 1);
}

// Twice as deep as the largest force allows.
At presses(int words, double t) {
  At at = obeys(words, t);
  if (words == 4 && t > 0.7) {  // slowly: this part counts for the stiffness
    const double round = 2 * M_PI * 0.5 * (t - 0.7);
    at.place.y() = -0.01 * (1 - std::cos(round));
    at.velocity.y() = -0.01 * 2 * M_PI * 0.5 * std::sin(round);
  }
  return at;
}

TEST(TrialTrouble, TheUsersLimitHoldsAndTheStiffnessIsMeasuredBelowIt) {
  Clumsy device(&presses);
  const TrialMeasurements seen = tried(
      device, {.rest_s = 0.05, .below = 5e-3, .stiffness = 300, .most_force = 1, .presses = 1});
  EXPECT_NEAR(seen.deepest, 15e-3, 1e-3);
  EXPECT_NEAR(seen.most_force, 1, 1e-9);
  for (const double force : device.forces()) ASSERT_LE(force, 1 + 1e-9);
  EXPECT_NEAR(seen.stiffness, 300, 15);
}

TEST(TrialTrouble, StoppedInTheWallItLetsGoAndDoesNotDrop) {
  Clumsy device(&presses);
  const auto deep = [&] {
    const std::vector<double> forces = device.forces();
    return !forces.empty() && forces.back() > 0.9;
  };
  const TrialMeasurements seen =
      tried(device,
            {.rest_s = 0.05, .below = 5e-3, .stiffness = 300, .most_force = 1, .presses = 1}, deep);
  EXPECT_TRUE(seen.stopped || !seen.left_out.empty());
  const std::vector<double> forces = device.forces();
  ASSERT_GT(forces.size(), 6U);
  EXPECT_EQ(forces.back(), 0);
  const double last = forces[forces.size() - 6];
  ASSERT_GT(last, 0.5);
  for (int n = 4; n >= 0; --n)
    EXPECT_NEAR(forces[forces.size() - static_cast<std::size_t>(n) - 1], 0.2 * n * last, 1e-12);
}

}  // namespace
}  // namespace burr::app
