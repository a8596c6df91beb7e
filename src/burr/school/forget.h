// school/forget.h - deletes a learner: person, sessions, marks, decisions, places in cohorts, what waits, and the
// recordings that can be reached; takes back what was sent; leaves one row of the audit without the id.
//
// Afterwards no table holds the pseudonym, and with SQLite no file does: deleted text is overwritten and the file is
// made anew. A server makes no figures of columns that hold it (store_schema.cpp). A server's own log of writes and its copies are its administrator's. Thread: as the Store.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/store.h"

namespace burr::school {

struct Forgotten {
  std::size_t sessions = 0, waiting = 0;
  std::size_t voided = 0;            // statements that were sent and are to be taken back
  std::vector<std::string> deleted;  // recordings and what lay beside
  std::vector<std::string>
      unreached;  // recordings on other computers, moved, changed, or not to be read
  std::vector<std::string> notices;  // what is left to do
};

// Files that the store does not know of.
struct Recordings {
  std::vector<std::string> mine;    // further recordings of this learner, which are in no session
  std::vector<std::string> unread;  // those that cannot be read: they become `unreached`
  // where the window keeps recordings: there their accounts (.json, .toml) go with them; empty: nowhere
  std::filesystem::path folder;
};
// The name goes first, in a change of its own: what is torn afterwards leaves a pseudonym that can be forgotten again.
// Then rows and, once those may go, recordings; after an error the same call can be made again. A name without a learner
// is deleted too. Error: there is no such learner; the store cannot be written.
[[nodiscard]] Result<Forgotten> forget(Store& store, const std::string& learner,
                                       const Recordings& more);

// True: the statement (JSON, docs/teach/school.md, `outbox`) is about this learner, or is torn and
// holds the pseudonym.
[[nodiscard]] bool is_about(const std::string& statement, const std::string& learner);

// Makes the files of the store anew, so that no bytes of deleted rows are left. forget() does it.
[[nodiscard]] Status scrub(Store& store);

// "file://COMPUTER/path" of a file on this computer.
[[nodiscard]] std::string uri_of(const std::string& path);
// The path again; empty: of a file on another computer.
[[nodiscard]] std::string path_of(const std::string& uri);

}  // namespace burr::school
