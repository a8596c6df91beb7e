// tests/fit/made_logs.h - force logs with known constants and known noise.
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "burr/fit/force_log.h"

namespace burr::fit::test {

using Random = std::mt19937_64;

struct Truth {
  double mu = 0.37;             // [-]
  double energy = 1.3e9;        // [J/m^3]
  double tc = 140e6, te = 6e3;  // [N/m^2], [N/m]
  double rc = 90e6, re = 4e3;   // [N/m^2], [N/m]
};

// Level 1: random normal force, the rest by the laws, then noise on tangential force [N] and power
// [W].
inline ForceLog level_1(const Truth& truth, std::size_t rows, double noise_n, double noise_w,
                        Random& random) {
  std::uniform_real_distribution<double> push(0.5, 5), speed(1000, 6000);
  std::normal_distribution<double> noise;
  ForceLog log;
  const std::size_t bone = log.material("bone");
  for (std::size_t n = 0; n < rows; ++n) {
    ForceRow row;
    row.time = 0.01 * static_cast<double>(n);
    row.normal = push(random);
    row.speed = speed(random);
    row.radius = 2e-3;
    row.tangential = truth.mu * row.normal;
    row.power = *row.tangential * row.speed * row.radius;
    row.removal = *row.power / truth.energy;
    *row.tangential += noise_n * noise(random);
    *row.power += noise_w * noise(random);
    row.material = bone;
    log.rows.push_back(row);
  }
  return log;
}

// Level 2: random chip area [m^2] and engaged edge [m], forces by the laws.
inline ForceLog level_2(const Truth& truth, std::size_t rows, double noise_n, Random& random) {
  std::uniform_real_distribution<double> chip(1e-9, 2e-8), edge(2e-4, 2e-3), speed(1000, 6000);
  std::normal_distribution<double> noise;
  ForceLog log;
  const std::size_t bone = log.material("bone");
  for (std::size_t n = 0; n < rows; ++n) {
    ForceRow row;
    row.speed = speed(random);
    row.radius = 2e-3;
    const double area = chip(random);
    row.edge = edge(random);
    row.removal = area * row.speed * row.radius;
    row.tangential = truth.tc * area + truth.te * *row.edge + noise_n * noise(random);
    row.normal = truth.rc * area + truth.re * *row.edge + noise_n * noise(random);
    row.material = bone;
    log.rows.push_back(row);
  }
  return log;
}

}  // namespace burr::fit::test

// A random test prints its seed when it fails.
#define BURR_FIT_SEEDED(name, seed)             \
  SCOPED_TRACE("seed " + std::to_string(seed)); \
  ::burr::fit::test::Random name(seed)
