#include "school/learner_sessions.h"

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <vector>

#include "burr/base/printable.h"
#include "burr/school/pending.h"
#include "burr/school/seal.h"
#include "burr/school/sessions.h"
#include "burr/school/store.h"
#include "school/session_of.h"
#include "school/store_command.h"
#include "school/xapi.h"
#include "shared/counted.h"
#include "shared/front_words.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

Result<school::SessionRecord> score_waiting(const school::WaitingRecording& waiting) {
  return session_of(waiting.file, waiting.learner, waiting.rubric, {}, progress());
}

}  // namespace

std::string standing_words(const std::string& standing) {
  if (standing == school::standing::kSealed) return "sealed";
  const std::map<std::string, std::string> why = {
      {school::standing::kNoSeal, "its recording has no seal"},
      {school::standing::kNoEnd, "its recording has no seal of its end"},
      {school::standing::kContinued, "it was left and continued, and a seal is about one sitting"},
      {school::standing::kUnknownStation, "the store does not know the station of its seal"},
      {school::standing::kNotReplayed, "it could not be simulated again here"},
      {school::standing::kNoPerson, "burr moved the hand itself"}};
  const auto found = why.find(standing);
  return fmt::format("not sealed: {}; it is shown, and counts for no standard, decision or exam",
                     found != why.end() ? found->second : base::printable(standing));
}

Status enter_session(const LearnerOptions& options) {
  const auto where = store_place(options.store);
  if (!where) return where.error();
  if (const Status there = check_store_is_there(*where); !there) return there;
  const auto record =
      session_of(options.recording, options.id, options.rubric, options.volume, progress());
  if (!record) return record.error();
  std::error_code nobody_asks;
  const auto kept = school::enter_or_keep(
      *where, *record,
      {fs::absolute(options.recording, nobody_asks).string(), options.id, options.rubric});
  if (!kept) return kept.error();
  if (kept->stored)
    fmt::print("{}: the session is in the store, {}\n", record->learner,
               standing_words(kept->standing));
  else
    fmt::print("{}: the session waits, and comes into the store at the next start: {}\n",
               record->learner, kept->why);
  print_json(options.json, {{"session", school::session_id(*record)},
                            {"learner", record->learner},
                            {"stored", kept->stored},
                            {"standing", kept->standing}});
  return fine();
}

Status take_in_sessions(const LearnerOptions& options) {
  const auto where = store_place(options.store);
  if (!where) return where.error();
  if (const Status there = check_store_is_there(*where); !there) return there;
  std::vector<std::string> notices;
  const std::vector<school::Waiting> all = school::waiting(*where, notices);
  // what is scored once need not be scored again, wherever the server is; nor what cannot be scored
  std::map<std::string, Error> failed;
  std::map<std::string, school::SessionRecord> scored;
  for (const school::Waiting& one : all) {
    if (!one.recording) continue;
    std::error_code nobody_asks;
    if (!fs::exists(one.recording->file, nobody_asks)) continue;
    const auto record = score_waiting(*one.recording);
    if (!record) {
      failed.emplace(one.recording->file, record.error());  // take_in() says why
      continue;
    }
    if (record->seal) {  // it goes on waiting as its recording, for the case that the store is away
      scored.emplace(one.recording->file, *record);
      continue;
    }
    if (const Status kept = school::keep(*where, *record); !kept) return kept;
    fs::remove(one.file, nobody_asks);
  }
  auto store = school::Store::open(*where);
  if (!store) return store.error();
  const school::TakenIn in = school::take_in(
      **store, [&](const school::WaitingRecording& one) -> Result<school::SessionRecord> {
        if (const auto found = failed.find(one.file); found != failed.end()) return found->second;
        if (const auto found = scored.find(one.file); found != scored.end()) return found->second;
        return score_waiting(one);
      });
  print_notices(notices);
  print_notices(in.notices);
  say_others(in);
  fmt::print("{} came into the store, {} still waiting\n", counted(in.taken, "session"), in.left);
  print_json(options.json, {{"taken", in.taken}, {"left", in.left}});
  std::fflush(stdout);
  send_what_is_due(**store);
  tell_waiting_launches();
  return fine();
}

}  // namespace burr::app
