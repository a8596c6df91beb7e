// school/seal.h - what an enrolled station says of a session under its signature, and how it is read from a recording.
//
//     auto seal = seal_of(file, player->info(), continued);        // none: the recording has none
//     signed_by(station.key, end_words(*seal), seal->signature)
//
// docs/teach/security.md says what a seal proves, and what not. Thread: any. Errors: one sentence with file, field and
// remedy, Trouble::usage: the recording is refused for good.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/record/session_info.h"

namespace burr::school {

struct Seal {
  std::string station, nonce;
  std::int64_t given_ms = 0, ended_ms = 0;  // by the store's clock: the nonce was given, and closed
  std::string learner, mode, case_hash, rubric_hash, bone_hash, device;
  std::string start_signature;
  std::string head;       // SHA-256 of the recording before its seal; empty: no seal of the end
  std::string signature;  // of the end
  bool operator==(const Seal&) const = default;
  [[nodiscard]] bool ended() const { return !signature.empty(); }
};

// What is signed, line by line.
[[nodiscard]] std::string start_words(const Seal& seal);
[[nodiscard]] std::string end_words(const Seal& seal);

// What the seal says besides station, nonce, times and signatures.
[[nodiscard]] Seal seal_about(const record::SessionInfo& info);

// info: of the recording. Error: the file is not the one that was sealed. A seal without end: the session was cut off,
// or the store could not be reached.
[[nodiscard]] Result<std::optional<Seal>> seal_of(const std::string& file,
                                                  const record::SessionInfo& info);

// False: burr itself moved the hand (`mill`, `surgeon`, Python, --headless).
[[nodiscard]] bool is_persons_hand(const std::string& device);

// How far a session is believed. The first alone counts for a standard, a decision or an exam.
namespace standing {
inline constexpr const char* kSealed = "sealed";
inline constexpr const char* kNoSeal = "no seal";
inline constexpr const char* kNoEnd = "no seal at its end";
inline constexpr const char* kContinued = "continued";
inline constexpr const char* kUnknownStation = "unknown station";
inline constexpr const char* kNotReplayed = "not simulated again";
inline constexpr const char* kNoPerson = "no person's hand";
}  // namespace standing

}  // namespace burr::school
