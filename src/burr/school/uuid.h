// school/uuid.h - names for rows: a UUID drawn at random, or made from a text so that the same text gives the same one
// (RFC 4122, versions 4 and 5); and the SHA-1 that version 5 needs, which also tells recordings apart.
//
// SHA-1 is no protection against somebody who makes two files of one hash on purpose. Thread: any.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::school {

class Sha1 {
 public:
  void add(std::string_view bytes);
  [[nodiscard]] std::array<std::uint8_t, 20> finish();  // no add() after it

 private:
  void block(const std::uint8_t* bytes);
  std::array<std::uint32_t, 5> state_ = {0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476,
                                         0xC3D2E1F0};
  std::array<std::uint8_t, 64> buffer_{};
  std::uint64_t size_ = 0;  // [byte]
};

// Of a file's bytes, as 40 hexadecimal digits. Reads the whole file.
[[nodiscard]] Result<std::string> sha1_of_file(const std::string& path);

[[nodiscard]] std::string uuid_at_random();
// space: a UUID.
[[nodiscard]] std::string uuid_of(std::string_view space, std::string_view name);

// Of all that burr names by hash: the session of a recording is uuid_of(kBurrSpace, its SHA-1).
inline constexpr std::string_view kBurrSpace = "5b0c4b0e-63b7-4a53-9a47-0c4c2b0a7e55";

}  // namespace burr::school
