#include "burr/render/drape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace burr::render {

using math::Vec3;
using math::Vec3f;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kAround = 96;       // points of a ring
constexpr double kThick = 7e-3;   // of skin, fat and muscle over the bone [m]
constexpr double kSkin = 13e-3;   // width of the skin that the cloth leaves free [m]
constexpr double kFar = 110e-3;   // radius of the cloth [m]
constexpr double kHead = 120e-3;  // radius of the ball to which the surface bends away [m]

constexpr Colour kMuscle = {0.52F, 0.13F, 0.11F}, kFat = {0.84F, 0.66F, 0.36F},
                 kCut = {0.75F, 0.36F, 0.31F}, kSkinTone = {0.80F, 0.60F, 0.50F},
                 kCloth = {0.16F, 0.36F, 0.40F}, kSteel = {0.62F, 0.64F, 0.66F};

// A number from -1 to 1 that changes smoothly with the angle and differs from `seed` to `seed`.
double waves(double angle, double seed) {
  return 0.5 * std::sin(3 * angle + seed) + 0.3 * std::sin(7 * angle + 2.3 * seed) +
         0.2 * std::sin(17 * angle + 5.1 * seed);
}

Colour mixed(const Colour& a, const Colour& b, double part) {
  const auto p = static_cast<float>(std::clamp(part, 0.0, 1.0));
  return {a[0] + p * (b[0] - a[0]), a[1] + p * (b[1] - a[1]), a[2] + p * (b[2] - a[2])};
}
Colour scaled(const Colour& a, double by) {
  const auto f = static_cast<float>(by);
  return {std::min(1.0F, f * a[0]), std::min(1.0F, f * a[1]), std::min(1.0F, f * a[2])};
}

// The height of the bone around the opening, smooth enough to lay skin over it.
class Ground {
 public:
  Ground(const Opening& opening, const HeightOfBone& height_at) {
    constexpr std::array<double, kRings> kOut = {0, 6e-3, 14e-3, 26e-3};  // from the edge [m]
    for (std::size_t ring = 0; ring < kRings; ++ring) {
      const double r = opening.radius + kOut[ring];
      radii_[ring] = r;
      for (std::size_t n = 0; n < kSteps; ++n) {
        const double a = 2 * kPi * static_cast<double>(n) / kSteps;
        // where there is no bone the surface bends away as a head does
        const double bent = -r * r / (2 * kHead);
        const auto bone = height_at(r * std::cos(a), r * std::sin(a));
        heights_[ring][n] = bone ? std::max(*bone, bent - 4e-3) : bent;
      }
      for (int pass = 0; pass < 3; ++pass) smooth(heights_[ring]);
    }
  }

  [[nodiscard]] double at(double angle, double radius) const {
    std::size_t ring = 0;
    while (ring + 2 < kRings && radius > radii_[ring + 1]) ++ring;
    const double part =
        std::clamp((radius - radii_[ring]) / (radii_[ring + 1] - radii_[ring]), 0.0, 1.0);
    double height = (1 - part) * of(heights_[ring], angle) + part * of(heights_[ring + 1], angle);
    const double last = radii_.back();
    if (radius > last) height += (last * last - radius * radius) / (2 * kHead);
    return height;
  }

 private:
  static constexpr std::size_t kRings = 4, kSteps = 48;
  using Ring = std::array<double, kSteps>;

  // The largest of the neighbours, then their mean: skin spans small hollows.
  static void smooth(Ring& ring) {
    Ring most = ring;
    for (std::size_t n = 0; n < kSteps; ++n)
      most[n] = std::max({ring[n], ring[(n + 1) % kSteps], ring[(n + kSteps - 1) % kSteps]});
    for (std::size_t n = 0; n < kSteps; ++n)
      ring[n] = (2 * most[n] + most[(n + 1) % kSteps] + most[(n + kSteps - 1) % kSteps]) / 4;
  }
  static double of(const Ring& ring, double angle) {
    const double at = (angle / (2 * kPi) - std::floor(angle / (2 * kPi))) * kSteps;
    const auto n = static_cast<std::size_t>(at) % kSteps;
    const double part = at - std::floor(at);
    return (1 - part) * ring[n] + part * ring[(n + 1) % kSteps];
  }

