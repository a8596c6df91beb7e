#include "window/parts/kept_sessions.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <safe_toml.h>
#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/base/one_bar.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/base/toml_text.h"
#include "burr/record/player.h"
#include "burr/record/rename_and_sync.h"
#include "burr/scenario/rack.h"
#include "burr/school/uuid.h"
#include "burr/sim/move_pieces.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/recorded_bone.h"
#include "shared/word_names.h"
#include "shared/work.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
constexpr std::uintmax_t kLargestFile = 1U << 18;  // of an account or a list  [byte]
constexpr std::size_t kRecent = 8;

std::tm local_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local = {};
  localtime_r(&now, &local);
  return local;
}

std::string word_of(const toml::table& table, const char* key) {
  return table[key].value_exact<std::string>().value_or(std::string());
}
double number_of(const toml::table& table, const char* key) {
  return table[key].value<double>().value_or(0.0);
}

Status write_text(const fs::path& path, const std::string& text) {
  auto file = base::NewFile::create(path.string());
  if (!file) return file.error();
  file->write(text);
  return file->put_in_place();
}

fs::path beside(const fs::path& recording, const char* ending) {
  fs::path account = recording;
  return account.replace_extension(ending);
}

json texts_to_json(const scenario::Texts& texts) {
  json object = json::object();
  for (const Language& one : languages())
    if (const std::string& text = texts.in(one.code); !text.empty()) object[one.code] = text;
  return object;
}

scenario::Texts texts_from_json(const json& object) {
  scenario::Texts texts;
  if (!object.is_object()) return texts;
  for (const auto& [code, text] : object.items())
    if (text.is_string()) texts.by_language[code] = text.get<std::string>();
  return texts;
}

bool read_account(const fs::path& account, KeptSession& kept) {
  const auto text = base::text_of_file(account.string(), kLargestFile, "an account of a session");
  if (!text) return false;
  const json object = json::parse(*text, nullptr, false);
  if (!object.is_object() || !object.contains("recipe")) return false;
  const auto recipe =
      scenario::recipe_from_json(object["recipe"].dump(), account.filename().string());
  if (!recipe) return false;
  const auto text_at = [&object](const char* key) {
    const auto at = object.find(key);
    return at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
  };
  const auto number = [&object](const char* key) {
    const auto at = object.find(key);
    return at != object.end() && at->is_number() ? at->get<double>() : 0.0;
  };
  const auto flag = [&object](const char* key) {
    const auto at = object.find(key);
    return at != object.end() && at->is_boolean() && at->get<bool>();
  };
  kept.title = text_at("title");
  kept.titles = texts_from_json(object.value("titles", json()));
  kept.name = text_at("name");
  kept.when = text_at("when");
  kept.suction = flag("suction");
  record::Identity& who = kept.options.identity;
  who.mode = record::mode_of(text_at("mode")).value_or(record::Mode::free);
  if (record::check_pseudonym(text_at("learner"))) who.learner = text_at("learner");
  who.attempt = static_cast<std::uint32_t>(std::clamp(number("attempt"), 0.0, 1e5));
  kept.seconds = number("seconds");
  kept.removed_mm3 = number("removed_mm3");
  kept.earlier = {number("seconds_before"), 1e-9 * number("removed_before_mm3")};
  kept.clean = flag("clean");
  kept.keep = flag("keep");
  kept.marks = flag("marks");
  kept.rubric = text_at("rubric");
  kept.options.volume = *recipe;
  kept.options.burr_mm = number("burr_mm");
  kept.options.rpm = number("rpm");
  return !recipe->source.empty();
}

