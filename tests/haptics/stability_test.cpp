// The simulated axis compared with theory, then the guard on that axis.
#include "burr/haptics/safety/stability.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace burr::haptics {
namespace {

struct Case {
  double mass, b, B;  // of the mass, the device and the wall
};
constexpr std::array<Case, 9> kCases = {{{.045, .5, 0},
                                         {.060, .5, 0},
                                         {.090, .5, 0},
                                         {.045, .5, 1},
                                         {.060, .5, 1},
                                         {.090, .5, 1},
                                         {.045, 1, 2},
                                         {.060, 1, 2},
                                         {.090, 1, 2}}};
constexpr double kTick = 1e-3;

double border(const AxisSettings& axis, double B, double high = 50'000) {
  return stiffness_border(
      axis, [&](double k) { return wall({.stiffness = k, .damping = B}); }, 10, high);
}

// ---- independent theory: the sampled loop as a matrix, stable if its eigenvalues are within one

// State: place, speed, the last reading, filtered speed, force of one tick and of two ticks ago.
bool matrix_is_stable(const AxisSettings& axis, double stiffness, double B) {
  const double T = 1 / axis.rate_hz, m = axis.mass, b = axis.damping;
  const double blend =
      axis.velocity_filter_hz > 0 ? 1 - std::exp(-2 * M_PI * axis.velocity_filter_hz * T) : 1;
  const auto whole = static_cast<int>(axis.delay / T + 1e-9);  // 0 or 1
  const double rest = axis.delay - whole * T;
  using Matrix = Eigen::Matrix<double, 6, 6>;
  // reading: filtered speed and force from the state at the tick
  Eigen::Matrix<double, 1, 6> speed = Eigen::Matrix<double, 1, 6>::Zero();
  speed(0) = blend / T;
  speed(2) = -blend / T;
  speed(3) = 1 - blend;
  Eigen::Matrix<double, 1, 6> force = -B * speed;
  force(0) -= stiffness;
  Eigen::Matrix<double, 1, 6> last = Eigen::Matrix<double, 1, 6>::Zero();
  last(4) = 1;
  Eigen::Matrix<double, 1, 6> before = Eigen::Matrix<double, 1, 6>::Zero();
  before(5) = 1;
  // moves by `time` under the force row, everything as a function of the state at the tick
  Matrix rows = Matrix::Identity();
  const auto move = [&](const Eigen::Matrix<double, 1, 6>& push, double time) {
    const double faded = 1 - std::exp(-b * time / m);
    const Eigen::Matrix<double, 1, 6> x = rows.row(0), v = rows.row(1);
    rows.row(0) = x + v * (m / b) * faded + push * (time / b - m / (b * b) * faded);
    rows.row(1) = v * (1 - faded) + push * (faded / b);
  };
  move(whole == 0 ? last : before, rest);
  move(whole == 0 ? force : last, T - rest);
  rows.row(2) = Matrix::Identity().row(0);
  rows.row(3) = speed;
  rows.row(4) = force;
  rows.row(5) = last;
  // the 2^30th power grows or decays like the largest eigenvalue
  double logarithm = 0;
  for (int n = 0; n < 30; ++n) {
    const double size = rows.norm();
    logarithm = 2 * (logarithm + std::log(size));
    const Matrix once = rows / size;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        rows(i, j) = 0;
        for (int k = 0; k < 6; ++k) rows(i, j) += once(i, k) * once(k, j);
      }
  }
  return logarithm < 0;
}

double matrix_border(const AxisSettings& axis, double B) {
  double low = 1, high = 50'000;
  while (high - low > 1e-4 * low) {
    const double middle = 0.5 * (low + high);
    (matrix_is_stable(axis, middle, B) ? low : high) = middle;
  }
  return low;
}

