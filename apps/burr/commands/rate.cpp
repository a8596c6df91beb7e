// `burr rate`: a person marks what learners made, without knowing whose it is, when it was made, or what the machine says.
// In the browser the same is a page of `burr serve`, and in the window window/rate.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/places.h"
#include "burr/base/printable.h"
#include "burr/report/report_pictures.h"
#include "burr/report/scored.h"
#include "burr/school/ratings.h"
#include "burr/school/sessions.h"
#include "burr/school/study/table.h"
#include "burr/school/uuid.h"
#include "burr/scoring/rubric.h"
#include "school/products.h"
#include "school/store_command.h"
#include "shared/counted.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"
#include "window/rate/rate_page.h"
#include "window/ui/desk.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
  std::string store, rater, rubric, session, from, pictures;
  std::string screenshot;
  std::vector<std::string> marks, reasons;
  double seconds = 0;  // shown in the window
  bool window = false;
  std::uint64_t seed = 0;  // 0: burr draws one
  std::size_t most = 20;
  scenario::BoneRecipe volume;
  bool json = false;
};

// "pit.floor=met" into both. Marks may be written with a hyphen, which a shell leaves alone.
Result<std::pair<std::string, std::string>> pair_of(const char* option, const std::string& text) {
  const std::size_t at = text.find('=');
  if (at == std::string::npos || at == 0)
    return error(Trouble::usage,
                 fmt::format("{} {}: write ITEM=...", option, base::printable(text)));
  return std::pair(text.substr(0, at), text.substr(at + 1));
}

std::string mark_of(const std::string& word) {
  return word == "not-assessable" ? "not assessable" : word;
}

// ---- the queue

std::uint64_t seed_of(const Options& options) {
  return options.seed != 0 ? options.seed : std::random_device()() | 1U;
}

Status list(const Options& options, school::Store& store) {
  std::string hash;
  if (!options.rubric.empty()) {
    const auto rubric = school::rubric_in(store, options.rubric);
    if (!rubric) return rubric.error();
    hash = rubric->hash;
  }
  const std::uint64_t seed = seed_of(options);
  const auto queue = school::to_mark(store, options.rater, hash, seed);
  if (!queue) return queue.error();
  Json account = {{"rater", options.rater},
                  {"seed", seed},
                  {"left", queue->size()},
                  {"sessions", Json::array()}};
  if (!options.json)
    fmt::print("{} to mark by {}, in random order (--seed {})\n", counted(queue->size(), "session"),
               base::printable(options.rater), seed);
  for (std::size_t n = 0; n < queue->size() && n < options.most; ++n) {
    const school::Product& one = (*queue)[n];
    if (options.json)
      account["sessions"].push_back({{"session", one.session}, {"case", one.case_name}});
    else
      fmt::print("{}  {}\n", one.session, base::printable(one.case_name));
  }
  if (options.json)
    fmt::print("{}\n", json_line(account));
  else if (queue->size() > options.most)
    fmt::print("and {} more\n", queue->size() - options.most);
  return fine();
}

// The items of one session, without what the machine says of them.
Status show_items(const Options& options, school::Store& store) {
  const auto scores = school::scores_of(store, options.session);
  if (!scores) return scores.error();
  const auto items = school::items_of(store, options.session);
  if (!items) return items.error();
  if (scores->empty() || items->empty())
    return error(Trouble::usage, fmt::format("{}: there is no such session with a score",
                                             base::printable(options.session)));
  const auto rubric = school::rubric_in(store, scores->front().rubric_hash);
  if (!rubric) return rubric.error();
  const auto read = scoring::parse_rubric(rubric->text, rubric->name);
  Json account = {{"session", options.session}, {"items", Json::array()}};
  for (const school::ItemRow& one : *items) {
    std::string text;
    if (const scoring::Item* item = read ? read->item(one.id) : nullptr; item != nullptr)
      if (const auto say = item->say.by_language.find("en"); say != item->say.by_language.end())
        text = say->second;
    if (options.json)
      account["items"].push_back({{"id", one.id}, {"part", one.part}, {"say", text}});
    else
      fmt::print("{:<8} {:<24} {}\n", one.part, base::printable(one.id),
                 base::printable(text, 300));
  }
  if (options.json) fmt::print("{}\n", json_line(account));
  return fine();
}

