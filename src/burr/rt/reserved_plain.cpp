// Where addresses cannot be reserved without memory behind them (a browser): all of it is taken at
// once. rt/reserved.cpp is the one for Linux.
#include <cstdlib>
#include <cstring>
#include <new>

#include "burr/rt/reserved.h"

namespace burr::rt {
namespace {

std::byte* zeroed(std::size_t bytes) {
  void* made = std::aligned_alloc(64, bytes);
  if (made == nullptr) throw std::bad_alloc();
  return static_cast<std::byte*>(std::memset(made, 0, bytes));
}

std::size_t up(std::size_t bytes) { return (bytes + 63) / 64 * 64; }

}  // namespace

ReservedBytes::ReservedBytes(std::size_t bytes) {
  if (bytes == 0) return;
  committed_ = bytes_ = up(bytes);
  data_ = zeroed(bytes_);
}

ReservedBytes::~ReservedBytes() { std::free(data_); }

void ReservedBytes::commit(std::size_t) {}

void ReservedBytes::grow(std::size_t bytes) {
  const std::size_t wanted = up(bytes);
  if (wanted <= bytes_) return;
  std::byte* larger = zeroed(wanted);
  if (data_ != nullptr) std::memcpy(larger, data_, bytes_);
  std::free(data_);
  data_ = larger;
  committed_ = bytes_ = wanted;
}

void ReservedBytes::decommit(std::size_t from) {
  if (from < bytes_) std::memset(data_ + from, 0, bytes_ - from);
}

}  // namespace burr::rt
