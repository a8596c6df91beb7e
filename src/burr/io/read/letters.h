// io/read/letters.h - text of files in other writing than UTF-8: names in DICOM, and names of files as
// Windows, Macs and Japan write them. Internal to io.
//
// The tables are made by scripts/letters.py. A letter that no table has becomes U+FFFD.
// Thread: any.
#pragma once

#include <string>
#include <string_view>

namespace burr::io {

// A text of a DICOM file as UTF-8. character_set: Specific Character Set (0008,0005), with all its
// values; escape sequences of ISO 2022 are followed (PS3.3 C.12.1.1.2, PS3.5 6.1.2.5). An unknown set,
// or none: the text as it is.
[[nodiscard]] std::string utf8_of_dicom(std::string_view text, std::string_view character_set);

// The name of a file that may be written as old archives do: Shift-JIS, or the letters of DOS.
[[nodiscard]] std::string utf8_of_name(std::string_view name);

// With slashes where Windows wrote backslashes; the second byte of a Japanese letter is none.
[[nodiscard]] std::string with_slashes(std::string name);

// Whether people would call these one name: capital or small letters, letters in one piece or with
// their marks apart (NFC, NFD), UTF-8 or one of the writings before it.
[[nodiscard]] bool same_name(std::string_view a, std::string_view b);

}  // namespace burr::io
