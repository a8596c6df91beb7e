// record/identity.h - which session this is: case, rubric and labels by their hashes, mode, attempt,
// and the pseudonym of the learner. Part of /session; it never holds a name.
//
// Thread: any.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace burr::volume {
class Bone;
}

namespace burr::record {

// What the session was for, as given when it began. Views, course and commands of the recording show
// which help was really used.
enum class Mode { free, learn, practise, exam };
[[nodiscard]] const char* word_of(Mode mode);
[[nodiscard]] std::optional<Mode> mode_of(std::string_view word);

struct Identity {
  Mode mode = Mode::free;
  std::string learner;        // pseudonym; empty: nobody said who
  std::uint32_t attempt = 0;  // of this learner at this case, from 1; 0: not counted
  std::uint64_t case_hash = 0, rubric_hash = 0, labels_hash = 0;  // 0: none
  // structures of the case whose labels the user accepts in spite of their faults
  std::vector<std::string> accepted_labels = {};
  bool operator==(const Identity& other) const = default;
};

// 3 to 24 small letters, digits and hyphens; a letter first, one to five digits in all:
// "kestrel-27". So a name alone is refused, and so are a mail address and a date of birth, however it
// is divided. A name with a few digits behind it ("anna7") cannot be told from a pseudonym.
[[nodiscard]] Status check_pseudonym(std::string_view text);

// The size of the tool's shaft, which the session itself does not feel.
struct Shaft {
  double radius = 0, length = 0;  // [m]
  bool operator==(const Shaft& other) const = default;
};

// Hash of which tissue every voxel of the bone belongs to, and of the tissues' names. Two bones of
// one shape with other labels differ. Slow: reads all bricks.
[[nodiscard]] std::uint64_t labels_hash(const volume::Bone& bone);

}  // namespace burr::record