// The format of burr before 2026-11-25: the options of the command line, as texts.
bool read_old_account(const fs::path& account, KeptSession& kept) {
  const auto text = base::text_of_file(account.string(), kLargestFile, "an account of a session");
  if (!text) return false;
  const auto table = parse_toml(*text, account.filename().string());
  if (!table) return false;
  kept.has_account = false;
  kept.title = word_of(*table, "title");
  kept.when = word_of(*table, "when");
  kept.seconds = number_of(*table, "seconds");
  kept.removed_mm3 = number_of(*table, "removed_mm3");
  kept.clean = (*table)["clean"].value_or(false);
  kept.keep = (*table)["keep"].value_or(false);
  scenario::BoneRecipe& recipe = kept.options.volume;
  recipe.source = word_of(*table, "source");
  recipe.series = word_of(*table, "series");
  recipe.labels = word_of(*table, "tissues");
  recipe.materials = word_of(*table, "materials");
  recipe.voxel_mm = number_of(*table, "voxel_mm");
  if (const auto spacing = scenario::parse_spacing(word_of(*table, "spacing_mm")))
    recipe.spacing_mm = *spacing;
  if (const auto region = scenario::parse_region(word_of(*table, "roi"))) recipe.region = *region;
  if (const auto level = scenario::parse_level(word_of(*table, "iso"))) recipe.iso = *level;
  kept.options.burr_mm = number_of(*table, "burr_mm");
  kept.options.rpm = number_of(*table, "rpm");
  return !recipe.source.empty();
}

// When it was worked on last, to the minute: "202611221931". An account without it leaves the time that the
// name of the file contains.
std::string minute_of(const KeptSession& kept) {
  std::string digits = kept.when.empty() ? kept.file.stem().string() : kept.when;
  std::erase_if(digits, [](char c) { return c < '0' || c > '9'; });
  return digits.substr(0, std::string_view("yyyymmddhhmm").size());
}

// The one that was worked on last comes first.
bool newer(const KeptSession& a, const KeptSession& b) {
  const std::string at = minute_of(a), bt = minute_of(b);
  return at != bt ? at > bt : a.file.filename() > b.file.filename();
}

}  // namespace

std::string time_now() { return fmt::format("{:%Y-%m-%d %H:%M}", local_now()); }
std::string name_now() { return fmt::format("session_{:%Y%m%d_%H%M%S}", local_now()); }

Status make_own_folder(const fs::path& folder) {
  std::error_code trouble;
  fs::create_directories(folder, trouble);
  if (!trouble) fs::permissions(folder, fs::perms::owner_all, trouble);
  if (!trouble) return fine();
  return error(Trouble::io, fmt::format("{}: cannot be made ({}); this session is not saved",
                                        folder.string(), trouble.message()));
}

fs::path picture_of(const fs::path& recording) { return beside(recording, ".ppm"); }

void remove_session(const fs::path& recording) {
  std::error_code nobody_asks;
  for (const fs::path& one : {recording, beside(recording, ".json"), beside(recording, ".toml"),
                              beside(recording, ".html"), picture_of(recording)})
    fs::remove(one, nobody_asks);
}

