#include "burr/io/voxels.h"

#include <sys/mman.h>

#include "burr/io/sandbox/voxel_lender.h"

namespace burr::io {
namespace {

VoxelLender* the_lender = nullptr;  // see set_voxel_lender

}  // namespace

void set_voxel_lender(VoxelLender* lender) { the_lender = lender; }

void* new_voxels(std::size_t bytes) {
  if (the_lender == nullptr) return ::operator new(bytes);
  void* at = the_lender->lend(bytes);
  if (at == nullptr) throw std::bad_alloc();
  return at;
}

void delete_voxels(void* at, std::size_t /*bytes*/) noexcept {
  if (the_lender == nullptr || !the_lender->take_back(at)) ::operator delete(at);
}

void unmap_voxels(void* at, std::size_t bytes) noexcept { ::munmap(at, bytes); }

}  // namespace burr::io
