#include "burr/school/uuid.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <random>
#include <vector>

#include "burr/base/printable.h"

namespace burr::school {
namespace {

std::string digits(const std::uint8_t* bytes, std::size_t count) {
  std::string text;
  for (std::size_t n = 0; n < count; ++n) text += fmt::format("{:02x}", bytes[n]);
  return text;
}

std::string uuid_text(std::array<std::uint8_t, 16> bytes, unsigned version) {
  bytes[6] = static_cast<std::uint8_t>((bytes[6] & 0x0FU) | (version << 4U));
  bytes[8] = static_cast<std::uint8_t>((bytes[8] & 0x3FU) | 0x80U);
  const std::string all = digits(bytes.data(), bytes.size());
  return fmt::format("{}-{}-{}-{}-{}", all.substr(0, 8), all.substr(8, 4), all.substr(12, 4),
                     all.substr(16, 4), all.substr(20));
}

}  // namespace

void Sha1::block(const std::uint8_t* bytes) {
  std::array<std::uint32_t, 80> w{};
  for (std::size_t n = 0; n < 16; ++n)
    w[n] = static_cast<std::uint32_t>(bytes[4 * n]) << 24U |
           static_cast<std::uint32_t>(bytes[4 * n + 1]) << 16U |
           static_cast<std::uint32_t>(bytes[4 * n + 2]) << 8U | bytes[4 * n + 3];
  for (std::size_t n = 16; n < 80; ++n)
    w[n] = std::rotl(w[n - 3] ^ w[n - 8] ^ w[n - 14] ^ w[n - 16], 1);
  auto [a, b, c, d, e] = state_;
  for (std::size_t n = 0; n < 80; ++n) {
    std::uint32_t f = 0, k = 0;
    if (n < 20) {
      f = (b & c) | (~b & d);
      k = 0x5A827999;
    } else if (n < 40) {
      f = b ^ c ^ d;
      k = 0x6ED9EBA1;
    } else if (n < 60) {
      f = (b & c) | (b & d) | (c & d);
      k = 0x8F1BBCDC;
    } else {
      f = b ^ c ^ d;
      k = 0xCA62C1D6;
    }
    const std::uint32_t next = std::rotl(a, 5) + f + e + k + w[n];
    e = d;
    d = c;
    c = std::rotl(b, 30);
    b = a;
    a = next;
  }
  state_ = {state_[0] + a, state_[1] + b, state_[2] + c, state_[3] + d, state_[4] + e};
}

void Sha1::add(std::string_view bytes) {
  const auto* at = reinterpret_cast<const std::uint8_t*>(bytes.data());
  std::size_t left = bytes.size();
  while (left > 0) {
    const std::size_t inside = size_ % 64, some = std::min(left, 64 - inside);
    std::memcpy(buffer_.data() + inside, at, some);
    size_ += some;
    at += some;
    left -= some;
    if (size_ % 64 == 0) block(buffer_.data());
  }
}

std::array<std::uint8_t, 20> Sha1::finish() {
  const std::uint64_t bits = 8 * size_;
  std::string end(1 + (119 - size_ % 64) % 64, '\0');
  end[0] = static_cast<char>(0x80);
  for (int n = 7; n >= 0; --n)
    end += static_cast<char>((bits >> (8U * static_cast<unsigned>(n))) & 0xFFU);
  add(end);
  std::array<std::uint8_t, 20> out{};
  for (std::size_t n = 0; n < 20; ++n)
    out[n] = static_cast<std::uint8_t>(state_[n / 4] >> (24 - 8 * (n % 4)));
  return out;
}

Result<std::string> sha1_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return error(Trouble::io, base::printable(path) + ": cannot be read");
  Sha1 sha;
  std::vector<char> some(std::size_t{1} << 20U);
  while (file.read(some.data(), static_cast<std::streamsize>(some.size())) || file.gcount() > 0)
    sha.add({some.data(), static_cast<std::size_t>(file.gcount())});
  if (file.bad()) return error(Trouble::io, base::printable(path) + ": cannot be read");
  const auto all = sha.finish();
  return digits(all.data(), all.size());
}

std::string uuid_at_random() {
  std::random_device machine;  // of the system, not a series from a seed
  std::array<std::uint8_t, 16> bytes{};
  for (std::uint8_t& one : bytes) one = static_cast<std::uint8_t>(machine());
  return uuid_text(bytes, 4);
}

std::string uuid_of(std::string_view space, std::string_view name) {
  std::string bytes;
  std::string hex;
  for (const char c : space)
    if (c != '-') hex += c;
  for (std::size_t n = 0; n + 1 < hex.size(); n += 2)
    bytes += static_cast<char>(std::stoi(hex.substr(n, 2), nullptr, 16));
  Sha1 sha;
  sha.add(bytes);
  sha.add(name);
  const auto all = sha.finish();
  std::array<std::uint8_t, 16> first{};
  std::copy_n(all.begin(), first.size(), first.begin());
  return uuid_text(first, 5);
}

}  // namespace burr::school
