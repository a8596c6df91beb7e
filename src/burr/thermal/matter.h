// thermal/matter.h - what the coarse cells of the heat grid consist of, read from the bone.
//
// A cell is a cube of 1, 2, 4 or 8 voxels per edge, aligned so that none crosses two bricks: a
// changed brick can then be read alone. With powers of two there is always a size between half of
// the requested one and all of it. Around the box lies one more layer of cells, for what the box
// borders on.
//
// Bone counts by its volume (volume/volume_of.h). Soft tissue, which no burr cuts, fills its
// voxels: heat flows through a nerve as well as past it. Thread: any one; reads through
// copy_brick() while the servo cuts. Frames: cell ijk; `p_cell` with centres at whole numbers;
// p_grid; world.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/thermal/heat_settings.h"
#include "burr/volume/bone.h"

namespace burr::thermal {

// Where the cells are. Cells from -1 to count, both included, have an entry in the arrays.
struct CellBox {
  int voxels = 1;                  // per edge of a cell
  double edge = 1e-3;              // of a cell                              [m]
  math::Ijk first = {0, 0, 0};     // voxel at the corner of cell (0,0,0)
  math::Ijk count = {0, 0, 0};     // cells
  std::size_t row = 0, slice = 0;  // array distance to the next j and to the next k
  [[nodiscard]] std::size_t size() const { return slice * static_cast<std::size_t>(count.z() + 2); }
  [[nodiscard]] std::size_t at(int i, int j, int k) const {
    return static_cast<std::size_t>(i + 1) + row * static_cast<std::size_t>(j + 1) +
           slice * static_cast<std::size_t>(k + 1);
  }
  [[nodiscard]] std::size_t at(const math::Ijk& c) const { return at(c.x(), c.y(), c.z()); }
  [[nodiscard]] bool contains(const math::Ijk& c) const {
    return (c.array() >= 0).all() && (c.array() < count.array()).all();
  }
  [[nodiscard]] math::Vec3 cell_from_grid(const math::Vec3& p_grid) const {
    return ((p_grid - first.cast<double>()).array() + 0.5) / voxels - 0.5;
  }
  [[nodiscard]] math::Vec3 grid_from_cell(const math::Vec3& p_cell) const {
    return ((p_cell.array() + 0.5) * voxels - 0.5).matrix() + first.cast<double>();
  }
};

// The cells that cover the part of `work` (world, [m]) within the bone's grid.
[[nodiscard]] CellBox cells_around(const volume::Grid& grid, const math::Aabb& work,
                                   double requested_edge);

// Most tissues that a cell stores by name. The smallest ones beyond that count only in its
// conductivity and heat capacity.
inline constexpr int kMostParts = 4;

struct Matter {
  double share = 0;         // of the cell's volume that is not air                [-]
  double conductivity = 0;  // of the cell as a whole: sum of share * k            [W/(m K)]
  double capacity = 0;      // sum of volume * rho c; 0: no matter                 [J/K]
  std::array<volume::TissueId, kMostParts> tissue = {};  // largest first; 0: no more
  std::array<float, kMostParts> part = {};               // share of the cell [-]
};

class MatterReader {
 public:
  MatterReader(const volume::Bone& bone, const CellBox& box, const HeatSettings& settings);

  // A cell that was read again.
  struct Found {
    math::Ijk cell;
    Matter matter;
  };
  // Replaces `found` by all cells of the brick that have an entry. False: the servo was writing the
  // brick.
  [[nodiscard]] bool read(volume::BrickIndex brick, std::vector<Found>& found);

 private:
  [[nodiscard]] Matter matter_of(const math::Ijk& corner) const;

  const volume::Bone& bone_;
  CellBox box_;
  std::array<Material, 256> material_;
  std::array<volume::TissueKind, 256> kind_ = {};
  volume::BrickField field_ = {};                       // of the brick being read
  volume::TissueId tissue_[volume::kBrickVoxels] = {};  // the same
};

}  // namespace burr::thermal
