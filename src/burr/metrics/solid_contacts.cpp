#include "burr/metrics/solid_contacts.h"

#include "burr/math/sums.h"

namespace burr::metrics {

SolidContactsMaker::SolidContactsMaker(const volume::DistanceTo& all,
                                       std::span<const volume::TissueId> structure, double voxel)
    : all_(all), voxel_(voxel) {
  for (const volume::TissueId id : structure) wanted_[id] = true;
}

void SolidContactsMaker::add(const Moment& now) {
  if (!now.touching || !now.turning || now.tool.mode != tool::Mode::cut) return;
  if (math::squared_norm(now.normal) < 0.25) return;
  const volume::Nearest near = all_.at(now.centre - now.tool.radius * now.normal);
  if (near.distance <= voxel_ && wanted_[near.tissue]) contacts_.add(now, 0);
}

}  // namespace burr::metrics
