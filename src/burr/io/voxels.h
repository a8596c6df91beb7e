// io/voxels.h - an array with one number a voxel: a std::vector that can also take over memory
// which another process has filled.
//
// Scans are read in a separate process (read_scan.h). The result is not copied: the vector owns
// that memory from then on, and returns to the system at once what it no longer needs. In all else
// it is a std::vector.
// Thread: as for std::vector.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

namespace burr::io {

// Allocates memory for voxels: from the heap, or in a fenced reader from its lender. Throws
// std::bad_alloc.
[[nodiscard]] void* new_voxels(std::size_t bytes);
void delete_voxels(void* at, std::size_t bytes) noexcept;
// Returns a mapping to the system.
void unmap_voxels(void* at, std::size_t bytes) noexcept;

template <class T>
class VoxelMemory {
 public:
  // NOLINTBEGIN(readability-identifier-naming): names of the standard library
  using value_type = T;
  using is_always_equal = std::false_type;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;
  // NOLINTEND(readability-identifier-naming)

  VoxelMemory() = default;
  // Takes over a mapping of `bytes` with its content; the first allocation gets it.
  VoxelMemory(void* mapped, std::size_t bytes) : mapped_(mapped), bytes_(bytes) {}
  template <class U>
  VoxelMemory(const VoxelMemory<U>& /*other*/) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] T* allocate(std::size_t n) {
    filled_ = mapped_ != nullptr && !taken_;
    if (!filled_) return static_cast<T*>(new_voxels(n * sizeof(T)));
    if (n * sizeof(T) > bytes_) throw std::bad_alloc();
    taken_ = true;
    return static_cast<T*>(mapped_);
  }
  void deallocate(T* at, std::size_t n) noexcept {
    if (at == mapped_)
      unmap_voxels(mapped_, bytes_);
    else
      delete_voxels(at, n * sizeof(T));
  }
  // The content of a mapping stays; elsewhere a voxel begins as 0.
  template <class U>
  void construct(U* at) {
    if (!filled_) ::new (static_cast<void*>(at)) U();
  }
  [[nodiscard]] VoxelMemory select_on_container_copy_construction() const { return {}; }

  friend bool operator==(const VoxelMemory& a, const VoxelMemory& b) {
    return a.mapped_ == b.mapped_;
  }

 private:
  void* mapped_ = nullptr;
  std::size_t bytes_ = 0;
  bool taken_ = false;   // the mapping has been given away
  bool filled_ = false;  // ... and is the vector's present memory
};

template <class T>
using Voxels = std::vector<T, VoxelMemory<T>>;

// An array of the n voxels that lie in a mapping. n > 0, and the mapping is large enough.
template <class T>
[[nodiscard]] Voxels<T> voxels_in(void* mapped, std::size_t bytes, std::size_t n) {
  Voxels<T> voxels(VoxelMemory<T>(mapped, bytes));
  voxels.resize(n);
  return voxels;
}

}  // namespace burr::io