  std::array<double, kRings> radii_ = {};
  std::array<Ring, kRings> heights_ = {};
};

// One ring of the section: how far from the edge of the opening, how high between bone (0) and skin
// (1), and its colour.
struct Ring {
  double out, height;
  Colour colour;
};
// The wall leans outwards and is a little rough; the skin's edge is rounded.
std::vector<Ring> section() {
  return {{2.0e-3, -0.5, kMuscle},
          {0.8e-3, 0.0, kMuscle},
          {0.5e-3, 0.18, mixed(kMuscle, kCut, 0.3)},
          {0.9e-3, 0.34, mixed(kMuscle, kFat, 0.5)},
          {0.9e-3, 0.48, kFat},
          {1.3e-3, 0.68, kFat},
          {1.6e-3, 0.78, mixed(kFat, kCut, 0.7)},
          {1.9e-3, 0.90, kCut},
          {2.6e-3, 0.98, mixed(kCut, kSkinTone, 0.6)},
          {3.8e-3, 1.00, kSkinTone},
          {6e-3, 1.00, kSkinTone},
          {9e-3, 0.98, kSkinTone},
          {kSkin, 0.97, kSkinTone},
          {kSkin + 0.2e-3, 1.14, kCloth},
          {kSkin + 1.5e-3, 1.26, kCloth},
          {kSkin + 4e-3, 1.20, kCloth},
          {kSkin + 10e-3, 1.16, kCloth},
          {kSkin + 20e-3, 1.3, kCloth},
          {kSkin + 34e-3, 1.2, kCloth},
          {kFar, 1.2, kCloth}};
}

class Maker {
 public:
  Maker(const Opening& opening, const HeightOfBone& height_at)
      : axes_(axes_of(opening)), ground_(opening, height_at), height_at_(height_at) {
    drape_.opening = opening;
  }

  Drape made() {
    soft();
    beside_bone();
    drape_.first_steel = drape_.triangles.size();
    for (const double angle : {0.04, kPi - 0.04}) blade(angle);
    for (const Vec3f& p : drape_.points) drape_.box.extend(p.cast<double>());
    return std::move(drape_);
  }

 private:
  [[nodiscard]] Vec3 place(double right, double up, double height) const {
    const Opening& o = drape_.opening;
    return o.centre + right * axes_.right + up * axes_.up + height * o.outward;
  }
  [[nodiscard]] Vec3 on_ring(const Ring& ring, double angle) const {
    const double r = drape_.opening.radius + ring.out;
    double height = ground_.at(angle, r) + kThick * ring.height;
    const bool cloth = ring.colour == kCloth;
    if (cloth) height += 1.4e-3 * waves(2 * angle, 40 * ring.out);  // folds
    if (!cloth && ring.height > 0.1) height += 0.35e-3 * waves(3 * angle, 900 * ring.out);
    // the wall is not a cylinder; it never comes nearer than the radius
    const double wavy = cloth ? r : r + 0.45e-3 * (1 + waves(4 * angle, 700 * ring.out));
    return place(wavy * std::cos(angle), wavy * std::sin(angle), height);
  }

  void soft() {
    const std::vector<Ring> rings = section();
    const auto angle_of = [](int n) { return 2 * kPi * n / kAround; };
    for (std::size_t k = 0; k < rings.size(); ++k)
      for (int n = 0; n < kAround; ++n) {
        const double a = angle_of(n), by = 1e-3;
        const Vec3 around = on_ring(rings[k], a + by) - on_ring(rings[k], a - by);
        const Vec3 out = on_ring(rings[std::min(k + 1, rings.size() - 1)], a) -
                         on_ring(rings[k == 0 ? 0 : k - 1], a);
        drape_.points.push_back(on_ring(rings[k], a).cast<float>());
        drape_.normals.push_back(out.cross(around).normalized().cast<float>());
        const bool fat = rings[k].colour == kFat;
        drape_.colours.push_back(scaled(
            rings[k].colour,
            1 + (fat ? 0.14 : 0.06) * waves(9 * a, 300 * rings[k].out + static_cast<double>(k))));
      }
    const auto index = [](std::size_t k, int n) {
      return static_cast<std::uint16_t>(static_cast<int>(k) * kAround + n % kAround);
    };
    for (std::size_t k = 0; k + 1 < rings.size(); ++k)
      for (int n = 0; n < kAround; ++n)
        for (const std::uint16_t at : {index(k, n), index(k + 1, n), index(k + 1, n + 1),
                                       index(k, n), index(k + 1, n + 1), index(k, n + 1)})
          drape_.triangles.push_back(at);
  }

