#include "scenes/thin_shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "burr/math/pose.h"

namespace burr::scenes {
namespace {

using math::Vec3;

enum class Kind : std::uint8_t { ball, plate, rod, shell, ring };

struct Shape {
  Kind kind = Kind::ball;
  Vec3 middle = Vec3::Zero(), size = Vec3::Zero();
  math::Quat turn = math::Quat::Identity();
  // Depth below its surface, negative outside  [voxel]
  [[nodiscard]] double depth(const Vec3& p) const {
    const Vec3 q = turn.conjugate() * (p - middle);
    const double across = std::hypot(q.x(), q.y());
    switch (kind) {
      case Kind::ball:
        return size.x() - q.norm();
      case Kind::plate:
        return (size - q.cwiseAbs()).minCoeff();
      case Kind::rod:
        return std::min(size.x() - across, size.y() - std::abs(q.z()));
      case Kind::shell:
        return size.y() - std::abs(q.norm() - size.x());
      case Kind::ring:
        return size.y() - std::hypot(across - size.x(), q.z());
    }
    return 0;
  }
};

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random_);
  }
  double normal() { return std::normal_distribution<double>()(random_); }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

 private:
  std::mt19937 random_;
};

// thinnest: becomes its thickness where that is less.
Shape draw(Draw& random, double& thinnest) {
  Shape shape;
  shape.kind = static_cast<Kind>(random.below(5));
  for (double& x : shape.middle) x = random.between(12, 28);
  Eigen::Vector4d turn;
  for (double& x : turn) x = random.normal();
  shape.turn = math::Quat(Eigen::Quaterniond(turn.normalized()));
  double thin = random.between(0.3, 3);
  const double wide = random.between(1, 8), long_one = random.between(2, 8);
  switch (shape.kind) {
    case Kind::ball:
      shape.size = Vec3::Constant(random.between(0.5, 6.5));
      thin = 2 * shape.size.x();
      break;
    case Kind::plate:
      shape.size = {wide, long_one, thin / 2};
      break;
    case Kind::rod:
      shape.size = {thin / 2, long_one, 0};
      break;
    case Kind::shell:
    case Kind::ring:
      shape.size = {long_one, thin / 2, 0};
      break;
  }
  thinnest = std::min(thinnest, thin);
  return shape;
}

}  // namespace

ThinShapes thin_shapes(unsigned seed, const Vec3& spacing_mm, double noise) {
  constexpr int kSize = 40;
  constexpr double kSoft = 40, kBone = 1000, kEdge = 1.2;  // [HU], [HU], [voxel]
  Draw random(seed);
  ThinShapes out;
  out.thinnest = kSize;
  std::vector<Shape> shapes(static_cast<std::size_t>(1 + random.below(3)));
  for (Shape& shape : shapes) shape = draw(random, out.thinnest);
  io::Scan& scan = out.scan;
  scan.size = math::Ijk::Constant(kSize);
  scan.spacing_mm = spacing_mm;
  scan.hounsfield = true;
  scan.format = "shapes";
  for (int k = 0; k < kSize; ++k)
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i) {
        double depth = -kSize;
        for (const Shape& shape : shapes) depth = std::max(depth, shape.depth(Vec3(i, j, k)));
        const double share = std::clamp(0.5 + depth / kEdge, 0.0, 1.0);
        const double hu =
            kSoft + share * (kBone - kSoft) + (noise > 0 ? noise * random.normal() : 0);
        scan.values.push_back(static_cast<float>(std::round(hu)));
      }
  return out;
}

}  // namespace burr::scenes
