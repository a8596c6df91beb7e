// `burr learner`: the centre's learners and their sessions: add, list, enter, export, forget, cohorts, the audit.
#include <fmt/chrono.h>
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/places.h"
#include "burr/base/printable.h"
#include "burr/record/identity.h"
#include "burr/record/player.h"
#include "burr/school/audit_check.h"
#include "burr/school/forget.h"
#include "burr/school/practice.h"
#include "burr/school/sessions.h"
#include "burr/school/store.h"
#include "school/decide.h"
#include "school/learner_export.h"
#include "school/learner_sessions.h"
#include "school/learner_store.h"
#include "school/practice_words.h"
#include "school/store_command.h"
#include "school/xapi.h"
#include "shared/counted.h"
#include "shared/front_words.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Options = LearnerOptions;

// "2027-12-31": the end of that day here.
Result<std::int64_t> end_of_day(const std::string& text) {
  std::tm day = {};
  const char* rest = strptime(text.c_str(), "%Y-%m-%d", &day);
  namespace chrono = std::chrono;
  const chrono::year_month_day date(chrono::year(day.tm_year + 1900),
                                    chrono::month(static_cast<unsigned>(day.tm_mon + 1)),
                                    chrono::day(static_cast<unsigned>(day.tm_mday)));
  if (rest == nullptr || *rest != '\0' || text.size() != 10 || !date.ok())
    return error(Trouble::usage, fmt::format("--retain-until {}: use a day such as 2027-12-31",
                                             base::printable(text)));
  day.tm_hour = 23;
  day.tm_min = day.tm_sec = 59;
  day.tm_isdst = -1;
  return std::int64_t{1000} * std::mktime(&day);
}

// ---- add, list

Status run_add(Options options) {
  if (!options.retain_until.empty()) {
    const auto until = end_of_day(options.retain_until);
    if (!until) return until.error();
    options.learner.retain_until_ms = *until;
  }
  auto store = open_store(options, MakeStore::yes);
  if (!store) return store.error();
  if (options.learner.id.empty()) {
    const auto id = school::new_pseudonym(**store);
    if (!id) return id.error();
    options.learner.id = *id;
  }
  if (const Status added = school::add(**store, options.learner, options.person); !added)
    return added;
  fmt::print("{}\n", options.learner.id);
  if (!options.person.empty() && (*store)->database().kind() == school::Database::Kind::sqlite)
    fmt::print("the name is in {}\n",
               base::printable(school::names_file((*store)->place().address), 300));
  print_json(options.json, {{"id", options.learner.id}, {"named", !options.person.empty()}});
  return fine();
}

Json json_of(const school::LearnerRow& row, bool names) {
  Json one = {{"id", row.learner.id},       {"level", row.learner.level},
              {"hand", row.learner.handed}, {"created_ms", row.learner.created_ms},
              {"retain_until_ms", nullptr}, {"consent_research", row.learner.consent_research},
              {"sessions", row.sessions},   {"unguided", row.unguided},
              {"needed", school::kNeeded},  {"last_ms", nullptr}};
  if (row.learner.retain_until_ms) one["retain_until_ms"] = *row.learner.retain_until_ms;
  if (row.last_ms) one["last_ms"] = *row.last_ms;
  if (names) {
    one["name"] = row.person.name;
    one["mail"] = row.person.mail;
    one["external_id"] = row.person.external_id;
  }
  return one;
}

Json json_of(const school::SessionRow& row) {
  return {{"id", row.id},
          {"case", row.case_name},
          {"started_ms", row.started_ms},
          {"seconds", row.seconds},
          {"mode", row.mode},
          {"guided", row.guided},
          {"finished", row.finished},
          {"attempt", row.attempt},
          {"device", row.device},
          {"standing", row.standing},
          {"date_by", row.sealed() ? "store" : "file"}};
}

