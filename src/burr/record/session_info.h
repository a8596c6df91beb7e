// record/session_info.h - describes a session: everything that a replay must know before its first
// tick, as named fields.
//
// Privacy: no patient name, id, date or path may be here; a series UID only as a hash. check()
// refuses texts that look like a path or a UID, so that a mistake does not reach the disk.
// Thread: any.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/record/identity.h"
#include "burr/scenario/recipe.h"
#include "burr/scenario/target.h"
#include "burr/tool/shaped_tool.h"
#include "burr/volume/grid.h"
#include "burr/volume/tissue.h"

namespace burr::scenario {
struct Case;
}
namespace burr::volume {
class Bone;
}

namespace burr::record {

using Numbers = std::map<std::string, double>;  // units are part of the names: "burr_radius_m"
using Words = std::map<std::string, std::string>;

// The bone at the start of the session, and how to make it again from the user's own file.
struct VolumeInfo {
  std::uint64_t content_hash = 0;        // Bone::content_hash() before the first tick
  std::uint64_t source_fingerprint = 0;  // record::fingerprint() of the file or folder; 0: none
  volume::Grid grid;
  volume::TissueTable tissues;
  bool has_intensity = false;
  std::string format;           // "NRRD", "formula"
  scenario::BoneRecipe recipe;  // scenario::without_paths(): how it was made
};

// The case of the session, so that a score can be worked out from the recording and the bone alone.
// Targets and spare are also in the text; they stand here for readers that know no TOML.
struct CaseInfo {
  std::string name;             // a built-in case, or the file's name without .toml
  std::uint64_t text_hash = 0;  // scenario::text_hash() of the text as it was written
  std::string text;             // scenario::Case::text
  std::vector<scenario::Target> targets;
  std::vector<std::string> spare;  // names of tissues
  // True if the text has its hash and gives the same targets and spare: neither was changed.
  [[nodiscard]] bool unchanged() const;
};
[[nodiscard]] CaseInfo case_info(const scenario::Case& work);
// The case as it was opened; its volume is scenario::kOwnFile where it named one.
[[nodiscard]] Result<scenario::Case> case_of(const CaseInfo& info);
struct SessionInfo;
// The case on the bone of the session, which may be another one than the text names (--bone). Only
// where the session has a case.
[[nodiscard]] Result<scenario::Case> case_of(const SessionInfo& info);

// The other hand, where a second device took part.
struct SecondInfo {
  Numbers numbers;                      // settings: "radius_m", "stiffness_n_per_m" ...
  std::string device;                   // its name
  std::vector<tool::ShapedTool> tools;  // at most one; none: a ball that never cuts
};

// nullptr: no second hand, or a ball that never cuts.
[[nodiscard]] inline const tool::Tool* tool_of(const std::optional<SecondInfo>& second) {
  return second && !second->tools.empty() ? &second->tools.front().tool : nullptr;
}

// The seal of the start: which enrolled station began the session, and the number that the centre's store
// gave it for that (record/sealer.h).
struct StartSeal {
  std::string station, nonce;
  std::int64_t given_ms = 0;  // when the nonce was given, by the store's clock; since 1970, UTC
  std::string signature;      // Ed25519, 128 hexadecimal digits
  bool operator==(const StartSeal& other) const = default;
};

struct SessionInfo {
  std::string burr_version;  // filled in by the Recorder
  std::string build;         // likewise: compiler and kind; only the same build replays to the bit
  double rate_hz = 1000;
  std::uint64_t seed = 0;
  Numbers numbers;  // settings: "burr_radius_m", "spindle_rad_s", "stiffness_n_per_m" ...
  Words words;      // "device": "simulated hand", "motion": "pocket" ...
  VolumeInfo volume;
  std::optional<CaseInfo> work_case;    // none: no case, or recorded before cases were
  std::optional<Identity> identity;     // none: recorded before 2026-11-26
  std::optional<Shaft> shaft;           // likewise
  std::vector<tool::ShapedTool> tools;  // other than the round burr, that the session could take
  std::optional<SecondInfo> second;     // none: no second hand, or recorded before 2026-11-27
  std::optional<StartSeal> seal;        // none: nobody sealed it
  bool embedded = false;                // the file holds the bone; filled in by the Recorder
  // Of a session that was left and continued there is one SessionInfo more for each part. Its first
  // tick in the recording, and the SHA-1 of the file as it was before, 40 digits; both filled in by
  // the Recorder. The first part: 0, empty.
  std::uint64_t first_tick = 0;
  std::string goes_on_with;
};

// The bone as it is now, before the first tick. How it was made (numbers, words) is added by the
// caller; so is a number of reserve_bricks that is not simply its free slots.
[[nodiscard]] VolumeInfo volume_info(const volume::Bone& bone);

// Refuses what must not or cannot be written: paths, UIDs, numbers that are not finite, a learner
// that is no pseudonym, a hash of another case.
[[nodiscard]] Status check(const SessionInfo& info);

// One JSON object; every double and hash is read back to the bit.
[[nodiscard]] std::string to_json(const SessionInfo& info);
// where: the file's name for error messages
[[nodiscard]] Result<SessionInfo> session_from_json(std::string_view text,
                                                    const std::string& where);

// "0x0123456789abcdef", the form of every hash (JSON numbers are exact only up to 2^53)
[[nodiscard]] std::string hex(std::uint64_t value);

}  // namespace burr::record
