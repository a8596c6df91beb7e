#include "burr/render/chips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

namespace burr::render {

using math::Quat;
using math::Vec3;

namespace {

constexpr double kHop = 2.5e-3;    // how high a chip flies over its way [m]
constexpr double kUnder = 0.5e-3;  // to the side of a chip's middle, surface carries it [m]
constexpr double kAbove = 4e-3;    // over where it comes down, surface is looked for [m]
constexpr Vec3::Scalar kLong = 10, kWide = 4;  // over its thickness
constexpr double kCurl = 1.6;                  // angle over its length [rad]
constexpr int kSteps = 5;                      // facets along it

// 0..1, the same for the same numbers.
double draw(std::uint32_t chip, std::uint32_t which) {
  std::uint32_t x = chip * 0x9E3779B9U ^ (which + 1) * 0x85EBCA6BU;
  x ^= x >> 16;
  x *= 0x7FEB352DU;
  x ^= x >> 15;
  x *= 0x846CA68BU;
  x ^= x >> 16;
  return static_cast<double>(x) / 4294967296.0;
}

Vec3 across(const Vec3& v, const Vec3& up) { return v - v.dot(up) * up; }

// Turned so that z is along `up`.
Quat lying(const Vec3& up, double turn) {
  const Quat upright = Quat::FromTwoVectors(Vec3::UnitZ(), up);
  return upright * Quat(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
}

struct Ground {
  Vec3 p, n;
};
// The highest surface under a place: the vertex nearest to the line along `up`.
std::optional<Ground> ground_under(const Scene& scene, const Vec3& over, const Vec3& up) {
  std::optional<Ground> best;
  double high = -Chips::kDeep, near = kUnder;
  const Vec3 low = over - Chips::kDeep * up - Vec3::Constant(kUnder),
             top = over + kAbove * up + Vec3::Constant(kUnder);
  const math::Aabb column{low.cwiseMin(top), low.cwiseMax(top)};
  for (const ScenePatch& patch : scene.patches) {
    if (patch.mesh == nullptr || (patch.box.lo.array() > column.hi.array()).any() ||
        (patch.box.hi.array() < column.lo.array()).any())
      continue;
    for (const SkinVertex& vertex : patch.mesh->vertices()) {
      const Vec3 w = vertex.p.cast<double>() - over;
      const double h = w.dot(up), aside = (w - h * up).norm();
      if (aside > kUnder || h > kAbove || h < -Chips::kDeep) continue;
      const Vec3 n = normal_of(vertex).cast<double>();
      if (n.dot(up) < 0.2) continue;  // a wall, or the underside
      // a place that is higher hides the others; of one face the nearest vertex counts
      if (h < high - 0.3e-3 || (h < high + 0.3e-3 && best && aside >= near)) continue;
      high = h;
      near = aside;
      best = Ground{over + h * up, n};
    }
  }
  return best;
}

// A curled strip.
void add_mesh(const Chips::Chip& chip, surface::Mesh& mesh) {
  const double radius = chip.size.x() / kCurl, half = 0.5 * chip.size.y();
  const auto corner = [&](int step, double side, double height) {
    const double angle = kCurl * (static_cast<double>(step) / kSteps - 0.5);
    const double r = radius + height;
    // the middle of its back lies at 0
    return Vec3(r * std::sin(angle), side * half * (1 - 0.25 * std::abs(angle)),
                r * std::cos(angle) - radius * std::cos(0.5 * kCurl));
  };
  const auto face = [&](const std::array<Vec3, 4>& corners) {
    const Vec3 n = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalized();
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3& p : corners) {
      surface::Vertex vertex;
      vertex.p = (chip.at + chip.q * p).cast<float>();
      vertex.n = (chip.q * n).cast<float>();
      mesh.vertices.push_back(vertex);
    }
    for (const std::uint32_t c : {0U, 1U, 2U, 0U, 2U, 3U}) mesh.triangles.push_back(first + c);
  };
  const double thick = chip.size.z();
  for (int s = 0; s < kSteps; ++s) {
    face({corner(s, -1, thick), corner(s + 1, -1, thick), corner(s + 1, 1, thick),
          corner(s, 1, thick)});
    face({corner(s, 1, 0), corner(s + 1, 1, 0), corner(s + 1, -1, 0), corner(s, -1, 0)});
    face({corner(s, -1, 0), corner(s + 1, -1, 0), corner(s + 1, -1, thick), corner(s, -1, thick)});
    face({corner(s + 1, 1, 0), corner(s, 1, 0), corner(s, 1, thick), corner(s + 1, 1, thick)});
  }
  face({corner(0, 1, 0), corner(0, -1, 0), corner(0, -1, thick), corner(0, 1, thick)});
  face({corner(kSteps, -1, 0), corner(kSteps, 1, 0), corner(kSteps, 1, thick),
        corner(kSteps, -1, thick)});
}

}  // namespace

void Chips::throw_from(const Edge& edge, double removed) {
  left_ += removed;
  while (true) {
    // no two are alike
    const double volume = kVolume * (0.4 + 1.2 * draw(count_, 0));
    if (left_ < volume) return;
    left_ -= volume;
    Chip chip;
    const double thick = std::cbrt(volume / (kLong * kWide));
    chip.size = {kLong * thick, kWide * thick, thick};
    chip.t = edge.t;
    chip.up = edge.up;
    chip.from = edge.middle + (2 * draw(count_, 1) - 1) * edge.half;
    // ahead of the edge; one that is driven straight down throws to both of its faces
    Vec3 way = across(edge.forward, edge.up);
    if (way.norm() < 0.3) {
      way = edge.half.norm() > 0 ? Vec3(edge.half.cross(edge.up)) : edge.up.unitOrthogonal();
      if (draw(count_, 2) < 0.5) way = -way;
    }
    const Vec3 aside = edge.up.cross(way.normalized());
    chip.over = chip.from + (1.2e-3 + 3e-3 * draw(count_, 3)) * way.normalized() +
                2e-3 * (draw(count_, 4) - 0.5) * aside;
    chip.turn = 2 * M_PI * draw(count_, 5);
    chip.at = chip.from;
    if (chips_.size() == kMost) chips_.erase(chips_.begin());
    chips_.push_back(chip);
    ++count_;
  }
}

void Chips::suck(const Vec3& mouth, double reach) {
  std::erase_if(chips_, [&](const Chip& chip) { return (chip.at - mouth).norm() < reach; });
}

void Chips::rinse(const Vec3& at, double reach, double seconds) {
  for (Chip& chip : chips_)
    if ((chip.at - at).norm() < reach) chip.rinsed += seconds;
  std::erase_if(chips_, [](const Chip& chip) { return chip.rinsed > kRinse; });
}

void Chips::back_to(double t) {
  std::erase_if(chips_, [t](const Chip& chip) { return chip.t > t; });
}

void Chips::lie(Scene& scene, double t) {
  if (chips_.empty()) {
    if (std::exchange(shown_, false)) scene.chips = nullptr;
    return;
  }
  for (Chip& chip : chips_) {
    const double s = std::clamp((t - chip.t) / kFlight, 0.0, 1.0);
    const std::optional<Ground> ground = ground_under(scene, chip.over, chip.up);
    const Vec3 down = ground ? ground->p : Vec3(chip.over - kDeep * chip.up);
    chip.lies = s >= 1 && ground.has_value();
    chip.at = chip.from + s * (down - chip.from) + 4 * s * (1 - s) * kHop * chip.up;
    chip.q = lying(ground && s >= 1 ? ground->n : chip.up, chip.turn);
    // it tumbles once
    if (s < 1) chip.q = chip.q * Quat(Eigen::AngleAxisd(2 * M_PI * s, Vec3::UnitY()));
  }
  std::erase_if(chips_, [t](const Chip& chip) { return t - chip.t >= kFlight && !chip.lies; });
  auto mesh = std::make_shared<surface::Mesh>();
  for (const Chip& chip : chips_) add_mesh(chip, *mesh);
  // the same chips at the same places are not sent again
  const bool same =
      scene.chips != nullptr && scene.chips->vertices.size() == mesh->vertices.size() &&
      std::equal(mesh->vertices.begin(), mesh->vertices.end(), scene.chips->vertices.begin(),
                 [](const surface::Vertex& a, const surface::Vertex& b) { return a.p == b.p; });
  if (!same) scene.chips = std::move(mesh);
  shown_ = true;
}

}  // namespace burr::render
