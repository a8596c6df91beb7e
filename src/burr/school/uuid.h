// school/uuid.h - names for rows: a UUID drawn at random, or made from a text so that the same text gives the same one
// (RFC 4122, versions 4 and 5); and the SHA-1 that version 5 needs, which also tells recordings apart.
//
// SHA-1 is no protection against somebody who makes two files of one hash on purpose. Thread: any.
#pragma once

#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::school {

// 40 hexadecimal digits.
[[nodiscard]] std::string sha1(std::string_view bytes);
// Of a file's bytes. Reads the whole file.
[[nodiscard]] Result<std::string> sha1_of_file(const std::string& path);

[[nodiscard]] std::string uuid_at_random();
// space: a UUID.
[[nodiscard]] std::string uuid_of(std::string_view space, std::string_view name);

// Of all that burr names by hash: the session of a recording is uuid_of(kBurrSpace, its SHA-1).
inline constexpr std::string_view kBurrSpace = "5b0c4b0e-63b7-4a53-9a47-0c4c2b0a7e55";

}  // namespace burr::school
