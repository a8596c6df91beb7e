#include "burr/metrics/solid_contacts.h"

#include "burr/math/sums.h"
#include "burr/metrics/near.h"

namespace burr::metrics {

SolidContactsMaker::SolidContactsMaker(const volume::DistanceTo& all,
                                       std::span<const volume::TissueId> structure, double voxel)
    : all_(all), named_(!structure.empty()), voxel_(voxel) {
  for (const volume::TissueId id : structure) of_structure_[id] = true;
}

void SolidContactsMaker::add(const Moment& now) {
  if (!now.turning || now.tool.mode != tool::Mode::cut) return;
  turned_ = true;
  radius_ = radius_ || now.radius_known();
  if (!now.touching || !now.radius_known()) return;
  if (math::squared_norm(now.normal) < 0.25) return;
  const volume::Nearest near = all_.at(now.centre - now.tool.radius * now.normal);
  if (near.distance <= voxel_ && of_structure_[near.tissue]) contacts_.add(now, 0);
}

Assessed<Contacts> SolidContactsMaker::finish() const {
  if (all_.empty()) return NotAssessable{"there is no solid tissue in this bone"};
  if (!named_) return NotAssessable{kNotInBone};
  if (!turned_) return NotAssessable{"the burr never turned"};
  if (!radius_) return NotAssessable{kNoRadius};
  return contacts_;
}

}  // namespace burr::metrics
