#include "burr/proof/right.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "burr/volume/sample.h"

namespace burr::proof {
namespace {

using math::Vec3;

constexpr double kHalfBrick = 3.5 * 1.7321 + 1;  // from its middle to a corner, and a voxel [voxel]

// Calls found(place, depth in the bone before) for the middles of the parts of all voxels, so many along an edge, where
// near(middle of a brick) says that the brick may hold something. Places in mm.
template <class Near, class Found>
void each_part(const volume::Bone& bone, int parts, const Near& near, const Found& found) {
  const int edge = volume::kBrickEdge * parts;
  const volume::Grid& grid = bone.grid();
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const Vec3 first = bone.brick_ijk(brick).cast<double>();
    if (!near(Vec3(grid.world_from_grid(first + Vec3::Constant(3.5)) * 1e3))) continue;
    for (int n = 0; n < edge * edge * edge; ++n) {
      const math::Ijk part(n % edge, n / edge % edge, n / (edge * edge));
      const Vec3 at =
          first + (part.cast<double>() + Vec3::Constant(0.5)) / parts - Vec3::Constant(0.5);
      found(Vec3(grid.world_from_grid(at) * 1e3), volume::sample(bone, at) - volume::kIsoShare);
    }
  }
}

struct Sums {
  double in = 0, of_it = 0;  // [eighths of a voxel]
  [[nodiscard]] double share() const { return in > 0 ? of_it / in : 0; }
};

double reach_mm(const KnownScene& scene) { return kHalfBrick * scene.voxel_mm(); }

// Bone (or, with `air`, what is none) in a region, and how much of it lies where hit(place) is above 0. An eighth that a border
// crosses counts by its depth, as if the border were square to it.
template <class Hit>
Sums sums_in(const KnownScene& scene, const Work& region, bool air, const Hit& hit) {
  Sums sums;
  const double reach = reach_mm(scene), edge = 0.5 * scene.voxel_mm();
  const auto part = [edge](double depth_mm) { return std::clamp(0.5 + depth_mm / edge, 0.0, 1.0); };
  const double mm = 2 * volume::kRamp * scene.voxel_mm() * (air ? -1 : 1);  // of a field's share
  each_part(
      scene.before, 2, [&](const Vec3& middle) { return region.gone(middle) > -reach; },
      [&](const Vec3& p, double depth) {
        const double share = part(depth * mm) * part(region.gone(p));
        if (share <= 0) return;
        sums.in += share;
        sums.of_it += share * part(hit(p));
      });
  return sums;
}

double eighth_mm3(const KnownScene& scene) { return std::pow(0.5 * scene.voxel_mm(), 3); }

// Reads the region once a bone; NaN where it cannot be read.
template <class Then>
RightValue with_region(std::string region, Then then) {
  return [region = std::move(region), then = std::move(then)](const KnownScene& scene) {
    const auto work = read_work(region, scene.places);
    return work ? then(scene, *work) : std::numeric_limits<double>::quiet_NaN();
  };
}

}  // namespace

RightValue share_gone(std::string region) {
  return with_region(std::move(region), [](const KnownScene& scene, const Work& in) {
    return sums_in(scene, in, false, [&](const Vec3& p) { return scene.work.gone(p); }).share();
  });
}

RightValue volume_gone(std::string region) {
  return with_region(std::move(region), [](const KnownScene& scene, const Work& in) {
    const Sums sums = sums_in(scene, in, false, [&](const Vec3& p) { return scene.work.gone(p); });
    return sums.of_it * eighth_mm3(scene);
  });
}

RightValue share_filled(std::string region) {
  return with_region(std::move(region), [](const KnownScene& scene, const Work& in) {
    return sums_in(scene, in, true, [&](const Vec3& p) { return scene.work.grown(p); }).share();
  });
}

RightValue share_beside(std::string region) {
  return with_region(std::move(region), [](const KnownScene& scene, const Work& in) {
    Work added;
    added.cut = scene.work.added;
    return sums_in(scene, added, true, [&](const Vec3& p) { return -in.gone(p); }).share();
  });
}

ApartMm from_tube(std::string landmark, double radius_mm) {
  return [landmark = std::move(landmark), radius_mm](const Places& places, const Vec3& p) {
    const auto found = places.find(landmark);
    if (found == places.end()) return std::numeric_limits<double>::quiet_NaN();
    return -tube(found->second.points, radius_mm)(p);
  };
}

ApartMm from_oval(double y, double half_x, double half_y) {
  constexpr int kCorners = 720;
  auto rim = std::make_shared<std::vector<Vec3>>();
  for (int n = 0; n < kCorners; ++n) {
    const double angle = 2 * M_PI * n / kCorners;
    rim->emplace_back(half_x * std::cos(angle), y + half_y * std::sin(angle), 0);
  }
  return [rim, y, half_x, half_y](const Places&, const Vec3& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& q : *rim) least = std::min(least, (q - p).head<2>().norm());
    const double inside = std::hypot(p.x() / half_x, (p.y() - y) / half_y);
    return inside < 1 ? -least : least;
  };
}

RightValue least_gap(std::string region, ApartMm apart, double far) {
  return with_region(
      std::move(region), [apart = std::move(apart), far](const KnownScene& scene, const Work& in) {
        double least = far;
        const double reach = reach_mm(scene), quarter = 0.25 * scene.voxel_mm();
        each_part(
            scene.before, 4,
            [&](const Vec3& middle) {
              return std::abs(scene.work.gone(middle)) < reach && in.gone(middle) > -reach;
            },
            [&](const Vec3& p, double depth) {
              const double gone = scene.work.gone(p);
              if (depth < 0 || std::abs(gone) > quarter || in.gone(p) < 0) return;
              least = std::min(least, apart(scene.places, p) - gone);  // to the border itself
            });
        return least;
      });
}

RightValue median_above(std::string region, double floor_z, double less) {
  return with_region(std::move(region), [floor_z, less](const KnownScene& scene, const Work& in) {
    // by columns of the lattice along z: the highest place of bone
    const volume::Grid& grid = scene.before.grid();
    const Vec3 size = grid.size.cast<double>();
    std::vector<double> heights;
    for (int n = 0; n < 2 * grid.size.x(); ++n)
      for (int m = 0; m < 2 * grid.size.y(); ++m) {
        const Vec3 foot = grid.world_from_grid({0.5 * n, 0.5 * m, 0}) * 1e3;
        if (in.gone({foot.x(), foot.y(), floor_z + 0.1}) < 0) continue;
        for (double k = size.z(); k >= 0; k -= 0.1)
          if (volume::sample(scene.before, Vec3(0.5 * n, 0.5 * m, k)) >= volume::kIsoShare) {
            heights.push_back(grid.world_from_grid({0.5 * n, 0.5 * m, k}).z() * 1e3 - floor_z);
            break;
          }
      }
    if (heights.empty()) return less;
    std::sort(heights.begin(), heights.end());
    return std::abs(heights[heights.size() / 2] - less);
  });
}

}  // namespace burr::proof
