#include "school/learner_sessions.h"

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <vector>

#include "burr/school/pending.h"
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

Status enter_session(const LearnerOptions& options) {
  const auto where = store_place(options.store);
  if (!where) return where.error();
  if (const Status there = check_store_is_there(*where); !there) return there;
  const auto record =
      session_of(options.recording, options.id, options.rubric, options.volume, progress());
  if (!record) return record.error();
  const auto kept = school::enter_or_keep(*where, *record);
  if (!kept) return kept.error();
  if (kept->stored)
    fmt::print("{}: the session is in the store\n", record->learner);
  else
    fmt::print("{}: the session waits, and comes into the store at the next start: {}\n",
               record->learner, kept->why);
  print_json(options.json, {{"session", school::session_id(*record)},
                            {"learner", record->learner},
                            {"stored", kept->stored}});
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
  for (const school::Waiting& one : all) {
    if (!one.recording) continue;
    std::error_code nobody_asks;
    if (!fs::exists(one.recording->file, nobody_asks)) continue;
    const auto record = score_waiting(*one.recording);
    if (!record) {
      failed.emplace(one.recording->file, record.error());  // take_in() says why
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