  // Muscle where the bone ends inside the opening: from the wall to below the edge of the bone. It
  // covers no bone.
  void beside_bone() {
    constexpr double kStep = 1.5e-3, kUnder = 2e-3, kBelow = 5e-3;
    const double radius = drape_.opening.radius, wall = radius + 2e-3;
    constexpr int kRings = 4;
    const auto first = static_cast<int>(drape_.points.size());
    std::array<bool, kAround> beside = {};
    for (int n = 0; n < kAround; ++n) {
      const double a = 2 * kPi * n / kAround, c = std::cos(a), s = std::sin(a);
      double edge = radius;
      std::optional<double> bone = height_at_(edge * c, edge * s);
      while (!bone && edge > kStep) {
        edge -= kStep;
        bone = height_at_(edge * c, edge * s);
      }
      beside[static_cast<std::size_t>(n)] = edge < radius;
      const double from = edge < radius ? edge - kUnder : wall;
      const double foot = ground_.at(a, wall) - 0.5 * kThick, inner = bone.value_or(foot) - kBelow;
      for (int k = 0; k < kRings; ++k) {
        const double part = static_cast<double>(k) / (kRings - 1), r = from + part * (wall - from);
        const double rough = part * (1 - part) * 6e-3 * waves(5 * a, 1 + 3 * k);
        const double height = edge < radius ? inner + part * (foot - inner) + rough : foot;
        drape_.points.push_back(place(r * c, r * s, height).cast<float>());
        const Vec3 n_up = drape_.opening.outward - 0.3 * waves(7 * a, k) * place_side(a) -
                          0.25 * (c * axes_.right + s * axes_.up);
        drape_.normals.push_back(n_up.normalized().cast<float>());
        drape_.colours.push_back(scaled(kMuscle, 0.8 + 0.25 * waves(11 * a, 2 + 5 * k)));
      }
    }
    const auto index = [first](int n, int k) {
      return static_cast<std::uint16_t>(first + (n % kAround) * kRings + k);
    };
    for (int n = 0; n < kAround; ++n) {
      const auto next = static_cast<std::size_t>((n + 1) % kAround);
      if (!beside[static_cast<std::size_t>(n)] && !beside[next]) continue;
      for (int k = 0; k + 1 < kRings; ++k)
        for (const std::uint16_t at : {index(n, k), index(n, k + 1), index(n + 1, k + 1),
                                       index(n, k), index(n + 1, k + 1), index(n + 1, k)})
          drape_.triangles.push_back(at);
    }
  }
  [[nodiscard]] Vec3 place_side(double a) const {
    return std::cos(a) * axes_.up - std::sin(a) * axes_.right;
  }

  void quad(const std::array<Vec3, 4>& corners) {
    const auto first = static_cast<std::uint16_t>(drape_.points.size());
    const Vec3 n = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    for (const Vec3& corner : corners) {
      drape_.points.push_back(corner.cast<float>());
      drape_.normals.push_back(n.cast<float>());
      drape_.colours.push_back(kSteel);
    }
    for (const int at : {0, 1, 2, 0, 2, 3})
      drape_.triangles.push_back(static_cast<std::uint16_t>(first + at));
  }

