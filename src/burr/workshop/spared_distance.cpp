#include "burr/workshop/spared_distance.h"

#include <cmath>
#include <utility>

#include "burr/base/printable.h"

namespace burr::workshop {

Result<SparedDistance> SparedDistance::make(const volume::Bone& bone, const Tissues& spared,
                                            Progress& progress) {
  auto distance = volume::DistanceTo::make(bone, spared, {}, progress);
  if (!distance) return distance.error();
  SparedDistance made;
  made.distance_ = std::move(*distance);
  made.table_ = bone.tissues();
  return made;
}

SoundTracker::ToSpare SparedDistance::distances() const {
  if (distance_.empty()) return {};
  return [this](const math::Vec3& p) { return distance_.at(p).distance; };
}

std::optional<SparedDistance::Near> SparedDistance::nearest(const math::Vec3& p) const {
  const volume::Nearest nearest = distance_.at(p);
  if (!std::isfinite(nearest.distance)) return std::nullopt;
  return Near{base::printable(table_[nearest.tissue].name, 30), nearest.distance};
}

}  // namespace burr::workshop