Status list_sessions(const Options& options, school::Store& store) {
  const auto rows = school::sessions_of(store, options.id);
  if (!rows) return rows.error();
  Json all = Json::array();
  fmt::print("{:<12}{:<18}{:>8}  {:<10}{:<10}{:<12}{:<21}{}\n", "day", "case", "attempt", "mode",
             "guided", "ended", "seal", "items met");
  bool all_sealed = true;
  for (const school::SessionRow& row : *rows) {
    const auto scores = school::scores_of(store, row.id);
    if (!scores) return scores.error();
    std::string met;
    Json one = json_of(row);
    one["scores"] = Json::array();
    for (const school::ScoreRow& score : *scores) {
      met += fmt::format("{}{} {} of {}", met.empty() ? "" : ", ", score.part, score.met,
                         score.assessable);
      one["scores"].push_back({{"part", score.part},
                               {"rubric", score.rubric},
                               {"rubric_hash", score.rubric_hash},
                               {"engine", score.engine},
                               {"met", score.met},
                               {"assessable", score.assessable},
                               {"gates_broken", score.gates_broken}});
    }
    fmt::print("{:<12}{:<18}{:>8}  {:<10}{:<10}{:<12}{:<21}{}\n", day_of(row.started_ms),
               base::printable(row.case_name), row.attempt, row.mode, row.guided ? "guided" : "no",
               row.finished ? "done" : "unfinished", base::printable(row.standing), met);
    all_sealed = all_sealed && row.sealed();
    all.push_back(std::move(one));
  }
  if (!all_sealed)
    fmt::print(
        "\nA session that is not sealed has its day by the file's date, and counts for no "
        "standard, decision or exam.\n");
  const auto practice = school::practice(store, options.id);
  if (!practice) return practice.error();
  Json proposed = Json::array();
  const std::int64_t today = school::day_here(school::now_ms());
  if (!practice->empty())
    fmt::print("\nwhen to practise again, a proposal by a fixed rule (docs/teach/school.md):\n");
  for (const school::LearnerPractice& one : *practice)
    for (const school::CasePractice& of : one.cases) {
      fmt::print("  {}\n", practice_line(of, today));
      proposed.push_back(practice_json(of, today));
    }
  print_json(options.json, {{"learner", options.id}, {"sessions", all}, {"practice", proposed}});
  return fine();
}

Status run_list(const Options& options) {
  auto store = open_store(options);
  if (!store) return store.error();
  if (!options.id.empty()) {
    const auto known = school::has(**store, options.id);
    if (!known) return known.error();
    if (!*known)
      return error(Trouble::usage, fmt::format("{}: there is no such learner; `burr learner list`",
                                               base::printable(options.id)));
    return list_sessions(options, **store);
  }
  const auto rows = school::learners(**store, options.names);
  if (!rows) return rows.error();
  if (options.names && !(*store)->reads_only())
    if (const Status noted = (*store)->note("names shown", ""); !noted) return noted;
  const auto practice = school::practice(**store, "");
  if (!practice) return practice.error();
  // of each the case that was practised last
  std::map<std::string, const school::CasePractice*> practised;
  for (const school::LearnerPractice& one : *practice) practised[one.learner] = &one.cases.front();
  const std::int64_t today = school::day_here(school::now_ms());
  Json all = Json::array();
  fmt::print("{:<22}{:<9}{:>9}  {:<12}{:<10}{:<12}{:<9}{}\n", "learner", "level", "sessions",
             "last", "unguided", "again from", "research", options.names ? "name" : "");
  for (const school::LearnerRow& row : *rows) {
    const std::string last = row.last_ms ? day_of(*row.last_ms) : "never";
    const std::string so_far = row.unguided < school::kNeeded
                                   ? fmt::format("{} of {}", row.unguided, school::kNeeded)
                                   : fmt::format("{}", row.unguided);
    const auto found = practised.find(row.learner.id);
    const school::CasePractice* of = found == practised.end() ? nullptr : found->second;
    fmt::print("{:<22}{:<9}{:>9}  {:<12}{:<10}{:<12}{:<9}{}\n", row.learner.id, row.learner.level,
               row.sessions, last, so_far,
               of != nullptr && of->next ? school::date_of(of->next->day) : "-",
               row.learner.consent_research ? "yes" : "no", base::printable(row.person.name));
    Json one = json_of(row, options.names);
    one["practice"] = of != nullptr ? practice_json(*of, today) : Json(nullptr);
    all.push_back(std::move(one));
  }
  print_json(options.json, {{"learners", all}});
  return fine();
}