// ---- marks

Status say_kept(const Options& options, std::size_t marks, std::size_t sessions) {
  if (options.json)
    fmt::print("{}\n", json_line(Json{{"marks", marks}, {"sessions", sessions}}));
  else
    fmt::print("{} of {} kept\n", counted(marks, "mark"), counted(sessions, "session"));
  return fine();
}

Status mark_one(const Options& options, school::Store& store) {
  school::Marking marking{options.session, options.rater, true, {}};
  for (const std::string& text : options.marks) {
    const auto pair = pair_of("--mark", text);
    if (!pair) return pair.error();
    marking.marks.push_back({pair->first, mark_of(pair->second), ""});
  }
  for (const std::string& text : options.reasons) {
    const auto pair = pair_of("--reason", text);
    if (!pair) return pair.error();
    const auto found = std::find_if(marking.marks.begin(), marking.marks.end(),
                                    [&](const auto& one) { return one.item == pair->first; });
    if (found == marking.marks.end())
      return error(Trouble::usage, fmt::format("--reason {}: there is no --mark for this item",
                                               base::printable(pair->first)));
    found->reason = pair->second;
  }
  if (const Status kept = school::mark(store, marking); !kept) return kept;
  return say_kept(options, marking.marks.size(), 1);
}

// Each session all or nothing; the first one that is refused ends it.
Status mark_from_table(const Options& options, school::Store& store) {
  const auto table =
      school::study::read_table(options.from, {"session", "item", "mark"}, {"reason"});
  if (!table) return table.error();
  std::vector<school::Marking> all;
  for (const std::vector<std::string>& row : table->rows) {
    auto found = std::find_if(all.begin(), all.end(),
                              [&](const auto& one) { return one.session == row[0]; });
    if (found == all.end())
      found = all.insert(all.end(), school::Marking{row[0], options.rater, true, {}});
    found->marks.push_back({row[1], mark_of(row[2]), row[3]});
  }
  std::size_t marks = 0, sessions = 0;
  for (const school::Marking& one : all) {
    if (const Status kept = school::mark(store, one); !kept)
      return error(kept.error().trouble,
                   fmt::format("{}: session {}: {}; {} before it kept", table->file, one.session,
                               kept.error().text, counted(sessions, "session")));
    marks += one.marks.size();
    ++sessions;
  }
  return say_kept(options, marks, sessions);
}

// ---- pictures

Status draw(const Options& options, school::Store& store) {
  const auto recording = recording_of(store, options.session);
  if (!recording) return recording.error();
  auto judged = report::judged_by(*recording, "");
  if (!judged) return error(judged.error().trouble, "the recording of this session cannot be read");
  auto of_it = report::scored(std::move(*judged), options.volume, progress());
  if (!of_it)
    return of_it.error().trouble == Trouble::interrupted
               ? of_it.error()
               : error(of_it.error().trouble, "the bone of this session cannot be made");
  auto artist = report::ReportArtist::make(*of_it, progress());
  if (!artist) return artist.error();
  const auto pictures = (*artist)->plain();
  if (!pictures) return pictures.error();
  std::error_code trouble;
  fs::create_directories(options.pictures, trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be made: {}",
                                          base::printable(options.pictures), trouble.message()));
  Json account = Json::array();
  for (const report::ReportArtist::Plain& one : *pictures) {
    auto file = base::NewFile::create((fs::path(options.pictures) / (one.name + ".png")).string(),
                                      base::kForAll);
    if (!file) return file.error();
    file->write(one.picture.png);
    if (const Status written = file->put_in_place(); !written) return written;
    account.push_back({{"name", one.name},
                       {"wide_mm", 1e3 * one.wide},
                       {"width", one.picture.width},
                       {"height", one.picture.height}});
  }
  auto list_file =
      base::NewFile::create((fs::path(options.pictures) / "pictures.json").string(), base::kForAll);
  if (!list_file) return list_file.error();
  list_file->write(json_line(account));
  if (const Status written = list_file->put_in_place(); !written) return written;
  fmt::print("{} in {}\n", counted(pictures->size(), "picture"), base::printable(options.pictures));
  return fine();
}

