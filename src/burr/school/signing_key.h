// school/signing_key.h - a key that signs: of a station, for its sessions, or of a person who decides. Ed25519, by OpenSSL.
//
//     auto key = SigningKey::make(file, "station-3");              // a file for this user alone, once
//     auto key = SigningKey::read(file);                           // refused where others may read it
//     bool good = signed_by(key->public_key(), text, key->sign(text));
//
// The private half never leaves the file and this process. Thread: any. Errors: one sentence that names the file.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::school {

class SigningKey {
 public:
  // Error: the file is there already, or cannot be written.
  [[nodiscard]] static Result<SigningKey> make(const std::string& file, const std::string& name);
  // Error, Trouble::io: it is not there. Trouble::usage: others may read it. Trouble::data: it is no such key.
  [[nodiscard]] static Result<SigningKey> read(const std::string& file);

  // Of the station or the person, as the store knows it.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::string public_key() const;                 // 64 hexadecimal digits
  [[nodiscard]] std::string sign(std::string_view text) const;  // 128 hexadecimal digits

 private:
  SigningKey() = default;
  std::string name_;
  std::array<std::uint8_t, 32> secret_ = {};
};

// 3 to 40 small letters, digits and hyphens; a letter first.
[[nodiscard]] Status check_key_name(std::string_view name);

[[nodiscard]] bool signed_by(const std::string& public_key, std::string_view text,
                             const std::string& signature);

// SHA-256 of the first `bytes` bytes of a file, 64 hexadecimal digits. Error: it cannot be read, or is shorter.
[[nodiscard]] Result<std::string> sha256_of_beginning(const std::string& file, std::uint64_t bytes);
[[nodiscard]] std::string sha256(std::string_view text);

// So many random bytes of the system, two hexadecimal digits each.
[[nodiscard]] std::string random_digits(std::size_t bytes);

}  // namespace burr::school
