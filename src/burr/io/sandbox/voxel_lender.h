// io/sandbox/voxel_lender.h - inside a fenced reader the memory of voxels is lent by the process that
// asked for the scan, so that it has them without a copy. A header of this room only.
#pragma once

#include <cstddef>

namespace burr::io {

class VoxelLender {
 public:
  VoxelLender() = default;
  VoxelLender(const VoxelLender&) = delete;
  VoxelLender& operator=(const VoxelLender&) = delete;
  virtual ~VoxelLender() = default;

  // Memory full of zeros, or nullptr.
  [[nodiscard]] virtual void* lend(std::size_t bytes) = 0;
  // False: it was not lent here.
  virtual bool take_back(void* at) = 0;
};

// From now on new_voxels() asks this one. Set once, before anything is read and while there is one
// thread; must outlive all voxels. nullptr: the heap.
void set_voxel_lender(VoxelLender* lender);

}  // namespace burr::io
