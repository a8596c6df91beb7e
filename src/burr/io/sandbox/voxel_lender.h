// io/sandbox/voxel_lender.h - in a fenced reader the memory for voxels comes from the process that
// requested the scan, so that this process gets them without a copy. For use of this room only.
#pragma once

#include <cstddef>

namespace burr::io {

class VoxelLender {
 public:
  VoxelLender() = default;
  VoxelLender(const VoxelLender&) = delete;
  VoxelLender& operator=(const VoxelLender&) = delete;
  virtual ~VoxelLender() = default;

  // Memory filled with zeros, or nullptr.
  [[nodiscard]] virtual void* lend(std::size_t bytes) = 0;
  // False: the memory did not come from here.
  virtual bool take_back(void* at) = 0;
};

// Sets the source of new_voxels(). Call it once, before anything is read, with one thread; the
// lender must outlive all voxels. nullptr: the heap.
void set_voxel_lender(VoxelLender* lender);

}  // namespace burr::io
