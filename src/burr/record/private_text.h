// record/private_text.h - refuses texts that must not reach a recording: a path, a UID of a scan, a
// mail address, a text that is too long or that would move a terminal's cursor.
//
// It cannot know a name when it sees one: texts of persons are kept out by the fields themselves,
// which hold words of the case and of burr (record/course.h) or a pseudonym (record/identity.h).
// Thread: any.
#pragma once

#include <cstddef>
#include <string_view>

namespace burr::record {

// A text with a separator of folders, or digits with three dots or more.
[[nodiscard]] bool looks_private(std::string_view text);

// At most `longest` bytes, printable, not looks_private(), no "@".
[[nodiscard]] bool fit_for_a_note(std::string_view text, std::size_t longest = 120);

}  // namespace burr::record
