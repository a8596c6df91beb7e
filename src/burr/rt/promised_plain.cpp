// Where addresses cannot be promised without memory behind them (a browser): all of it is taken at
// once. rt/promised.cpp is the one for Linux.
#include <cstdlib>
#include <cstring>
#include <new>

#include "burr/rt/promised.h"

namespace burr::rt {
namespace {

std::byte* zeroed(std::size_t bytes) {
  void* made = std::aligned_alloc(64, bytes);
  if (made == nullptr) throw std::bad_alloc();
  return static_cast<std::byte*>(std::memset(made, 0, bytes));
}

std::size_t up(std::size_t bytes) { return (bytes + 63) / 64 * 64; }

}  // namespace

PromisedBytes::PromisedBytes(std::size_t bytes) {
  if (bytes == 0) return;
  had_ = bytes_ = up(bytes);
  data_ = zeroed(bytes_);
}

PromisedBytes::~PromisedBytes() { std::free(data_); }

void PromisedBytes::have(std::size_t) {}

void PromisedBytes::grow(std::size_t bytes) {
  const std::size_t wanted = up(bytes);
  if (wanted <= bytes_) return;
  std::byte* larger = zeroed(wanted);
  if (data_ != nullptr) std::memcpy(larger, data_, bytes_);
  std::free(data_);
  data_ = larger;
  had_ = bytes_ = wanted;
}

void PromisedBytes::give_back(std::size_t from) {
  if (from < bytes_) std::memset(data_ + from, 0, bytes_ - from);
}

}  // namespace burr::rt
