#include "window/parts/kept_sessions.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <safe_toml.h>
#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>
#include <numbers>
#include <system_error>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/base/text_file.h"
#include "burr/base/toml_text.h"
#include "burr/record/player.h"
#include "burr/record/rename_and_sync.h"
#include "burr/report/questions.h"
#include "burr/scenario/rack.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "shared/front_words.h"
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

// Creates a folder that only its owner can read.
Status make_folder(const fs::path& folder) {
  std::error_code trouble;
  fs::create_directories(folder, trouble);
  if (!trouble) fs::permissions(folder, fs::perms::owner_all, trouble);
  if (!trouble) return fine();
  return error(Trouble::io, fmt::format("{}: cannot be made ({}); this session is not saved",
                                        folder.string(), trouble.message()));
}

fs::path beside(const fs::path& recording, const char* ending) {
  fs::path account = recording;
  return account.replace_extension(ending);
}

void remove_session(const fs::path& recording) {
  std::error_code nobody_asks;
  for (const fs::path& one : {recording, beside(recording, ".json"), beside(recording, ".toml"),
                              beside(recording, ".html")})
    fs::remove(one, nobody_asks);
}

bool read_account(const fs::path& account, KeptSession& kept) {
  const auto text = base::text_of_file(account.string(), kLargestFile, "an account of a session");
  if (!text) return false;
  const json object = json::parse(*text, nullptr, false);
  if (!object.is_object() || !object.contains("recipe")) return false;
  const auto recipe =
      scenario::recipe_from_json(object["recipe"].dump(), account.filename().string());
  if (!recipe) return false;
  const auto word = [&object](const char* key) {
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
  kept.title = word("title");
  kept.when = word("when");
  kept.seconds = number("seconds");
  kept.removed_mm3 = number("removed_mm3");
  kept.earlier = {number("seconds_before"), 1e-9 * number("removed_before_mm3")};
  kept.clean = flag("clean");
  kept.keep = flag("keep");
  kept.marks = flag("marks");
  kept.rubric = word("rubric");
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

}  // namespace

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
  // the names contain the time
  std::sort(all.begin(), all.end(), [](const KeptSession& a, const KeptSession& b) {
    return a.clean != b.clean ? !a.clean : a.file.filename() > b.file.filename();
  });
  return all;
}

void throw_old_away(const fs::path& state, const Settings& settings) {
  std::vector<KeptSession> all = kept_sessions(state);
  std::sort(all.begin(), all.end(), [](const KeptSession& a, const KeptSession& b) {
    return a.file.filename() > b.file.filename();
  });
  double count = 0, mb = 0;
  for (const KeptSession& kept : all) {
    count += 1;
    mb += 1e-6 * static_cast<double>(kept.bytes);
    // the newest stays whatever its size, because the user may want to continue it
    if (kept.keep || count <= 1 || (count <= settings.sessions_kept && mb <= settings.sessions_mb))
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
  options.irrigated = tool.irrigated;
  const std::vector<tool::ShapedTool>& tools = player.info().tools;
  options.tool.tool.clear();  // a tool that the rack no longer has gives way to the round burr
  if (tool.number < 0) options.rpm = tool.full_speed * 60 / (2 * std::numbers::pi);
  if (tool.number < 0 || tool.number >= static_cast<int>(tools.size())) return;
  const std::string& name = tools[static_cast<std::size_t>(tool.number)].name;
  if (scenario::built_in_rack().find(name) != nullptr) options.tool.tool = name;
}

}  // namespace

Result<WindowSession> continue_session(const KeptSession& kept, Progress& progress) {
  WorkOptions options = kept.options;
  auto player = record::Player::open(kept.file.string());
  if (!player) return player.error();
  // the case comes from the recording, because its file may have changed or be gone; only its
  // volume is known by the file
  const record::SessionInfo& recorded = (*player)->info();
  Result<scenario::Case> work_case =
      recorded.work_case ? record::case_of(recorded) : error("no case");
  if (work_case && work_case->volume.empty()) {
    take_case(options, *work_case);
  } else {
    const Status taken = take_case(options);
    if (!taken) return taken.error();
  }

  // the recording leads to a formula or an embedded bone; a scan is found by the user's own path
  std::error_code nobody_asks;
  const bool scan = fs::exists(options.volume.source, nobody_asks);
  scenario::BoneRecipe given = options.volume;
  if ((*player)->info().embedded || !scan) given.source.clear();
  auto bone = workshop::bone_of(**player, given, progress);
  if (!bone) return bone.error();
  workshop::PreparedBone work;
  // the work place is that of the bone before it was cut
  auto place = surgeon::find_work_place(**bone, 0.5e-3 * options.burr_mm, options.at, options.into);
  if (!place) return place.error();
  work.place = *place;
  const Status there = (*player)->bone_at(1e9, **bone);
  if (!there) return there.error();
  work.bone = std::move(*bone);
  go_on(**player, kept, options);
  if (scan) work.greys = workshop::greys_of(**player, options.volume, progress);
  const std::string& format = (*player)->info().volume.format;
  work.summary.format = format.empty() ? "recording" : format;
  work.recipe = options.volume;
  workshop::fit_burr(options.burr_mm, work.bone->grid().voxel, work.summary.notices);
  work.what = kept.title;
  if (options.title.empty()) options.title = kept.title;
  return make_window_session(options, std::move(work), progress);
}