TEST(Stability, TheBorderIsTwiceTheDampingOverTheTick) {
  for (const Case& c : kCases) {
    const double found = border({.mass = c.mass, .damping = c.b}, c.B);
    const double theory = 2 * (c.b + c.B) / kTick;
    std::printf("m %2.0f g  b %.1f  B %.1f  border %5.0f N/m  2 (b + B) / T %5.0f\n", 1e3 * c.mass,
                c.b, c.B, found, theory);
    EXPECT_NEAR(found, theory, 0.1 * theory) << c.mass;
  }
}

TEST(Stability, TheBorderIsThatOfTheEigenvaluesToHalfAPercent) {
  for (const Case& c : kCases) {
    if (c.mass == .060) continue;  // between the two others
    for (const double filter : {0.0, 100.0}) {
      for (const double delay : {0.0, 0.25e-3, 1.5e-3}) {
        const AxisSettings axis = {
            .mass = c.mass, .damping = c.b, .delay = delay, .velocity_filter_hz = filter};
        const double theory = matrix_border(axis, c.B);
        EXPECT_NEAR(border(axis, c.B), theory, 0.005 * theory)
            << c.mass << " " << c.B << " filter " << filter << " delay " << delay;
      }
    }
  }
}

TEST(Stability, ADelayLowersTheBorderAsPredicted) {
  for (const auto& [b, B] : {std::pair{1.0, 0.0}, std::pair{1.0, 1.0}}) {
    for (const double delay : {0.0, 0.5e-3, 1e-3, 2e-3, 4e-3}) {
      const double found = border({.damping = b, .delay = delay}, B);
      const double theory = (b + B) / (kTick / 2 + delay);
      std::printf("b %.0f  B %.0f  delay %.1f ms  border %4.0f N/m  (b + B) / (T/2 + t_d) %4.0f\n",
                  b, B, 1e3 * delay, found, theory);
      EXPECT_NEAR(found, theory, 0.05 * theory);
    }
  }
}

TEST(Stability, FinerStepsOfTheIntegrationChangeNothing) {
  const double coarse = border({.damping = 0.5}, 1);
  EXPECT_NEAR(border({.damping = 0.5, .substeps = 100}, 1), coarse, 2e-3 * coarse);
  // with an arm, whose spring is not in the closed solution
  const AxisSettings arm = {
      .damping = 0.5, .arm_mass = 0.05, .arm_damping = 2, .arm_stiffness = 200};
  AxisSettings fine = arm;
  fine.substeps = 100;
  const double held = border(arm, 0);
  EXPECT_NEAR(border(fine, 0), held, 2e-3 * held);
  EXPECT_NEAR(held, 2 * 2.5 / kTick, 0.1 * 2 * 2.5 / kTick) << "an arm's damping counts";
}

TEST(Stability, AFreeMassComesToRestWhereTheFormulaSays) {
  const Controller nothing = [](const Sensed&) { return 0.0; };
  // viscous: m v0 / b; dry: m v0^2 / (2 f)
  Swung found = swing({.mass = 0.1, .damping = 2}, nothing, {.start = 0, .speed = -0.1});
  EXPECT_NEAR(found.lowest, -0.1 * 0.1 / 2, 1e-9);
  found =
      swing({.mass = 0.1, .damping = 0, .dry_friction = 0.5}, nothing, {.start = 0, .speed = -0.1});
  EXPECT_NEAR(found.lowest, -0.1 * 0.01 / (2 * 0.5), 1e-8);
  found =
      swing({.mass = 0.1, .damping = 0, .dry_friction = 0.5, .push = 0.4}, nothing, {.start = 0});
  EXPECT_EQ(found.lowest, 0) << "less than the friction moves nothing";
}

TEST(Stability, TheControllerIsToldWholeStepsAndAFilteredSpeed) {
  const Controller listener = [](const Sensed& hand) {
    const double steps = hand.place / 55e-6;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    return 0.0;
  };
  (void)swing({.damping = 0, .encoder_step = 55e-6}, listener, {.start = 0, .speed = 0.1});
  // a step of the speed through a first-order filter of 20 Hz
  double at_10_ms = 0;
  int n = 0;
  const Controller filtered = [&](const Sensed& hand) {
    if (n++ == 10) at_10_ms = hand.velocity;
    return 0.0;
  };
  (void)swing({.damping = 0, .velocity_filter_hz = 20}, filtered, {.start = 0, .speed = 0.1});
  EXPECT_NEAR(at_10_ms, 0.1 * (1 - std::exp(-2 * M_PI * 20 * 10e-3)), 1e-6);
}