Status write_account(const KeptSession& kept) {
  const record::Identity& who = kept.options.identity;
  const json account = {{"title", kept.title},
                        {"titles", texts_to_json(kept.titles)},
                        {"name", kept.name},
                        {"when", kept.when},
                        {"recipe", json::parse(scenario::to_json(kept.options.volume))},
                        {"mode", record::word_of(who.mode)},
                        {"learner", who.learner},
                        {"attempt", who.attempt},
                        {"burr_mm", kept.options.burr_mm},
                        {"rpm", kept.options.rpm},
                        {"suction", kept.suction},
                        {"seconds", kept.seconds},
                        {"seconds_before", kept.earlier.seconds},
                        {"removed_before_mm3", 1e9 * kept.earlier.removed},
                        {"removed_mm3", kept.removed_mm3},
                        {"clean", kept.clean},
                        {"keep", kept.keep},
                        {"rubric", kept.rubric},
                        {"marks", kept.marks}};
  return write_text(beside(kept.file, ".json"),
                    account.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

std::string shown_title(const KeptSession& kept) {
  if (!kept.name.empty()) return kept.name;
  const std::string& title = kept.titles.in(spoken().code);
  return title.empty() ? name_of_work(kept.title) : title;
}

Status name_session(KeptSession& kept, const std::string& name) {
  if (!kept.has_account) return error(Trouble::usage, word(Word::session_no_name));
  const std::string before = std::exchange(kept.name, base::printable(name, kLongestName));
  const Status written = write_account(kept);
  if (!written) kept.name = before;
  return written;
}

std::vector<KeptSession> kept_sessions(const fs::path& state) {
  std::vector<KeptSession> all;
  std::error_code trouble;
  for (fs::directory_iterator at(state / "sessions", trouble), end; !trouble && at != end;
       at.increment(trouble)) {
    if (at->path().extension() != ".mcap") continue;
    KeptSession kept;
    kept.file = at->path();
    std::error_code nobody_asks;
    kept.bytes = fs::file_size(kept.file, nobody_asks);
    if (nobody_asks || record::being_written(kept.file.string())) continue;
    if (read_account(beside(kept.file, ".json"), kept) ||
        read_old_account(beside(kept.file, ".toml"), kept))
      all.push_back(std::move(kept));
  }
  std::sort(all.begin(), all.end(), [](const KeptSession& a, const KeptSession& b) {
    return a.clean != b.clean ? !a.clean : newer(a, b);
  });
  return all;
}

void throw_old_away(const fs::path& state, const Settings& settings, const fs::path& needed) {
  std::vector<KeptSession> all = kept_sessions(state);
  std::sort(all.begin(), all.end(), newer);
  double count = 0, mb = 0;
  for (const KeptSession& kept : all) {
    count += 1;
    mb += 1e-6 * static_cast<double>(kept.bytes);
    // the newest stays whatever its size, because the user may want to continue it
    if (kept.keep || kept.file == needed || count <= 1 ||
        (count <= settings.sessions_kept && mb <= settings.sessions_mb))
      continue;
    remove_session(kept.file);
  }
}

namespace {

// Time, volume and tool go on as they were at the end of the recording.
void go_on(record::Player& player, const KeptSession& kept, WorkOptions& options) {
  const auto last = player.tick_at(1e9);
  if (!last) return;  // it ended before its first tick
  options.earlier.seconds =
      kept.earlier.seconds +
      static_cast<double>(last->tick + 1 - player.first_tick()) / player.info().rate_hz;
  options.earlier.removed = kept.earlier.removed + last->ledger.removed - last->ledger.undone;
  const tool::ToolState& tool = last->tool;
  if (tool.radius <= 0) return;  // not known
  options.burr_mm = 2e3 * tool.radius;
  options.kind = tool.kind;
  options.mode = tool.mode;
  options.irrigated = tool.irrigated;  // also where the case says otherwise
  const std::vector<tool::ShapedTool>& tools = player.info().tools;
  options.tool.tool.clear();  // a tool that the rack no longer has gives way to the round burr
  if (tool.number < 0) options.rpm = tool.full_speed * 60 / (2 * std::numbers::pi);
  if (tool.number < 0 || tool.number >= static_cast<int>(tools.size())) return;
  const std::string& name = tools[static_cast<std::size_t>(tool.number)].name;
  if (scenario::built_in_rack().find(name) != nullptr) options.tool.tool = name;
}

// What the recording says of the session beside its ticks: it goes on.
void take_up(record::Player& player, const KeptSession& kept, LeftSession& left) {
  left.suction = kept.suction;
  left.course = player.course();
  for (const record::CourseEvent& event : left.course) {
    if (event.kind == record::CourseKind::done) left.declared_done = true;
    if (event.kind == record::CourseKind::reopened) left.declared_done = false;
  }
  auto part = player.earlier_part();
  if (!part) return;
  if (const auto hash = school::sha1_of_file(player.path())) part->sha1 = *hash;
  left.part = std::make_shared<const record::EarlierPart>(std::move(*part));
}

// The case comes from the recording, because its file may have changed or be gone; only its volume is
// known by the file.
Status take_recorded_case(const record::SessionInfo& recorded, WorkOptions& options) {
  const Result<scenario::Case> work =
      recorded.work_case ? record::case_of(recorded) : error("no case");
  if (!work || !work->volume.empty()) return take_case(options);
  take_case(options, *work);
  return fine();
}

}  // namespace

Result<WindowSession> continue_session(const KeptSession& kept, Progress& whole) {
  WorkOptions options = kept.options;
  auto player = record::Player::open(kept.file.string());
  if (!player) return player.error();
  const record::SessionInfo& recorded = (*player)->info();
  if (recorded.identity) options.identity = *recorded.identity;
  if (const Status taken = take_recorded_case(recorded, options); !taken) return taken.error();
  base::OneBar progress(whole, workshop::steps_to_picture(options.volume));

  // the recording leads to a formula or an embedded bone; a scan is found by the user's own path
  std::error_code nobody_asks;
  const bool scan = fs::exists(options.volume.source, nobody_asks);
  scenario::BoneRecipe given = options.volume;
  if (recorded.embedded || !scan) given.source.clear();
  auto bone = workshop::bone_of(**player, given, progress);
  if (!bone) return bone.error();
  workshop::PreparedBone work;
  // the work place is that of the bone before it was cut
  auto place = surgeon::find_work_place(**bone, 0.5e-3 * options.burr_mm, options.at, options.into);
  if (!place) return place.error();
  work.place = *place;
  LeftSession left;
  if (sim::moves_pieces(**player)) {
    auto pieces = sim::moved_in(**player, **bone);
    if (!pieces) return pieces.error();
    left.pieces = std::move(*pieces);
    left.pieces.none_is_out();
  }
  const Status there = (*player)->bone_at(1e9, **bone);
  if (!there) return there.error();
  work.bone = std::move(*bone);
  take_up(**player, kept, left);
  // what was handed in is not worked on further; without an exam one learns from it
  if (options.identity.mode == record::Mode::exam && left.declared_done)
    return error(Trouble::usage, word(Word::exam_handed_in));
  go_on(**player, kept, options);
  if (scan) work.greys = workshop::greys_of(**player, options.volume, progress);
  const std::string& format = recorded.volume.format;
  work.summary.format = format.empty() ? "recording" : format;
  work.recipe = options.volume;
  workshop::fit_burr(options.burr_mm, work.bone->grid().voxel, work.summary.notices);
  work.what = kept.title;
  if (options.title.empty()) options.title = kept.title;
  auto ready = make_window_session(options, std::move(work), progress);
  if (ready) ready->left = std::move(left);
  return ready;
}

// ---- scans opened recently

namespace {

scenario::Texts titles_of(const toml::table& one) {
  scenario::Texts titles;
  for (const Language& language : languages())
    if (std::string text = word_of(one, ("title_" + language.code).c_str()); !text.empty())
      titles.by_language[language.code] = std::move(text);
  return titles;
}

std::string titles_text(const scenario::Texts& titles) {
  std::string text;
  for (const Language& one : languages())
    if (const std::string& title = titles.in(one.code); !title.empty())
      text += fmt::format("title_{} = {}\n", one.code, base::toml_text(title));
  return text;
}

}  // namespace

std::vector<Recent> recent(const fs::path& state) {
  std::vector<Recent> all;
  std::error_code nobody_asks;
  const fs::path path = state / "recent.toml";
  if (state.empty() || !fs::exists(path, nobody_asks)) return all;
  const auto text = base::text_of_file(path.string(), kLargestFile, "a list of scans");
  if (!text) return all;
  const auto table = parse_toml(*text, "recent.toml");
  if (!table) return all;
  const toml::array* list = (*table)["scan"].as_array();
  for (std::size_t n = 0; list != nullptr && n < list->size() && n < kRecent; ++n)
    if (const toml::table* one = (*list)[n].as_table())
      if (const std::string where = word_of(*one, "path"); fs::exists(where, nobody_asks))
        all.push_back({where, word_of(*one, "title"), word_of(*one, "when"), titles_of(*one)});
  return all;
}

void remember(const fs::path& state, const std::string& path, const std::string& title,
              const scenario::Texts& titles) {
  if (state.empty() || !make_own_folder(state)) return;
  std::error_code nobody_asks;
  const std::string whole = fs::absolute(path, nobody_asks).string();
  std::vector<Recent> all = recent(state);
  std::erase_if(all, [&](const Recent& one) { return one.path == whole; });
  all.insert(all.begin(), {whole, title, time_now(), titles});
  if (all.size() > kRecent) all.resize(kRecent);
  std::string text = "# Scans opened lately in burr's window.\n";
  for (const Recent& one : all)
    text += fmt::format("\n[[scan]]\npath = {}\ntitle = {}\nwhen = {}\n", base::toml_text(one.path),
                        base::toml_text(one.title), base::toml_text(one.when)) +
            titles_text(one.titles);
  static_cast<void>(write_text(state / "recent.toml", text));  // a missing list does no harm
}

}  // namespace burr::app
