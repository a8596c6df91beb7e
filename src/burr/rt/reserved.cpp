#include "burr/rt/reserved.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace burr::rt {
namespace {

#ifndef MADV_POPULATE_WRITE
constexpr int kPopulateWrite = 23;  // MADV_POPULATE_WRITE of newer headers
#else
constexpr int kPopulateWrite = MADV_POPULATE_WRITE;
#endif
// Pages are taken in pieces of this size: large enough to be rare, small enough to waste little.
constexpr std::size_t kStep = 256 * 1024;

std::size_t up(std::size_t bytes, std::size_t to) { return (bytes + to - 1) / to * to; }

std::size_t page() {
  static const auto size = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return size;
}

std::byte* addresses(std::size_t bytes) {
  void* made = mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (made == MAP_FAILED) throw std::bad_alloc();
  return static_cast<std::byte*>(made);
}

bool kernel_can() {
  static const bool can = [] {
    std::byte* one = addresses(page());
    const bool taken = madvise(one, page(), kPopulateWrite) == 0;
    munmap(one, page());
    return taken;
  }();
  return can;
}

}  // namespace

ReservedBytes::ReservedBytes(std::size_t bytes) {
  if (bytes == 0) return;
  bytes_ = up(bytes, page());
  data_ = addresses(bytes_);
  if (!kernel_can()) {
    std::memset(data_, 0, bytes_);
    committed_ = bytes_;
  }
}

ReservedBytes::~ReservedBytes() {
  if (data_ != nullptr) munmap(data_, bytes_);
}

void ReservedBytes::commit(std::size_t bytes) {
  const std::size_t wanted = std::min(up(bytes, kStep), bytes_);
  if (wanted <= committed_) return;
  // if there is no memory left this does nothing, and the first use decides
  if (madvise(data_ + committed_, wanted - committed_, kPopulateWrite) == 0) committed_ = wanted;
}

void ReservedBytes::grow(std::size_t bytes) {
  const std::size_t wanted = up(bytes, page());
  if (wanted <= bytes_) return;
  if (data_ == nullptr) {
    data_ = addresses(wanted);
  } else {
    void* moved = mremap(data_, bytes_, wanted, MREMAP_MAYMOVE);
    if (moved == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<std::byte*>(moved);
  }
  if (!kernel_can()) {
    std::memset(data_ + bytes_, 0, wanted - bytes_);
    committed_ = wanted;
  }
  bytes_ = wanted;
}

void ReservedBytes::decommit(std::size_t from) {
  if (from >= bytes_) return;
  const std::size_t whole = up(from, page());
  std::memset(data_ + from, 0, std::min(whole, bytes_) - from);
  if (whole >= bytes_) return;
  // locked memory (mlockall, a real-time session in this process) is not given back
  if (kernel_can() && madvise(data_ + whole, bytes_ - whole, MADV_DONTNEED) == 0) {
    committed_ = std::min(committed_, whole);
  } else {
    std::memset(data_ + whole, 0, bytes_ - whole);
  }
}

}  // namespace burr::rt