// ---- forget

// Recordings of the window that are this learner's, also those that never came into the store; and those of which
// nobody knows whose they are.
school::Recordings recordings_of(const std::string& learner) {
  school::Recordings all;
  std::error_code nobody_asks;
  all.folder = users_places().state / "sessions";
  for (const auto& entry : fs::directory_iterator(all.folder, nobody_asks)) {
    const std::string file = entry.path().string(), ending = entry.path().extension().string();
    if (ending != ".mcap" && ending != ".part") continue;
    const auto player = record::Player::open(file);
    if (!player || ending == ".part") {
      all.unread.push_back(file + " (it cannot be read; it may be of this learner)");
      continue;
    }
    const auto& identity = (*player)->info().identity;
    if (identity && identity->learner == learner) all.mine.push_back(file);
  }
  return all;
}

Status forget_one(school::Store& store, const std::string& id, Json& all) {
  const auto done = school::forget(store, id, recordings_of(id));
  if (!done) return done.error();
  fmt::print("forgotten: {}, {}, {} deleted\n", counted(done->sessions, "session"),
             counted(done->waiting, "session") + " that waited",
             counted(done->deleted.size(), "file"));
  if (done->voided > 0)
    fmt::print("{} sent elsewhere will be taken back\n", counted(done->voided, "statement"));
  for (const std::string& one : done->deleted)
    fmt::print("deleted: {}\n", base::printable(one, 400));
  for (const std::string& one : done->unreached)
    fmt::print("not reached, delete it yourself: {}\n", base::printable(one, 400));
  print_notices(done->notices);
  all.push_back({{"sessions", done->sessions},
                 {"deleted", done->deleted},
                 {"unreached", done->unreached},
                 {"voided", done->voided},
                 {"complete", done->notices.empty()}});
  return fine();
}

Status run_forget(const Options& options) {
  if (options.id.empty() && !options.overdue && !options.scrub)
    return error(Trouble::usage, "name a learner, or give --overdue");
  auto store = open_store(options);
  if (!store) return store.error();
  Json all = Json::array();
  if (!options.id.empty())
    if (const Status gone = forget_one(**store, options.id, all); !gone) return gone;
  if (options.overdue) {
    const auto late = school::overdue(**store, school::now_ms());
    if (!late) return late.error();
    for (const std::string& id : *late)
      if (const Status gone = forget_one(**store, id, all); !gone) return gone;
    fmt::print("{} whose time to keep was over\n", counted(late->size(), "learner"));
  }
  if (options.scrub)
    if (const Status clean = school::scrub(**store); !clean) return clean;
  print_json(options.json, {{"forgotten", all}});
  return fine();
}

// ---- cohorts, audit

Status run_cohort_list(const Options& options) {
  auto store = open_store(options);
  if (!store) return store.error();
  const auto all = school::cohorts(**store);
  if (!all) return all.error();
  Json listed = Json::array();
  for (const school::Cohort& one : *all) {
    fmt::print("{}: {}\n", base::printable(one.title), base::list_of(one.members));
    listed.push_back({{"id", one.id}, {"title", one.title}, {"members", one.members}});
  }
  print_json(options.json, {{"cohorts", listed}});
  return fine();
}

