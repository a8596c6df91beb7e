// record/mcap/mcap_bytes.h - writes and reads little-endian bytes; reading never goes past the end,
// whatever length a header claims.
//
// Thread: one per object.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace burr::record {

static_assert(std::endian::native == std::endian::little, "files are little-endian, and so are we");

using ByteSpan = std::span<const std::uint8_t>;

inline ByteSpan as_bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
inline std::string_view as_text(ByteSpan bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class T>
concept Plain = std::is_arithmetic_v<T>;

class BytesOut {
 public:
  template <Plain T>
  void put(T value) {
    raw(&value, sizeof value);
  }
  void raw(const void* data, std::size_t size) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }
  void raw(ByteSpan bytes) { raw(bytes.data(), bytes.size()); }
  // MCAP string or byte block: u32 length, then the bytes
  void text(std::string_view text) {
    put(static_cast<std::uint32_t>(text.size()));
    raw(as_bytes(text));
  }
  template <Plain T>
  void put_at(std::size_t offset, T value) {
    std::memcpy(bytes_.data() + offset, &value, sizeof value);
  }
  void clear() { bytes_.clear(); }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  [[nodiscard]] ByteSpan span() const { return bytes_; }
  [[nodiscard]] std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

// After a read past the end ok() is false, and everything read from then on is zero or empty.
class BytesIn {
 public:
  explicit BytesIn(ByteSpan bytes) : left_(bytes) {}

  template <Plain T>
  T get() {
    T value{};
    const ByteSpan from = take(sizeof value);
    if (ok_) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  ByteSpan take(std::uint64_t size) {
    if (!ok_ || size > left_.size()) {
      ok_ = false;
      left_ = {};
      return {};
    }
    const ByteSpan taken = left_.first(static_cast<std::size_t>(size));
    left_ = left_.subspan(static_cast<std::size_t>(size));
    return taken;
  }
  ByteSpan block() { return take(get<std::uint32_t>()); }
  std::string_view text() { return as_text(block()); }

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] bool empty() const { return left_.empty(); }
  [[nodiscard]] std::size_t left() const { return left_.size(); }

 private:
  ByteSpan left_;
  bool ok_ = true;
};

}  // namespace burr::record
