#include "burr/school/signing_key.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <openssl/evp.h>
#include <openssl/rand.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/plain_file.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"

namespace burr::school {
namespace {

using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
using Digest = std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)>;

constexpr std::string_view kFirstLine = "burr signing key 1";

std::string hex_of(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (const std::uint8_t one : bytes) text += fmt::format("{:02x}", one);
  return text;
}

template <std::size_t N>
std::optional<std::array<std::uint8_t, N>> bytes_of(std::string_view hex) {
  std::array<std::uint8_t, N> out = {};
  if (hex.size() != 2 * N) return std::nullopt;
  for (std::size_t n = 0; n < N; ++n) {
    const char* from = hex.data() + 2 * n;
    const auto read = std::from_chars(from, from + 2, out[n], 16);
    if (read.ec != std::errc() || read.ptr != from + 2) return std::nullopt;
  }
  return out;
}

Key key_of(const std::array<std::uint8_t, 32>& secret) {
  return {EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, nullptr, secret.data(), secret.size()),
          EVP_PKEY_free};
}

class Sha256 {
 public:
  Sha256() : state_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    if (!state_ || EVP_DigestInit_ex(state_.get(), EVP_sha256(), nullptr) != 1)
      throw std::runtime_error("OpenSSL has no SHA-256");
  }
  void add(const char* bytes, std::size_t size) { EVP_DigestUpdate(state_.get(), bytes, size); }
  [[nodiscard]] std::string finish() {
    std::array<std::uint8_t, 32> out{};
    EVP_DigestFinal_ex(state_.get(), out.data(), nullptr);
    return hex_of(out);
  }

 private:
  Digest state_;
};

}  // namespace

Status check_key_name(std::string_view name) {
  const auto letter = [](char c) { return c >= 'a' && c <= 'z'; };
  const auto fits = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; };
  if (name.size() >= 3 && name.size() <= 40 && letter(name.front()) &&
      std::all_of(name.begin(), name.end(), fits))
    return fine();
  return error(
      Trouble::usage,
      fmt::format("name {}: give 3 to 40 small letters, digits and hyphens, a letter first, "
                  "for example station-3",
                  base::printable(std::string(name))));
}

std::string random_digits(std::size_t bytes) {
  std::vector<std::uint8_t> out(bytes);
  if (RAND_bytes(out.data(), static_cast<int>(out.size())) != 1)
    throw std::runtime_error("OpenSSL gives no random numbers");
  return hex_of(out);
}

Result<SigningKey> SigningKey::make(const std::string& file, const std::string& name) {
  if (const Status good = check_key_name(name); !good) return good.error();
  std::error_code trouble;
  if (std::filesystem::exists(file, trouble))
    return error(Trouble::usage,
                 base::printable(file) + ": a key is there already, and is not replaced");
  std::filesystem::create_directories(std::filesystem::path(file).parent_path(), trouble);
  SigningKey key;
  key.name_ = name;
  key.secret_ = *bytes_of<32>(random_digits(32));
  auto made = base::NewFile::create(file, base::kForMe);
  if (!made) return made.error();
  made->write(fmt::format("{}\nname {}\nsecret {}\n", kFirstLine, name, hex_of(key.secret_)));
  if (const Status placed = made->put_in_place(); !placed) return placed.error();
  return key;
}

Result<SigningKey> SigningKey::read(const std::string& file) {
  const std::string shown = base::printable(file);
  struct stat about = {};
  if (::stat(file.c_str(), &about) != 0)
    return error(Trouble::io, shown + ": there is no key; `school::enrol` makes one");
  if (const Status plain = base::check_plain_file(file); !plain) return plain.error();
  if ((about.st_mode & 077U) != 0 || about.st_uid != ::geteuid())
    return error(
        Trouble::usage,
        fmt::format("{}: others can read or own this key, so its signature proves nothing; "
                    "run chmod 600 on it, or revoke it and enrol a new name",
                    shown));
  const auto text = base::text_of_file(file, 4096, "a key");
  if (!text) return text.error();
  SigningKey key;
  std::string_view rest = *text;
  const auto line = [&rest] {
    const std::string_view one = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
    return one;
  };
  const auto after = [](std::string_view one, std::string_view word) {
    return one.substr(0, word.size()) == word ? one.substr(word.size()) : std::string_view();
  };
  const bool first = line() == kFirstLine;
  key.name_ = after(line(), "name ");
  const auto secret = bytes_of<32>(after(line(), "secret "));
  if (!first || !check_key_name(key.name_) || !secret)
    return error(shown + ": is no key of burr, or is torn; restore it, or enrol a new name");
  key.secret_ = *secret;
  return key;
}

std::string SigningKey::public_key() const {
  const Key key = key_of(secret_);
  std::array<std::uint8_t, 32> out{};
  std::size_t size = out.size();
  if (!key || EVP_PKEY_get_raw_public_key(key.get(), out.data(), &size) != 1) return {};
  return hex_of(out);
}

std::string SigningKey::sign(std::string_view text) const {
  const Key key = key_of(secret_);
  const Digest state(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  std::array<std::uint8_t, 64> out{};
  std::size_t size = out.size();
  if (!key || !state ||
      EVP_DigestSignInit(state.get(), nullptr, nullptr, nullptr, key.get()) != 1 ||
      EVP_DigestSign(state.get(), out.data(), &size,
                     reinterpret_cast<const unsigned char*>(text.data()), text.size()) != 1)
    return {};
  return hex_of(out);
}

bool signed_by(const std::string& public_key, std::string_view text, const std::string& signature) {
  const auto raw = bytes_of<32>(public_key);
  const auto proof = bytes_of<64>(signature);
  if (!raw || !proof) return false;
  const Key key(EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, nullptr, raw->data(), raw->size()),
                EVP_PKEY_free);
  const Digest state(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  return key && state &&
         EVP_DigestVerifyInit(state.get(), nullptr, nullptr, nullptr, key.get()) == 1 &&
         EVP_DigestVerify(state.get(), proof->data(), proof->size(),
                          reinterpret_cast<const unsigned char*>(text.data()), text.size()) == 1;
}

Result<std::string> sha256_of_beginning(const std::string& file, std::uint64_t bytes) {
  if (const Status plain = base::check_plain_file(file); !plain) return plain.error();
  std::ifstream from(file, std::ios::binary);
  Sha256 sha;
  std::vector<char> some(std::size_t{1} << 20U);
  while (bytes > 0 && from) {
    from.read(some.data(),
              static_cast<std::streamsize>(std::min<std::uint64_t>(bytes, some.size())));
    const auto got = static_cast<std::uint64_t>(from.gcount());
    sha.add(some.data(), got);
    bytes -= got;
    if (got == 0) break;
  }
  if (bytes > 0) return error(Trouble::io, base::printable(file) + ": cannot be read to its end");
  return sha.finish();
}

std::string sha256(std::string_view text) {
  Sha256 sha;
  sha.add(text.data(), text.size());
  return sha.finish();
}

}  // namespace burr::school