// ---- the command

// In a window of its own; the page asks who marks where --rater does not say it.
Status mark_in_window(const Options& options) {
  const auto place = store_place(options.store);
  if (!place) return place.error();
  if (const Status there = check_store_is_there(*place); !there) return there;
  auto desk = Desk::open(users_places());
  if (!desk) return desk.error();
  (*desk)->store = options.store;
  RateState state;
  state.rater = options.rater;
  state.seed = options.seed;
  const auto left =
      rate(**desk, state, {.seconds = options.seconds, .screenshot = options.screenshot});
  return left ? fine() : Status(left.error());
}

Status run(const Options& options) {
  if (options.window) return mark_in_window(options);
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  if (!options.pictures.empty()) {
    if (options.session.empty())
      return error(Trouble::usage, "--pictures: name the session with --session");
    return draw(options, **store);
  }
  if (!options.session.empty() && options.marks.empty()) return show_items(options, **store);
  if (const Status good = school::check_name("--rater", options.rater); !good) return good;
  if (!options.from.empty()) return mark_from_table(options, **store);
  if (options.marks.empty()) return list(options, **store);
  if (options.session.empty())
    return error(Trouble::usage, "--mark: name the session with --session");
  return mark_one(options, **store);
}

void add(CLI::App& app, Todo& todo) {
  auto* command =
      app.add_subcommand("rate", "a person marks what learners made, without knowing whose it is");
  auto options = std::make_shared<Options>();
  add_store_option(*command, options->store);
  command->add_option("--rater", options->rater, "your name or pseudonym");
  command->add_option("--rubric", options->rubric,
                      "only sessions that were scored with it: a name or a hash of the store");
  command->add_option("--seed", options->seed, "of the order; 0: burr draws one and prints it")
      ->capture_default_str();
  command->add_option("--most", options->most, "so many sessions are listed")
      ->capture_default_str();
  command->add_option("--session", options->session, "this one; alone: lists its items");
  command->add_option("--mark", options->marks,
                      "ITEM=met, ITEM=unmet or ITEM=not-assessable; can be repeated");
  command->add_option("--reason", options->reasons, "ITEM=WHY, one line; can be repeated");
  command->add_option("--from", options->from,
                      "F.csv: columns session, item, mark [, reason]; many marks at once");
  command->add_option("--pictures", options->pictures,
                      "with --session: a folder for pictures of the product, without colours of "
                      "the machine");
  command->add_option("--volume", options->volume.source,
                      "with --pictures: the volume it was made from (default: burr searches)");
  add_volume_options(*command, options->volume);
  auto* window = command->add_flag("--window", options->window,
                                   "in a window: the bone to turn, the same ten views, the items; "
                                   "no name, day or mark of the machine is shown");
  for (const char* other : {"--session", "--mark", "--from", "--pictures", "--rubric"})
    window->excludes(other);
  command->add_option("--seconds", options->seconds, "close the window after this many seconds")
      ->check(CLI::Range(0.1, 36'000.0))
      ->needs(window);
  command
      ->add_option("--screenshot", options->screenshot,
                   "PNG of the window when it closed, with panels")
      ->needs(window);
  command->add_flag("--json", options->json, "one JSON object, as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{71, add};

}  // namespace
}  // namespace burr::app