// Abbott & Okamura's bound is for passivity: below it no wall may begin to tremble from any small
// motion. How far above it a wall still does not is printed for information.
TEST(Stability, BelowTheBoundOfEncoderAndDryFrictionNothingBeginsToTremble) {
  struct Device {
    const char* name;
    double mass, b, dry, step;
  };
  for (const Device& d : {Device{"Omni, .26 N, .055 mm", .045, .5, .26, 55e-6},
                          Device{"the same, hardly any friction", .045, .5, .02, 55e-6},
                          Device{"fine encoder", .090, 1, .05, 10e-6}}) {
    const double bound = std::min(2 * d.b / kTick, 2 * d.dry / d.step);
    const auto trembles = [&](double k) {
      for (const double push : {0.1, 0.5, 1.0}) {
        for (const double speed : {0.0, -0.01, -0.1}) {
          const AxisSettings axis = {.mass = d.mass,
                                     .damping = d.b,
                                     .dry_friction = d.dry,
                                     .encoder_step = d.step,
                                     .push = push};
          const Swung found = swing(axis, wall({.stiffness = k, .one_sided = true}),
                                    {.start = 1e-5, .speed = speed, .duration = 6});
          if (found.ran_away || found.late > 2 * d.step) return true;
        }
      }
      return false;
    };
    EXPECT_FALSE(trembles(0.95 * bound)) << d.name;
    double first = bound;
    while (first < 50'000 && !trembles(first)) first *= 1.1;
    std::printf("%-30s min(2 b / T, 2 f / step) %5.0f N/m   begins to tremble at %5.0f N/m%s\n",
                d.name, bound, first, first >= 50'000 ? " or more" : "");
  }
}

// ---- the guard

struct Guarded {
  Swung off, on;
  double deficit = 0, damping = 0, written_off = 0;
};

Guarded both(const Case& c, double times, const EnergyGuardSettings& settings, bool one_sided,
             const Swing& how) {
  const AxisSettings axis = {.mass = c.mass, .damping = c.b, .push = one_sided ? 0.5 : 0};
  const WallSettings asked = {
      .stiffness = times * 2 * (c.b + c.B) / kTick, .damping = c.B, .one_sided = one_sided};
  Guarded found;
  found.off = swing(axis, wall(asked), how);
  found.on = swing(axis,
                   guarded_wall(asked, settings,
                                [&](const EnergyGuard& guard) {
                                  found.deficit = guard.deficit();
                                  found.damping = std::max(found.damping, guard.damping());
                                  found.written_off = guard.written_off();
                                }),
                   how);
  return found;
}

// What remains is an oscillation just too slow for the damper: +- least_speed / omega. The bound is
// twice that, plus the move of one tick.
TEST(StabilityWithTheGuard, AWallOfTwiceAndFourTimesTheBorderStaysStillForAMinute) {
  for (const Case& c : kCases) {
    for (const double times : {2.0, 4.0}) {
      for (const bool one_sided : {false, true}) {
        const double stiffness = times * 2 * (c.b + c.B) / kTick;
        const EnergyGuardSettings settings = {.device_mass = c.mass, .largest_force = 1e3};
        const Swing how = {.start = 1e-4, .speed = one_sided ? -0.05 : 0, .duration = 60};
        const Guarded found = both(c, times, settings, one_sided, how);
        const double bound =
            4 * settings.least_speed / std::sqrt(stiffness / c.mass) + settings.least_speed * kTick;
        std::printf(
            "m %2.0f g b %.1f B %.0f k %5.0f %-9s off: %s  on: %4.1f um (bound %4.1f) most damping "
            "%4.1f N s/m\n",
            1e3 * c.mass, c.b, c.B, stiffness, one_sided ? "one side" : "two sides",
            found.off.ran_away ? "runs away"
                               : (std::to_string(1e3 * found.off.late) + " mm").c_str(),
            1e6 * found.on.late, 1e6 * bound, found.damping);
        EXPECT_TRUE(found.off.ran_away || found.off.late > 1e-3) << "else there was nothing to do";
        EXPECT_FALSE(found.on.ran_away);
        EXPECT_LE(found.on.early, bound);
        EXPECT_LE(found.on.late, bound);
        EXPECT_LE(found.damping, 0.5 * c.mass / kTick + 1e-9);
      }
    }
  }
}

// Without the limit least_speed, which is there for encoders, the hand comes fully to rest. A wall
// touched from outside may owe k (v T)^2 / 2 for the one tick in which the hand bounces off, and
// takes it back in the next; otherwise it never gives more than it received.
TEST(StabilityWithTheGuard, NoEnergyComesFromNowhereInAMinute) {
  for (const Case& c : kCases) {
    for (const double times : {2.0, 4.0}) {
      const double stiffness = times * 2 * (c.b + c.B) / kTick;
      const EnergyGuardSettings settings = {
          .device_mass = c.mass, .least_speed = 0, .largest_force = 1e3};
      const Guarded found =
          both(c, times, settings, true, {.start = 0, .speed = -0.01, .duration = 60});
      std::printf("m %2.0f g b %.1f B %.0f k %5.0f  least %6.3f uJ  at the end %7.2f uJ\n",
                  1e3 * c.mass, c.b, c.B, stiffness, 1e6 * found.on.least_work_in,
                  1e6 * found.on.work_in);
      EXPECT_GE(found.on.least_work_in,
                -0.5 * stiffness * std::pow(found.on.top_speed * kTick, 2) - 1e-12);
      if (stiffness <= 4000) {  // the walls that devices offer
        EXPECT_GE(found.on.least_work_in, -1e-6);
      }
      EXPECT_GE(found.on.work_in, 0);
      EXPECT_EQ(found.written_off, 0);
      EXPECT_LT(found.on.late, 1e-8);
    }
  }
}

// The guard's guarantee holds for the continuous motion, with least_speed or without, also for hard
// taps.
TEST(StabilityWithTheGuard, TheRealWorkKeepsTheGuardsPromise) {
  for (const Case& c : kCases) {
    for (const double times : {0.5, 2.0, 4.0}) {
      for (const double speed : {-0.01, -0.1, -0.3}) {
        const AxisSettings axis = {.mass = c.mass, .damping = c.b, .push = 0.5};
        const WallSettings asked = {
            .stiffness = times * 2 * (c.b + c.B) / kTick, .damping = c.B, .one_sided = true};
        double owed = 0;
        const Swung found =
            swing(axis,
                  guarded_wall(asked, {.device_mass = c.mass, .largest_force = 1e3},
                               [&](const EnergyGuard& guard) {
                                 owed = std::max(owed, guard.deficit() + guard.written_off());
                               }),
                  {.start = 1e-4, .speed = speed, .duration = 10});
        EXPECT_GE(found.least_work_in, -owed - 1e-9) << asked.stiffness << " " << speed;
      }
    }
  }
}

TEST(StabilityWithTheGuard, AWallBelowTheBorderIsLeftAloneWhenTheDevicesDampingIsKnown) {
  for (const Case& c : kCases) {
    if (c.B > 0) continue;
    const EnergyGuardSettings settings = {
        .device_mass = c.mass, .device_damping = c.b, .largest_force = 1e3};
    EXPECT_LT(both(c, 0.95, settings, false, {}).damping, 1e-9);
    EXPECT_GT(both(c, 1.2, settings, false, {}).damping, 0.05);
  }
}

// The observer must know the delay: otherwise it counts work with the wrong force.
TEST(StabilityWithTheGuard, ADelayThatItKnowsOfIsPaidFor) {
  for (const double delay : {0.5e-3, 1e-3, 2e-3}) {
    const AxisSettings axis = {.mass = .045, .damping = 1, .delay = delay, .push = 0.5};
    const double at_border = 1 / (kTick / 2 + delay);
    for (const double times : {2.0, 4.0}) {
      const WallSettings asked = {.stiffness = times * at_border, .one_sided = true};
      const Swing how = {.start = 1e-4, .speed = -0.05, .duration = 60};
      const auto guarded = [&](double known) {
        return swing(axis, guarded_wall(asked, {.delay = known, .largest_force = 1e3}), how);
      };
      const Swung knows = guarded(delay), does_not = guarded(0),
                  off = swing(axis, wall(asked), how);
      std::printf("delay %.1f ms k %4.0f  off %8.1f um  guard %8.1f um  that knows it %6.1f um\n",
                  1e3 * delay, asked.stiffness, 1e6 * off.late, 1e6 * does_not.late,
                  1e6 * knows.late);
      const double bound = 4 * 2e-3 / std::sqrt(asked.stiffness / axis.mass) + 2e-3 * kTick;
      EXPECT_LE(knows.late, bound);
      EXPECT_GT(off.late, 1e-3);
    }
  }
}

// ---- the devices, for information: stiffness and damping that public drivers allow, at 1 kHz

TEST(Stability, TableOfDevices) {
  struct Device {
    const char* name;
    double stiffness, damping, resolution, mass;  // mass 0: not known, 0.1 kg is used
  };
  std::printf("%-28s %6s %4s | %10s %18s | %20s\n", "device", "k", "B", "b it needs",
              "border at b = 0.5", "trembles at its k, um");
  for (const Device& d :
       {Device{"PHANToM Omni", 700, 5, 55e-6, 0.045}, Device{"Touch", 400, 5, 55e-6, 0.045},
        Device{"Desktop / Touch X", 1000, 5, 23e-6, 0}, Device{"Premium 1.5", 800, 5, 30e-6, 0},
        Device{"omega.3/6/7", 5000, 30, 10e-6, 0}, Device{"sigma.7", 4000, 30, 1.5e-6, 0},
        Device{"lambda.7", 8000, 30, 1.5e-6, 0}, Device{"delta.3", 5000, 30, 30e-6, 0},
        Device{"Falcon", 3000, 20, 60e-6, 0}, Device{"WoodenHaptics", 1000, 8, 50e-6, 0},
        Device{"burr's own wall, Omni", 1000, 0.5, 55e-6, 0.045}}) {
    AxisSettings axis = {.mass = d.mass > 0 ? d.mass : 0.1, .velocity_filter_hz = 100};
    const double alone = border(axis, 0);  // of a spring without wall damping
    const double found = border(axis, d.damping);
    EXPECT_NEAR(found, matrix_border(axis, d.damping), 0.01 * found) << d.name;
    EXPECT_NEAR(alone, 1000, 100);
    axis.encoder_step = d.resolution;
    axis.dry_friction = d.mass > 0 ? 0.26 : 0.05;
    axis.push = 0.5;
    const WallSettings asked = {.stiffness = d.stiffness, .damping = d.damping, .one_sided = true};
    const Swing how = {.start = 1e-4, .speed = -0.05, .duration = 20};
    const Swung off = swing(axis, wall(asked), how);
    const Swung on = swing(axis,
                           guarded_wall(asked, {.device_mass = axis.mass,
                                                .encoder_step = axis.encoder_step,
                                                .count_force = axis.dry_friction,
                                                .largest_force = 1e3}),
                           how);
    std::printf("%-28s %6.0f %4.1f | %10.2f %6.0f, with B %5.0f | %8.1f, guard %6.1f\n", d.name,
                d.stiffness, d.damping, d.stiffness * kTick / 2, alone, found, 1e6 * off.late,
                1e6 * on.late);
    EXPECT_FALSE(on.ran_away);
  }
}

}  // namespace
}  // namespace burr::haptics
