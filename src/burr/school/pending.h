// school/pending.h - sessions that wait until the store can be written: one small file each, in a folder beside the
// store. Nothing is lost, because a file is written beside and renamed, and deleted only after the store has it; and
// nothing comes twice, because a session's id is made from its recording.
//
//     auto kept = school::enter_or_keep(place, record);         // at the end of a session
//     auto in = school::take_in(*store, {});                    // at the next start
//
// Thread: any, several programs at once. Errors: one sentence.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/session_record.h"
#include "burr/school/store.h"

namespace burr::school {

// A recording that was not scored yet.
struct WaitingRecording {
  std::string file, learner;
  std::string rubric;  // built in, or a .toml file; empty: the built-in one of the case
};

struct Waiting {
  std::filesystem::path file;
  std::optional<SessionRecord> session;  // or else
  std::optional<WaitingRecording> recording;
};

// The same session again takes the place of its file.
[[nodiscard]] Status keep(const StorePlace& place, const SessionRecord& record);
[[nodiscard]] Status keep(const StorePlace& place, const WaitingRecording& recording);
// The recording does not wait any more: it is gone on purpose.
void drop(const StorePlace& place, const WaitingRecording& recording);
// Those for this store, by name. A file that cannot be read gets the ending .damaged, and a sentence. others: how many
// wait here for other stores.
[[nodiscard]] std::vector<Waiting> waiting(const StorePlace& place,
                                           std::vector<std::string>& notices,
                                           std::size_t* others = nullptr);
// All other files there, such as damaged ones and those of a burr that was killed while it wrote: which hold this
// learner's pseudonym as a word, and which cannot be read. Whole ones of other stores are left out.
struct Leftovers {
  std::vector<std::filesystem::path> holding, unread;
};
[[nodiscard]] Leftovers leftovers(const StorePlace& place, const std::string& learner);

struct Kept {
  bool stored = false;        // false: it waits
  std::string why;            // it waits
  std::string standing = {};  // stored: whether it counts (school/seal.h)
};
// from: where the session is from. A sealed one waits as its recording, since a file with its scores could be written by
// anybody; it is scored and simulated again when the store is there. Error: refused for good, or it can neither be
// stored nor wait.
[[nodiscard]] Result<Kept> enter_or_keep(const StorePlace& place, const SessionRecord& record,
                                         const WaitingRecording& from = {});

struct TakenIn {
  std::size_t taken = 0, left = 0;
  std::size_t unscored = 0;          // of those left: recordings that nobody here could score
  std::size_t others = 0;            // wait here for other stores
  std::vector<std::string> notices;  // one for each that was refused or still waits
};
using ScoreIt = std::function<Result<SessionRecord>(const WaitingRecording&)>;
// score: makes a session of a recording; without it recordings go on waiting. Deleted is what the store refuses by
// Trouble::usage (its learner was forgotten, or it is another learner's), and what waits for a recording that is gone
// from a folder that is there. Ends at the first Trouble::io of the store: what is left would only wait for it again.
[[nodiscard]] TakenIn take_in(Store& store, const ScoreIt& score);

}  // namespace burr::school
