// The vibration in the hand, measured: the place of its band, its strength, its limits.
#include "burr/haptics/vibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstring>
#include <limits>
#include <random>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "support/rt_guard.h"

namespace burr::haptics {
namespace {

using math::Vec3;
constexpr double kRateLow = 1000, kRateHigh = 4000;  // [Hz]

Milling cutting(double rpm, double newton) {
  return {.spindle_rad_s = rpm * 2 * M_PI / 60,
          .axis = Vec3::UnitZ(),
          .normal = Vec3::UnitX(),
          .cutting_force = newton};
}

Milling idle(double rpm) {
  Milling now = cutting(rpm, 0);
  now.normal.setZero();
  return now;
}

// Mean power per bin of `length` samples, Hann window.
std::vector<double> spectrum(const std::vector<double>& samples, std::size_t length) {
  Eigen::FFT<double> transform;
  std::vector<double> piece(length), power(length / 2);
  std::vector<std::complex<double>> bins;
  for (std::size_t from = 0; from + length <= samples.size(); from += length) {
    for (std::size_t n = 0; n < length; ++n)
      piece[n] =
          samples[from + n] *
          (0.5 - 0.5 * std::cos(2 * M_PI * static_cast<double>(n) / static_cast<double>(length)));
    transform.fwd(bins, piece);
    for (std::size_t bin = 0; bin < power.size(); ++bin) power[bin] += std::norm(bins[bin]);
  }
  return power;
}

TEST(Vibration, TheBandIsTheRunOutDividedUntilSkinFeelsIt) {
  const auto felt = [](double rpm) { return felt_frequency(rpm / 60); };
  EXPECT_NEAR(felt(12'000), 200, 1e-9);
  EXPECT_NEAR(felt(15'000), 250, 1e-9);
  EXPECT_NEAR(felt(15'060), 125.5, 1e-9);
  EXPECT_NEAR(felt(80'000), 80'000 / 60.0 / 6, 1e-9) << "1333 Hz by 6 is 222 Hz; by 5 it is 267";
  EXPECT_NEAR(felt(1'200), 60, 1e-9) << "held";
  for (double rpm = 3'600; rpm < 400'000; rpm += 7) {
    ASSERT_GE(felt(rpm), 60);
    ASSERT_LE(felt(rpm), 250);
  }
}

TEST(Vibration, MeasuredItIsABandAroundThatFrequencyAndNothingElse) {
  for (const double rate : {kRateLow, kRateHigh}) {
    for (const double rpm : {6'000.0, 12'000.0, 80'000.0}) {
      Vibration buzz;
      const Milling now = cutting(rpm, 1);
      const std::size_t length = rate == kRateLow ? 256 : 1024;  // bins of 3.9 Hz
      const double bin = rate / static_cast<double>(length);
      std::vector<double> samples(length * 1500);
      for (int n = 0; n < 1000; ++n) (void)buzz.step(now, 1 / rate);
      for (double& sample : samples) sample = buzz.step(now, 1 / rate).y();
      const std::vector<double> power = spectrum(samples, length);
      std::size_t peak = 0;
      double inside = 0, all = 0;
      for (std::size_t n = 0; n < power.size(); ++n) {
        if (power[n] > power[peak]) peak = n;
        const double f = bin * static_cast<double>(n);
        all += power[n];
        if (f > buzz.frequency() / 1.5 && f < buzz.frequency() * 1.5) inside += power[n];
      }
      const double f_v = felt_frequency(rpm / 60);
      EXPECT_NEAR(bin * static_cast<double>(peak), f_v, bin) << rate << " Hz, " << rpm;
      for (std::size_t n = 0; n < power.size(); ++n) {
        const double f = bin * static_cast<double>(n);
        if (f < f_v / 2 || f > f_v * 2) {
          ASSERT_LT(power[n], 0.03 * power[peak]) << f << " Hz; " << rate << " Hz, " << rpm;
        }
      }
      EXPECT_LT(power[0], 0.003 * power[peak]) << "a mean would push";
      EXPECT_GT(inside, 0.85 * all);
    }
  }
}

TEST(Vibration, VarianceIsOneMeanIsZeroAndItIsNeverBeyondThree) {
  for (const double rate : {kRateLow, kRateHigh}) {
    for (const double quality : {3.0, 5.0, 8.0}) {
      Vibration buzz({.quality = quality, .seed = 99});
      double sum = 0, squares = 0, largest = 0;
      const int count = static_cast<int>(rate) * 300;
      for (int n = 0; n < count; ++n) {
        (void)buzz.step(cutting(12'000, 1), 1 / rate);
        sum += buzz.noise();
        squares += buzz.noise() * buzz.noise();
        largest = std::max(largest, std::abs(buzz.noise()));
      }
      EXPECT_NEAR(squares / count, 1, 0.05) << rate << " " << quality;
      EXPECT_NEAR(sum / count, 0, 2e-3);
      EXPECT_LE(largest, 3);
      EXPECT_GT(largest, 2.9) << "it is noise, not a tone";
    }
  }
}

TEST(Vibration, AmplitudeFollowsTheCuttingForceUpToItsMost) {
  const auto settled = [](const VibrationSettings& settings, const Milling& now) {
    Vibration buzz(settings);
    for (int n = 0; n < 100; ++n) (void)buzz.step(now, 1e-3);
    return buzz.amplitude();
  };
  EXPECT_NEAR(settled({}, cutting(40'000, 0)), 0.02, 1e-12);
  EXPECT_NEAR(settled({}, cutting(40'000, 1)), 0.10, 1e-12);
  EXPECT_NEAR(settled({}, cutting(40'000, 3.3)), 0.15, 1e-12);
  EXPECT_NEAR(settled({.device_gain = 1.2}, cutting(40'000, 1)), 0.12, 1e-12);
  EXPECT_NEAR(settled({.device_gain = 50}, cutting(40'000, 1)), 0.15, 1e-12) << "whatever the gain";
  EXPECT_NEAR(settled({.most = 9}, cutting(40'000, 100)), 0.15, 1e-12) << "whatever is set";
  EXPECT_NEAR(settled({}, idle(40'000)), 0.01, 1e-12);
  EXPECT_NEAR(settled({.idle = 1, .device_gain = 50}, idle(40'000)), 0.01, 1e-12);
  EXPECT_EQ(settled({}, cutting(0, 1)), 0) << "the spindle stands";
  EXPECT_NEAR(settled({}, cutting(1'800, 1)), 0.05, 1e-12) << "30 Hz of run-out: half";
}

TEST(Vibration, ComesAndGoesByFiftyMillisecondRamps) {
  for (const double rate : {kRateLow, kRateHigh}) {
    Vibration buzz;
    const double step = 0.15 / (50e-3 * rate);
    double last = 0;
    const auto run = [&](const Milling& now, double seconds) {
      for (int n = 0; n < static_cast<int>(std::lround(seconds * rate)); ++n) {
        (void)buzz.step(now, 1 / rate);
        EXPECT_LE(std::abs(buzz.amplitude() - last), step + 1e-12);
        last = buzz.amplitude();
      }
    };
    run(cutting(40'000, 3), 25e-3);
    EXPECT_NEAR(last, 0.075, 1e-9) << "half way";
    run(cutting(40'000, 3), 26e-3);
    EXPECT_NEAR(last, 0.15, 1e-9);
    run(idle(40'000), 47e-3);
    EXPECT_NEAR(last, 0.01, 1e-9);
    run(idle(0), 10e-3);
    EXPECT_EQ(last, 0);
  }
}

TEST(Vibration, NeverMoreThanItsBoundsAndInFreeAirOnlyAHum) {
  constexpr unsigned kSeed = 33;
  SCOPED_TRACE(testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> any(-1, 1);
  Vibration buzz({.device_gain = 3});
  int free = 0;
  Milling now;
  for (int n = 0; n < 500'000; ++n) {
    if (n % 100 == 0) {
      now.spindle_rad_s = 20'000 * any(random);
      now.axis = Vec3(any(random), any(random), any(random)).normalized();
      now.normal = (n / 100) % 3 == 0 ? Vec3(Vec3::Zero())
                                      : Vec3(any(random), any(random), any(random)).normalized();
      now.cutting_force = 10 * any(random);
    }
    if (n % 50'000 == 77) now.normal = now.axis;
    const Vec3 force = buzz.step(now, 1e-3);
    ASSERT_LE(force.norm(), 0.45 + 1e-12);
    free = now.normal.squaredNorm() > 0 ? 0 : free + 1;
    if (free > 50) {
      ASSERT_LE(force.norm(), 0.03 + 1e-12);
    }
  }
}

TEST(Vibration, LiesAcrossTheShaftInTheTangentPlaneAndTurnsThereWithoutAStep) {
  Vibration buzz;
  Milling now = cutting(40'000, 3);
  Vec3 last = Vec3::Zero();
  for (int n = 0; n < 20'000; ++n) {
    if (n % 1000 == 0) {  // a corner: the normal turns by 166 degrees, sometimes into the shaft
      const double angle = 2.9 * (n / 1000);
      now.normal = Vec3(std::cos(angle), std::sin(angle), n % 3000 == 0 ? 0.5 : 0).normalized();
      if (n % 7000 == 0) now.normal = now.axis;
    }
    const Vec3 force = buzz.step(now, 1e-3);
    const double size = buzz.amplitude() * buzz.noise();
    if (std::abs(size) < 1e-3) continue;
    const Vec3 direction = force / size;
    ASSERT_NEAR(direction.norm(), 1, 1e-9);
    if (last != Vec3::Zero()) {
      ASSERT_LE((direction - last).norm(), 0.03) << n;
    }
    last = direction;
    if (n % 1000 > 500) {
      ASSERT_LE(std::abs(direction.dot(now.normal)), 1e-3) << n;
      if (now.normal != now.axis) {
        ASSERT_LE(std::abs(direction.dot(now.axis)), 1e-3) << n;
      }
    }
  }
}

TEST(Vibration, TheSameSeedSaysTheSameBitsAnotherSeedOthersAndNoMemoryIsTaken) {
  const auto run = [](std::uint64_t seed) {
    Vibration buzz({.seed = seed});
    std::vector<Vec3> forces(5000);
    const test::RtGuard guard;
    for (std::size_t n = 0; n < forces.size(); ++n)
      forces[n] = buzz.step(n % 700 < 400 ? cutting(40'000, 1) : idle(38'000), 1e-3);
    EXPECT_EQ(guard.allocations(), 0);
    EXPECT_EQ(guard.locks(), 0);
    return forces;
  };
  const std::vector<Vec3> one = run(5), again = run(5), other = run(6);
  int same = 0;
  for (std::size_t n = 0; n < one.size(); ++n) {
    ASSERT_EQ(std::memcmp(one[n].data(), again[n].data(), 3 * sizeof(double)), 0);
    same += one[n] == other[n];
  }
  EXPECT_LT(same, 10);
}

TEST(Vibration, WhatIsNotANumberAddsNothingAndIsForgotten) {
  const double odd = std::numeric_limits<double>::quiet_NaN();
  for (int which = 0; which < 5; ++which) {
    Vibration buzz;
    for (int n = 0; n < 100; ++n) (void)buzz.step(cutting(40'000, 1), 1e-3);
    Milling now = cutting(40'000, 1);
    double dt = 1e-3;
    if (which == 0) now.spindle_rad_s = odd;
    if (which == 1) now.axis.x() = odd;
    if (which == 2) now.normal.x() = odd;
    if (which == 3) now.cutting_force = odd;
    if (which == 4) dt = odd;
    EXPECT_EQ(buzz.step(now, dt), Vec3::Zero());
    for (int n = 0; n < 100; ++n) ASSERT_TRUE(buzz.step(cutting(40'000, 1), 1e-3).allFinite());
    EXPECT_NEAR(buzz.amplitude(), 0.1, 1e-12);
  }
  Vibration buzz({.base = odd, .per_force = odd, .quality = odd, .ramp = odd, .device_gain = odd});
  for (int n = 0; n < 100; ++n) ASSERT_TRUE(buzz.step(cutting(40'000, 1), 1e-3).allFinite());
}

TEST(Vibration, TellsTheTrueLinesForSound) {
  const Vibration buzz;
  const SpindleLines lines = buzz.lines(cutting(80'000, 1), 8);
  EXPECT_NEAR(lines.run_out_hz, 80'000 / 60.0, 1e-9);
  EXPECT_NEAR(lines.tooth_hz, 8 * 80'000 / 60.0, 1e-9);
  EXPECT_NEAR(lines.run_out, 0.02, 1e-12);
  EXPECT_NEAR(lines.tooth, 0.08, 1e-12);
  EXPECT_EQ(buzz.lines(idle(80'000), 8).tooth, 0) << "the teeth beat on bone only";
  EXPECT_EQ(buzz.lines(cutting(0, 1), 8).run_out, 0);
}

}  // namespace
}  // namespace burr::haptics
