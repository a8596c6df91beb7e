// school/enrolled.h - the stations whose seals a store believes, the people whose decisions it believes, and the nonces
// that bind a sealed session to one learner, task and time.
//
//     enrol(*store, {"station-3", key.public_key()});
//     auto given = give_nonce(*store, seal);              // at the start of a session
//     auto ended = end_nonce(*store, given->nonce, head); // at its end: this recording, and no other
//     auto standing = check_seal(*store, record);         // when it is entered
//
// A nonce is given once, closed once, and good for one session. Times are by the store's clock. Thread: as the Store.
// Errors: as school/database.h; Trouble::usage: refused for good.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/seal.h"
#include "burr/school/session_record.h"
#include "burr/school/store.h"

namespace burr::school {

struct Enrolled {
  std::string name, key;         // key: public, 64 hexadecimal digits
  std::string kind = "station";  // or "decider": a person
  std::int64_t enrolled_ms = 0;
  std::string enrolled_by = {};
  std::optional<std::int64_t> revoked_ms = {};
  std::string revoked_by = {};
};

// Error: the name or the key is there already.
[[nodiscard]] Status enrol(Store& store, const Enrolled& one);
[[nodiscard]] Result<std::vector<Enrolled>> enrolled(Store& store);
// What it sealed before stays sealed. Error: there is no such name, or it is revoked already.
[[nodiscard]] Status revoke(Store& store, const std::string& name);

// A nonce must be closed within this time.
inline constexpr std::int64_t kNonceLivesMs = 24LL * 3600 * 1000;

struct Given {
  std::string nonce;
  std::int64_t given_ms = 0;
};
// asked: station, learner, mode, case, rubric. Error: the station is not enrolled or revoked; no such learner.
[[nodiscard]] Result<Given> give_nonce(Store& store, const Seal& asked);
// Returns when. Error: not given here, closed already, or too old.
[[nodiscard]] Result<std::int64_t> end_nonce(Store& store, const std::string& nonce,
                                             const std::string& head);

// How far the session is believed (school/seal.h, `standing`). Error: its seal is not what this store gave, or was used.
[[nodiscard]] Result<std::string> check_seal(Store& store, const SessionRecord& record);
// For a session that check_seal() found sealed. Within its transaction. False: a seal of it, or of its nonce, is there.
[[nodiscard]] Result<bool> keep_seal(Store& store, const SessionRecord& record);

}  // namespace burr::school
