#include "burr/metrics/cover.h"

#include <algorithm>
#include <atomic>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/metrics/look_directions.h"
#include "burr/metrics/solidity.h"
#include "burr/rt/thread.h"

namespace burr::metrics {
namespace {

using math::Vec3;
using volume::Bone;

constexpr double kOpenBone = 0.2e-3, kOpenReach = 3e-3;  // [m]
constexpr double kAcross = 0.5;  // cosine of a look to the normal that says how thick a layer is

struct Job {
  const Solidity& solidity;
  std::vector<Vec3> looks;  // world
  RaySettings ray;
  double least_removed;  // [m]
};

struct Seen {
  CoverSample sample;
  bool open = true;
};

struct Plate {
  double before = 0, after = 0;  // [m]
};

// The first layer of bone along the normal before the cut, and what stands of it as far as the cut.
Plate plate_along(const Solidity& solidity, const Vec3& from, const Vec3& n, double cap) {
  const double h = solidity.grid().voxel;
  constexpr double kStep = 0.25;  // [voxel]
  Plate met;
  bool within = false, cut = false;
  for (double l = -1; l * h < cap; l += kStep) {
    const Solidity::Pair sigma = solidity.at(from + l * n);
    if (sigma.before < 0.5 && within) break;
    within = within || sigma.before >= 0.5;
    met.before += kStep * sigma.before;
    cut = cut || (sigma.before >= 0.5 && sigma.after < 0.5);
    if (!cut) met.after += kStep * sigma.after;
  }
  if (!within) return {};
  return {std::min(met.before * h, cap), met.after * h};
}

Seen look_at(const Job& job, const SurfaceSample& surface) {
  const auto to_grid = job.solidity.grid().frame.q.conjugate();
  const Vec3 from = surface.voxel.cast<double>(), n = to_grid * surface.normal;
  Seen seen;
  seen.sample.surface = surface;
  double least_across = kUnseen;  // [m]
  for (const Vec3& look : job.looks) {
    const Met met = walk(job.solidity, from, to_grid * look, n, job.ray);
    if (met.near >= kOpenBone) seen.open = false;
    if (!met.opened || met.removed < job.least_removed || met.bone > job.ray.most_bone) continue;
    // a look that leaves aslant or through the structure itself crosses the layer at another place
    if (math::dot(n, to_grid * look) >= kAcross && met.bone < least_across) {
      least_across = met.bone;
      seen.sample.thickness = met.across;
    }
    if (met.bone >= seen.sample.cover) continue;
    seen.sample.cover = met.bone;
    seen.sample.look = look;
  }
  const Plate plate = plate_along(job.solidity, from, n, job.ray.most_bone);
  seen.sample.plate_before = plate.before;
  seen.sample.plate_after = plate.after;
  return seen;
}

std::vector<Seen> look_at_all(const Job& job, const std::vector<SurfaceSample>& samples,
                              int threads) {
  std::vector<Seen> seen(samples.size());
  std::atomic<std::size_t> next{0};
  rt::on_threads(std::max(1, threads), [&](int) {
    for (std::size_t n = next++; n < samples.size(); n = next++) seen[n] = look_at(job, samples[n]);
  });
  return seen;
}

// A solid structure's border is known only from its labels.
bool is_solid(const Bone& bone, const VoxelSet& structure) {
  std::size_t solid = 0;
  structure.for_each([&](const math::Ijk& v) {
    solid += bone.field(v.x(), v.y(), v.z()) >= volume::kIso ? 1 : 0;
  });
  return 2 * solid > structure.count();
}

}  // namespace

Assessed<Cover> cover_of(const Bone& before, const Bone& after, const VoxelSet& structure,
                         const Region& region, const CoverSettings& settings) {
  BURR_CHECK(!settings.towards.empty());
  const auto patch =
      patch_of(before.grid(), structure, region, {settings.towards, settings.most_samples});
  if (!patch) return NotAssessable{patch.reason()};
  const double h = before.grid().voxel;
  const Solidity solidity(before, after, &structure, settings.glass);
  const Job job{solidity,
                cones_about(settings.towards),
                {settings.cap, kOpenReach, settings.exposed},
                std::max(settings.least_removed, 2 * h)};
  const std::vector<Seen> seen = look_at_all(job, patch->samples, settings.threads);

  Cover cover;
  cover.thinned = patch->thinned;
  cover.voxel = h;
  cover.error = is_solid(before, structure) ? std::max(0.05e-3, h) : std::max(0.05e-3, 0.2 * h);
  double open = 0;
  for (const Seen& one : seen) {
    (one.open ? open : cover.weight) += one.sample.surface.faces;
    if (!one.open) cover.samples.push_back(one.sample);
  }
  cover.open_share = open / (open + cover.weight);
  if (cover.open_share > 0.5)
    return NotAssessable{
        "open from the start: less than 0.2 mm of bone lay over most of this part "
        "of the structure before the first cut"};
  if (cover.samples.size() < kFewestSamples)
    return NotAssessable{"too few samples of the structure were covered by bone at the start"};
  return cover;
}

}  // namespace burr::metrics