Status run_cohort(const Options& options, bool adds) {
  auto store = open_store(options, adds ? MakeStore::yes : MakeStore::no);
  if (!store) return store.error();
  const Status done = adds ? school::add_to_cohort(**store, options.title, options.ids)
                           : school::remove_from_cohort(**store, options.title, options.ids);
  if (!done) return done;
  fmt::print("{}: {} {}\n", base::printable(options.title), counted(options.ids.size(), "learner"),
             adds ? "added" : "removed");
  return fine();
}

Status run_audit(const Options& options) {
  auto store = open_store(options);
  if (!store) return store.error();
  const auto rows = school::audit(**store);
  if (!rows) return rows.error();
  Json all = Json::array();
  for (const school::AuditRow& row : *rows) {
    fmt::print("{:%Y-%m-%d %H:%M:%S}Z  {:<24}{:<24}{}\n",
               fmt::gmtime(static_cast<std::time_t>(row.ms / 1000)), base::printable(row.who),
               row.what, row.subject);
    all.push_back({{"ms", row.ms}, {"who", row.who}, {"what", row.what}, {"subject", row.subject}});
  }
  print_json(options.json, {{"audit", all}});
  return fine();
}

Status run_check(const Options& options) {
  auto store = open_store(options);
  if (!store) return store.error();
  const auto found = school::check_audit(**store, options.title);
  if (!found) return found.error();
  fmt::print("the audit is whole: {}, {} of people who were forgotten, {} older than the chain\n",
             counted(static_cast<std::size_t>(found->rows), "row"), found->forgotten, found->older);
  fmt::print("the signatures fit: {}, {}\n",
             counted(static_cast<std::size_t>(found->seals), "seal"),
             counted(static_cast<std::size_t>(found->decisions), "decision"));
  fmt::print("write down: {}\n", found->head.empty() ? "nothing yet" : found->head);
  print_json(options.json, {{"rows", found->rows},
                            {"forgotten", found->forgotten},
                            {"older", found->older},
                            {"seals", found->seals},
                            {"decisions", found->decisions},
                            {"head", found->head}});
  return fine();
}

Status run_decide(const Options& options) {
  auto store = open_store(options);
  if (!store) return store.error();
  return options.decision.outcome.empty()
             ? show_proposals(**store, options.decision, options.json)
             : record_decision(**store, options.decision, options.json);
}

// ---- the command line

CLI::App* sub(CLI::App& command, const char* name, const char* says,
              const std::shared_ptr<Options>& options, Todo& todo, Status (*run)(const Options&)) {
  auto* made = store_command<Options>(command, name, says, options, todo, run);
  made->add_flag("--json", options->json, "print a JSON object as the last line");
  return made;
}

void add_people(CLI::App& command, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* add = sub(command, "add", "a new learner; burr makes the pseudonym", options, todo,
                  [](const Options& given) { return run_add(given); });
  add->add_option("--id", options->learner.id, "the pseudonym, if not one that burr makes")
      ->check([](const std::string& text) {
        const Status good = record::check_pseudonym(text);
        return good ? std::string() : good.error().text;
      });
  add->add_option("--level", options->learner.level, "student, PGY1 to PGY9, or surgeon");
  add->add_option("--hand", options->learner.handed, "left, right or both");
  add->add_option("--retain-until", options->retain_until,
                  "a day such as 2027-12-31; after it burr offers to delete the learner");
  add->add_flag("--consent-research", options->learner.consent_research,
                "the learner agreed to research, not to training alone");
  add->add_option("--name", options->person.name, "kept apart, in the file or schema of names");
  add->add_option("--mail", options->person.mail, "likewise");
  add->add_option("--external-id", options->person.external_id,
                  "the learner's number elsewhere; likewise");

  options = std::make_shared<Options>();
  auto* list =
      sub(command, "list", "the learners, or the sessions of one", options, todo, run_list);
  list->add_option("learner", options->id, "a pseudonym: lists the sessions");
  list->add_flag("--names", options->names, "with their names; the audit says so");

  options = std::make_shared<Options>();
  auto* forget = sub(command, "forget", "delete a learner, with all sessions and recordings",
                     options, todo, run_forget);
  forget->add_option("learner", options->id, "a pseudonym");
  forget->add_flag("--overdue", options->overdue, "all whose time to keep is over");
  forget->add_flag("--scrub", options->scrub,
                   "make the files anew, so that no bytes of deleted rows are left");
}

