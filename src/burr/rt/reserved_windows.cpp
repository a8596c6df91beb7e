// rt/reserved.h on Windows. Memory for all addresses is promised at the start, which takes room in the page file and no
// memory; a page comes with its first use, or before with commit(). rt/reserved.cpp is the one for Linux.
#include "burr/rt/reserved.h"

#include <windows.h>

#include <algorithm>
#include <cstring>
#include <new>

namespace burr::rt {
namespace {

// Pages are taken in pieces of this size: large enough to be rare, small enough to waste little.
constexpr std::size_t kStep = 256 * 1024;

std::size_t up(std::size_t bytes, std::size_t to) { return (bytes + to - 1) / to * to; }

std::size_t page() {
  static const std::size_t size = [] {
    SYSTEM_INFO info = {};
    GetSystemInfo(&info);
    return std::size_t{info.dwPageSize};
  }();
  return size;
}

std::byte* addresses(std::size_t bytes) {
  void* made = VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
  if (made == nullptr) throw std::bad_alloc();
  return static_cast<std::byte*>(made);
}

void give_back(std::byte* data) {
  if (data != nullptr) VirtualFree(data, 0, MEM_RELEASE);
}

// Takes the pages of [from, to). Changes no bit, and in one step, because another thread may write there meanwhile.
void take(std::byte* from, std::byte* to) {
  for (; from < to; from += page())
    __atomic_fetch_or(reinterpret_cast<volatile unsigned char*>(from),
                      static_cast<unsigned char>(0), __ATOMIC_RELAXED);
}

// Copies what is not zero, so that pages which nobody has used take no memory there either.
void copy_used(const std::byte* from, std::size_t bytes, std::byte* to) {
  const auto nothing = [](const std::byte* at, std::size_t size) {
    return std::all_of(at, at + size, [](std::byte one) { return one == std::byte{0}; });
  };
  for (std::size_t at = 0; at < bytes; at += page()) {
    const std::size_t size = std::min(page(), bytes - at);
    if (!nothing(from + at, size)) std::memcpy(to + at, from + at, size);
  }
}

}  // namespace

ReservedBytes::ReservedBytes(std::size_t bytes) {
  if (bytes == 0) return;
  bytes_ = up(bytes, page());
  data_ = addresses(bytes_);
}

ReservedBytes::~ReservedBytes() { give_back(data_); }

void ReservedBytes::commit(std::size_t bytes) {
  const std::size_t wanted = std::min(up(bytes, kStep), bytes_);
  if (wanted <= committed_) return;
  take(data_ + committed_, data_ + wanted);
  committed_ = wanted;
}

void ReservedBytes::grow(std::size_t bytes) {
  const std::size_t wanted = up(bytes, page());
  if (wanted <= bytes_) return;
  std::byte* larger = addresses(wanted);
  if (data_ != nullptr) copy_used(data_, bytes_, larger);
  take(larger, larger + committed_);
  give_back(data_);
  data_ = larger;
  bytes_ = wanted;
}

void ReservedBytes::decommit(std::size_t from) {
  if (from >= bytes_) return;
  const std::size_t whole = up(from, page());
  std::memset(data_ + from, 0, std::min(whole, bytes_) - from);
  if (whole >= bytes_) return;
  std::byte* rest = data_ + whole;
  const std::size_t size = bytes_ - whole;
  if (VirtualFree(rest, size, MEM_DECOMMIT) == 0) {
    std::memset(rest, 0, size);
    return;
  }
  committed_ = std::min(committed_, whole);
  if (VirtualAlloc(rest, size, MEM_COMMIT, PAGE_READWRITE) == nullptr) throw std::bad_alloc();
}

}  // namespace burr::rt