// ---- a session being kept

Autosave::Autosave(const fs::path& state, WindowSession& ready, const WorkOptions& options,
                   bool embed, const Settings& settings)
    : session_(*ready.session) {
  if (state.empty()) return;
  const fs::path folder = state / "sessions";
  Status made = make_folder(folder);
  if (made) {
    kept_.title = ready.title;
    kept_.options = options;
    kept_.earlier = ready.earlier;
    kept_.marks =
        ready.work_case && ready.allowed.marks && !report::questions_on(*ready.work_case).empty();
    std::error_code nobody_asks;
    if (ready.work_case) kept_.rubric = report::rubric_of(*ready.work_case);
    if (const fs::path there = fs::absolute(kept_.rubric, nobody_asks);
        fs::exists(kept_.rubric, nobody_asks))
      kept_.rubric = there.string();
    if (const fs::path there = fs::absolute(options.volume.source, nobody_asks);
        fs::exists(options.volume.source, nobody_asks))
      kept_.options.volume.source = there.string();
    const std::tm now = local_now();
    kept_.when = fmt::format("{:%Y-%m-%d %H:%M}", now);
    const std::string name = fmt::format("session_{:%Y%m%d_%H%M%S}", now);
    kept_.file = folder / (name + ".mcap");
    for (int n = 2; fs::exists(kept_.file, nobody_asks); ++n)  // started in the same second
      kept_.file = folder / fmt::format("{}_{}.mcap", name, n);
    recording_.remember_scan_in(scan_list_by(settings, state));
    recording_.belongs_to(options.identity);
    made = recording_.start(session_, kept_.file.string(), ready.volume, ready.import,
                            session_.hand().spec().name, embed, ready.spared, ready.work_case);
    recording_now_ = made.ok();
  }
  if (made) made = write_account();
  if (!made) trouble_ = in_options(made.error()).text;
}

std::optional<FilmSource> Autosave::film_source() const {
  if (!recording_now_) return std::nullopt;
  return film_of(session_, kept_.file.string(), kept_.options.volume);
}

Status Autosave::write_account() const {
  const json account = {{"title", kept_.title},
                        {"when", kept_.when},
                        {"recipe", json::parse(scenario::to_json(kept_.options.volume))},
                        {"burr_mm", kept_.options.burr_mm},
                        {"rpm", kept_.options.rpm},
                        {"seconds", kept_.seconds},
                        {"seconds_before", kept_.earlier.seconds},
                        {"removed_before_mm3", 1e9 * kept_.earlier.removed},
                        {"removed_mm3", kept_.removed_mm3},
                        {"clean", kept_.clean},
                        {"keep", kept_.keep},
                        {"rubric", kept_.rubric},
                        {"marks", kept_.marks}};
  return write_text(beside(kept_.file, ".json"),
                    account.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

Status Autosave::finish() {
  if (!std::exchange(recording_now_, false))
    return trouble_.empty() ? fine() : error(Trouble::io, trouble_);
  Status done = recording_.finish(session_);
  const sim::Outcome outcome = session_.outcome();
  kept_.seconds = kept_.earlier.seconds + outcome.seconds;
  kept_.removed_mm3 =
      1e9 * (kept_.earlier.removed + outcome.ledger.removed - outcome.ledger.undone);
  kept_.clean = true;
  const Status written = write_account();
  if (done) done = written;
  if (!done) trouble_ = in_options(done.error()).text;
  is_kept_ = outcome.ledger.removed > 0 || outcome.ledger.added > 0 || kept_.keep;
  if (is_kept_) return done;
  remove_session(kept_.file);  // nothing was done: there is nothing to continue
  return fine();
}

bool Autosave::keep() {
  if (!recording_now_ || !trouble().empty()) return false;
  kept_.keep = true;
  return write_account().ok();
}

std::string Autosave::trouble() const {
  return trouble_.empty() && recording_now_ ? recording_.trouble() : trouble_;
}

// ---- scans opened recently

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
        all.push_back({where, word_of(*one, "title"), word_of(*one, "when")});
  return all;
}

void remember(const fs::path& state, const std::string& path, const std::string& title) {
  if (state.empty() || !make_folder(state)) return;
  std::error_code nobody_asks;
  const std::string whole = fs::absolute(path, nobody_asks).string();
  std::vector<Recent> all = recent(state);
  std::erase_if(all, [&](const Recent& one) { return one.path == whole; });
  all.insert(all.begin(), {whole, title, fmt::format("{:%Y-%m-%d %H:%M}", local_now())});
  if (all.size() > kRecent) all.resize(kRecent);
  std::string text = "# Scans opened lately in burr's window.\n";
  for (const Recent& one : all)
    text += fmt::format("\n[[scan]]\npath = {}\ntitle = {}\nwhen = {}\n", base::toml_text(one.path),
                        base::toml_text(one.title), base::toml_text(one.when));
  static_cast<void>(write_text(state / "recent.toml", text));  // a missing list does no harm
}

}  // namespace burr::app
