// school/forget.h - deletes a learner: person, sessions, marks, decisions, places in cohorts, what waits, and the
// recordings that can be reached; takes back what was sent; leaves one row of the audit without the id.
//
// Afterwards no table holds the pseudonym, and with SQLite no file does: deleted text is overwritten and the file is
// made anew. A server's own log of writes and its copies are its administrator's. Thread: as the Store.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/store.h"

namespace burr::school {

struct Forgotten {
  std::size_t sessions = 0, waiting = 0;
  std::size_t voided = 0;              // statements that were sent and are to be taken back
  std::vector<std::string> deleted;    // recordings and what lay beside
  std::vector<std::string> unreached;  // recordings on other computers, or moved, or changed
  std::vector<std::string> notices;    // what is left to do
};

// more: further recordings of this learner, which are in no session. Recordings go first, so that after an error the
// same call can be made again. Error: there is no such learner; the store cannot be written.
[[nodiscard]] Result<Forgotten> forget(Store& store, const std::string& learner,
                                       const std::vector<std::string>& more);

// Makes the files of the store anew, so that no bytes of deleted rows are left. forget() does it.
[[nodiscard]] Status scrub(Store& store);

// "file://COMPUTER/path" of a file on this computer.
[[nodiscard]] std::string uri_of(const std::string& path);
// The path again; empty: of a file on another computer.
[[nodiscard]] std::string path_of(const std::string& uri);

}  // namespace burr::school