  // A bent strip of steel, `from` to `to` of its width: the section is a line of (out, height over
  // the bone), kPlate thick.
  void strip(double angle, const std::vector<std::pair<double, double>>& line, double from,
             double to) {
    constexpr double kPlate = 1.1e-3;
    const Vec3 out = std::cos(angle) * axes_.right + std::sin(angle) * axes_.up;
    const Vec3& up = drape_.opening.outward;
    const Vec3 side = up.cross(out);
    const double foot = ground_.at(angle, drape_.opening.radius);
    const auto at = [&](std::size_t n, double across, bool inner) {
      const auto [o, h] = line[n];
      const auto [o0, h0] = line[n == 0 ? 0 : n - 1];
      const auto [o1, h1] = line[std::min(n + 1, line.size() - 1)];
      const Vec3 along = (o1 - o0) * out + (h1 - h0) * up;
      const Vec3 face = along.cross(side).normalized();  // away from the tissue
      return Vec3(drape_.opening.centre + (drape_.opening.radius + o) * out + (foot + h) * up +
                  across * side + (inner ? 0.0 : kPlate) * face);
    };
    for (std::size_t n = 0; n + 1 < line.size(); ++n) {
      quad({at(n, to, false), at(n, from, false), at(n + 1, from, false), at(n + 1, to, false)});
      quad({at(n, from, false), at(n, from, true), at(n + 1, from, true), at(n + 1, from, false)});
      quad({at(n, to, true), at(n, to, false), at(n + 1, to, false), at(n + 1, to, true)});
    }
    const std::size_t last = line.size() - 1;
    quad({at(0, from, false), at(0, to, false), at(0, to, true), at(0, from, true)});
    quad({at(last, to, false), at(last, from, false), at(last, from, true), at(last, to, true)});
  }

  // Three prongs behind the tissue's edge, a plate over the skin, and an arm outwards.
  void blade(double angle) {
    const double top = kThick + 1.2e-3;
    const std::vector<std::pair<double, double>> prong = {
        {1.3e-3, 0.6e-3}, {1.2e-3, 0.6 * top}, {1.7e-3, 0.9 * top}, {3.4e-3, top + 0.5e-3}};
    for (const double middle : {-6.5e-3, 0.0, 6.5e-3})
      strip(angle, prong, middle - 1.5e-3, middle + 1.5e-3);
    strip(angle, {{3.2e-3, top + 0.5e-3}, {8e-3, top + 1.2e-3}, {15e-3, top + 2.6e-3}}, -8.5e-3,
          8.5e-3);
    strip(angle, {{14.8e-3, top + 2.6e-3}, {40e-3, top + 3.6e-3}, {95e-3, top + 1e-3}}, -3.5e-3,
          3.5e-3);
  }

  Drape drape_;
  DrapeAxes axes_;
  Ground ground_;
  const HeightOfBone& height_at_;
};

}  // namespace

DrapeAxes axes_of(const Opening& opening) {
  // as Camera: the patient's head is up; straight from above or below the front is
  Vec3 right = Vec3::UnitZ().cross(opening.outward);
  right = right.norm() > 1e-3 ? Vec3(right.normalized()) : Vec3(Vec3::UnitX());
  return {right, opening.outward.cross(right)};
}

Drape make_drape(const Opening& opening, const HeightOfBone& height_at) {
  return Maker(opening, height_at).made();
}

std::optional<double> hit(const Drape& drape, const Ray& ray) {
  std::optional<double> nearest;
  const auto corner = [&](std::size_t n) {
    return Vec3(drape.points[drape.triangles[n]].cast<double>());
  };
  for (std::size_t t = 0; t + 2 < drape.triangles.size(); t += 3) {
    // Moeller & Trumbore 1997, both faces
    const Vec3 a = corner(t), ab = corner(t + 1) - a, ac = corner(t + 2) - a;
    const Vec3 across = ray.direction.cross(ac);
    const double area = ab.dot(across);
    if (std::abs(area) < 1e-18) continue;
    const Vec3 from = ray.origin - a;
    const double u = from.dot(across) / area;
    if (u < 0 || u > 1) continue;
    const Vec3 over = from.cross(ab);
    const double v = ray.direction.dot(over) / area;
    if (v < 0 || u + v > 1) continue;
    const double distance = ac.dot(over) / area;
    if (distance > 0 && (!nearest || distance < *nearest)) nearest = distance;
  }
  return nearest;
}

}  // namespace burr::render
