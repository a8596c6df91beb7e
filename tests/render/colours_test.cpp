// Structures can be told from bone and from each other, also by eyes without red or green cones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "burr/phantom/phantoms.h"

namespace burr {
namespace {

using Three = std::array<double, 3>;
using Matrix = std::array<Three, 3>;

// What an eye sees, in linear RGB: Machado, Oliveira & Fernandes 2009, severity 1.
constexpr Matrix kUsual = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
constexpr Matrix kProtan = {{{0.152286, 1.052583, -0.204868},
                             {0.114503, 0.786281, 0.099216},
                             {-0.003882, -0.048116, 1.051998}}};
constexpr Matrix kDeutan = {{{0.367322, 0.860646, -0.227968},
                             {0.280085, 0.672501, 0.047413},
                             {-0.011820, 0.042940, 0.968881}}};

// CIE L*a*b* under D65 (CIE 15:2004, 8.2.1) of an sRGB colour as that eye sees it
Three lab_of(const std::array<float, 3>& colour, const Matrix& eye) {
  Three linear{}, seen{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto v = static_cast<double>(colour[c]);
    linear[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
  }
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) seen[r] += eye[r][c] * linear[c];
    seen[r] = std::clamp(seen[r], 0.0, 1.0);
  }
  const auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  const double x = f((0.4124 * seen[0] + 0.3576 * seen[1] + 0.1805 * seen[2]) / 0.9505),
               y = f(0.2126 * seen[0] + 0.7152 * seen[1] + 0.0722 * seen[2]),
               z = f((0.0193 * seen[0] + 0.1192 * seen[1] + 0.9505 * seen[2]) / 1.089);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

// CIEDE2000 (CIE 142-2001; formulas as in Sharma, Wu & Dalal 2005)
double difference(const Three& one, const Three& two) {
  constexpr double kDegree = std::numbers::pi / 180;
  const double mean_c = 0.5 * (std::hypot(one[1], one[2]) + std::hypot(two[1], two[2]));
  const double high = std::pow(mean_c, 7),
               g = 0.5 * (1 - std::sqrt(high / (high + std::pow(25, 7))));
  const double a1 = (1 + g) * one[1], a2 = (1 + g) * two[1];
  const double c1 = std::hypot(a1, one[2]), c2 = std::hypot(a2, two[2]);
  const auto hue = [](double a, double b) {
    const double h = std::atan2(b, a) / kDegree;
    return h < 0 ? h + 360 : h;
  };
  const double h1 = hue(a1, one[2]), h2 = hue(a2, two[2]);
  double turn = c1 * c2 > 0 ? h2 - h1 : 0;
  if (turn > 180) turn -= 360;
  if (turn < -180) turn += 360;
  double h = h1 + h2;
  if (c1 * c2 > 0) h = std::abs(h1 - h2) <= 180 ? 0.5 * h : 0.5 * (h < 360 ? h + 360 : h - 360);
  const double dl = two[0] - one[0], dc = c2 - c1,
               dh = 2 * std::sqrt(c1 * c2) * std::sin(0.5 * turn * kDegree);
  const double l = 0.5 * (one[0] + two[0]), c = 0.5 * (c1 + c2);
  const auto cosine = [](double degrees) { return std::cos(degrees * kDegree); };
  const double t = 1 - 0.17 * cosine(h - 30) + 0.24 * cosine(2 * h) + 0.32 * cosine(3 * h + 6) -
                   0.20 * cosine(4 * h - 63);
  const double sl = 1 + 0.015 * std::pow(l - 50, 2) / std::sqrt(20 + std::pow(l - 50, 2)),
               sc = 1 + 0.045 * c, sh = 1 + 0.015 * c * t;
  const double seven = std::pow(c, 7),
               rt = -2 * std::sqrt(seven / (seven + std::pow(25, 7))) *
                    std::sin(60 * kDegree * std::exp(-std::pow((h - 275) / 25, 2)));
  return std::sqrt(std::pow(dl / sl, 2) + std::pow(dc / sc, 2) + std::pow(dh / sh, 2) +
                   rt * dc / sc * dh / sh);
}

TEST(Colours, TheDifferenceIsThatOfThePublishedPairs) {
  // Sharma, Wu & Dalal 2005, table 1, pairs 1, 7 and 25
  EXPECT_NEAR(difference({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
  EXPECT_NEAR(difference({50, 0, 0}, {50, -1, 2}), 2.3669, 1e-4);
  EXPECT_NEAR(difference({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}), 1.2644, 1e-4);
}

TEST(Colours, StructuresDifferFromBoneAndFromEachOtherForEveryEye) {
  constexpr double kFromBone = 10, kFromEachOther = 8;
  for (const phantom::Phantom& phantom :
       {phantom::temporal_bone(1e-3), phantom::jaw(1e-3), phantom::spine(1e-3)}) {
    std::vector<const volume::Tissue*> soft;
    for (const volume::Tissue& tissue : phantom.tissues.tissues)
      if (tissue.kind == volume::TissueKind::soft) soft.push_back(&tissue);
    const auto& bone = phantom.tissues.tissues[1].colour;
    for (const Matrix& eye : {kUsual, kProtan, kDeutan}) {
      const char* which = eye == kUsual ? "usual" : eye == kProtan ? "protan" : "deutan";
      for (const volume::Tissue* one : soft) {
        const double from_bone = difference(lab_of(one->colour, eye), lab_of(bone, eye));
        EXPECT_GT(from_bone, kFromBone) << one->name << ", " << which;
        std::string nearest;
        double least = 1e9;
        for (const volume::Tissue* other : soft) {
          if (other == one) continue;
          const double d = difference(lab_of(one->colour, eye), lab_of(other->colour, eye));
          EXPECT_GT(d, kFromEachOther) << one->name << " and " << other->name << ", " << which;
          if (d < least) nearest = other->name;
          least = std::min(least, d);
        }
        std::printf("%-28s %-7s from bone %5.1f, nearest %5.1f %s\n", one->name.c_str(), which,
                    from_bone, least, nearest.c_str());
      }
    }
  }
}

}  // namespace
}  // namespace burr
