// apps/burr/window/mill/structure_map.h - where the structures of a bone are: their size, the
// distance from a point, and a voxel to point at.
//
//     StructureMap map(bone, wanted);         // before the session starts
//     if (const auto far = map.distance(id, tip)) ...
//
// Labels do not change while bone is cut, so this is made once. A voxel counts as solid only inside
// the surface. The distance is measured as in volume/distance_to.h: to the nearest voxel's centre,
// less half a voxel. That class answers in constant time which one of many is nearest; this one
// names the distance to each, with a few microseconds for one answer.
// Thread: main, also while the servo cuts. The bone must live as long. Frame: world. Units: m. Memory: 12 bytes for each voxel at the rim of a structure.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "burr/volume/bone.h"

namespace burr::app {

class StructureMap {
 public:
  // wanted: tissues whose distance is asked for; of the others only size and place are kept.
  StructureMap(const volume::Bone& bone, const std::vector<bool>& wanted);

  // number of voxels
  [[nodiscard]] std::size_t voxels(volume::TissueId id) const { return parts_[id].voxels; }
  // The voxel of the structure that is nearest to its middle; the middle may be outside of it.
  [[nodiscard]] std::optional<math::Vec3> place(volume::TissueId id) const;
  // From p; -half a voxel inside. None: no such voxel, or not wanted.
  [[nodiscard]] std::optional<double> distance(volume::TissueId id, const math::Vec3& p) const;

 private:
  struct Bucket {  // of the voxels of one brick
    math::Aabb box;
    std::size_t first = 0, count = 0;
  };
  struct Part {
    std::size_t voxels = 0;
    math::Vec3 sum = math::Vec3::Zero();  // of the voxels' positions, in the grid
    std::vector<Bucket> buckets;
    std::vector<math::Vec3f> rim;              // in the grid  [voxel]
    math::Vec3f middle = math::Vec3f::Zero();  // nearest voxel to the mean position
    float apart = 0;                           // its squared distance to it
  };
  [[nodiscard]] static bool counts(const volume::Bone& bone, int i, int j, int k,
                                   volume::TissueId id);
  void look_at(const volume::Bone& bone, volume::BrickIndex brick, const std::vector<bool>& wanted);
  void find_places(const volume::Bone& bone);

  const volume::Bone& bone_;
  volume::Grid grid_;
  std::array<Part, 256> parts_;
};

}  // namespace burr::app
