#include "burr/school/uuid.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "burr/base/plain_file.h"
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

// OpenSSL's SHA-1, of bytes that come piece by piece.
class Sha1 {
 public:
  Sha1() : state_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    if (!state_ || EVP_DigestInit_ex(state_.get(), EVP_sha1(), nullptr) != 1)
      throw std::runtime_error("OpenSSL has no SHA-1");
  }
  void add(std::string_view bytes) { EVP_DigestUpdate(state_.get(), bytes.data(), bytes.size()); }
  [[nodiscard]] std::array<std::uint8_t, 20> finish() {
    std::array<std::uint8_t, 20> out{};
    EVP_DigestFinal_ex(state_.get(), out.data(), nullptr);
    return out;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> state_;
};

}  // namespace

std::string sha1(std::string_view bytes) {
  Sha1 sha;
  sha.add(bytes);
  const auto all = sha.finish();
  return digits(all.data(), all.size());
}

Result<std::string> sha1_of_file(const std::string& path) {
  if (const Status plain = base::check_plain_file(path); !plain) return plain.error();
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