void add_sessions(CLI::App& command, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* enter = sub(command, "enter", "score a recording and enter it as a session of a learner",
                    options, todo, enter_session);
  enter->add_option("learner", options->id, "a pseudonym")->required();
  enter->add_option("recording", options->recording, "a recording (.mcap)")->required();
  enter->add_option("--rubric", options->rubric,
                    "a built-in rubric, or a .toml file (default: that of the recording's case)");
  enter->add_option("--volume", options->volume.source,
                    "the volume it was made from (default: burr searches for it)");
  add_volume_options(*enter, options->volume);

  options = std::make_shared<Options>();
  sub(command, "take-in", "score and enter the sessions that wait for the store", options, todo,
      take_in_sessions);

  options = std::make_shared<Options>();
  auto* out = sub(command, "export", "all that is known of a learner, or tables of all", options,
                  todo, export_learners);
  out->add_option("learner", options->id, "a pseudonym");
  out->add_option("--out", options->out, "F.zip: tables (CSV and JSON) and reports");
  out->add_flag("--no-reports", options->no_reports, "tables alone");
  std::vector<std::string> codes;
  for (const Language& one : languages()) codes.push_back(one.code);
  out->add_option("--language", options->language, "of the reports")->check(CLI::IsMember(codes));
  out->add_flag("--all", options->all, "of all learners, without names");
  out->add_option("--csv", options->csv, "with --all: the folder for the tables");
}

void add_cohort(CLI::App& command, Todo& todo) {
  auto* cohort = command.add_subcommand("cohort", "groups of learners: a class, a year");
  cohort->require_subcommand(1);
  auto options = std::make_shared<Options>();
  sub(*cohort, "list", "the groups and who is in them", options, todo, run_cohort_list);
  for (const bool adds : {true, false}) {
    options = std::make_shared<Options>();
    auto* one = adds ? sub(*cohort, "add", "learners into a group; it is made if it is not there",
                           options, todo, [](const Options& o) { return run_cohort(o, true); })
                     : sub(*cohort, "remove", "learners out of a group; an empty group goes",
                           options, todo, [](const Options& o) { return run_cohort(o, false); });
    one->add_option("title", options->title, "of the group")->required();
    one->add_option("learners", options->ids, "pseudonyms")->required();
  }
}

void add_decide(CLI::App& command, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* decide = sub(command, "decide", "what a standard proposes; or a decision by a person",
                     options, todo, run_decide);
  school::Decision& of = options->decision;
  decide->add_option("learner", of.learner, "a pseudonym")->required();
  decide->add_option("--standard", of.standard,
                     "of the centre: its id (`burr study standards`); without it all are shown");
  auto* outcome = decide->add_option("--outcome", of.outcome, "the decision: pass or fail")
                      ->check(CLI::IsMember({"pass", "fail"}));
  outcome->needs(
      decide->add_option("--reason", of.reason, "with --outcome: why, one line")->needs(outcome));
  outcome->needs(decide->get_option("--standard"));
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("learner", "a centre's learners and their sessions");
  command->require_subcommand(1);
  add_people(*command, todo);
  add_sessions(*command, todo);
  add_cohort(*command, todo);
  add_xapi(*command, todo);
  add_decide(*command, todo);
  auto options = std::make_shared<Options>();
  sub(*command, "audit", "who did what, and when", options, todo, run_audit);
  options = std::make_shared<Options>();
  sub(*command, "check", "whether the audit, the seals and the decisions are as they were written",
      options, todo, run_check)
      ->add_option("--since", options->title,
                   "what an earlier check said to write down: it must still be there");
}

const Command command{70, add};

}  // namespace
}  // namespace burr::app
