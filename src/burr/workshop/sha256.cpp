#include "burr/workshop/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "burr/base/plain_file.h"

namespace burr::workshop {

std::string sha256(std::string_view bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("OpenSSL has no SHA-256");
  std::string text;
  for (unsigned n = 0; n < size; ++n) text += fmt::format("{:02x}", digest[n]);
  return text;
}

Result<std::string> sha256_of_file(const std::string& path) {
  if (const Status plain = base::check_plain_file(path); !plain) return plain.error();
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  if (!file) return error(Trouble::io, fmt::format("{}: it cannot be read", path));
  return sha256(bytes);
}

}  // namespace burr::workshop
