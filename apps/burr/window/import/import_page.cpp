#include "window/import/import_page.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <system_error>
#include <utility>

#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "shared/work.h"
#include "window/import/notice_words.h"
#include "window/import/series_page.h"

namespace burr::app {
namespace {

using volume::TissueKind;

bool number_of(std::string text, double& value) {
  std::erase(text, ' ');
  std::replace(text.begin(), text.end(), ',', '.');
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && std::isfinite(value);
}

}  // namespace

// ---- the choices

ImportPage::ImportPage(Desk& desk, OpenedScan opened)
    : desk_(desk), opened_(std::move(opened)), volume_(opened_.volume), renewed_(desk.renewed()) {
  const io::Scan& scan = *opened_.scan;
  const auto box = box_of(scan, volume_.region);
  box_ = box ? *box : whole(scan);
  for (std::size_t a = 0; a < 3; ++a) slice_[a] = scan.size[static_cast<int>(a)] / 2;
  const std::array<PlaneView, 3> planes = planes_of(scan.axes);
  for (std::size_t n = 0; n < 3; ++n) views_[n].plane = planes[n];
  labels_ = choices_of(opened_.labels);
  if (opened_.planned)
    planned_ = *opened_.planned;
  else
    plan_trouble_ = opened_.planned.error().text;
  level_ = volume_.iso;
  show_region();
  show_spacing();
  if (volume_.voxel_mm > 0) voxel_text_ = number_text(volume_.voxel_mm);
  if (const auto now = level()) iso_text_ = number_text(*now);
}

ImportPage::~ImportPage() {
  counting_.reset();
  planning_.reset();
  forget_table();
}

std::optional<double> ImportPage::level() const {
  if (opened_.scan->values.empty()) return std::nullopt;
  if (level_) return level_;
  if (planned_) {
    // an estimated level has more digits than are useful
    const double step = 0.01 * opened_.greys.step();
    return std::round(planned_->import.iso / step) * step;
  }
  return std::nullopt;
}

std::string ImportPage::unit_of_values() const { return opened_.scan->hounsfield ? " HU" : ""; }

void ImportPage::changed() {
  stale_ = true;
  recount_ = true;
  trouble_.clear();
}

void ImportPage::set_level(double wanted) {
  const double step = opened_.greys.step();
  // 1300 * 0.001 is 1.3, not 1.3000000000000003
  level_ = step < 1 ? std::round(wanted / step) / std::round(1 / step)
                    : std::round(wanted / step) * step;
  volume_.iso = level_;
  iso_text_ = number_text(*level_);
  for (View& view : views_) view.coloured = false;
  changed();
}

void ImportPage::take_level() {
  double wanted = 0;
  const bool good = number_of(iso_text_, wanted);
  const auto now = level();
  if (!good) trouble_ = say(Word::import_no_number, iso_text_);
  if (good && wanted != now) {
    level_ = wanted;
    volume_.iso = wanted;
    for (View& view : views_) view.coloured = false;
    changed();
  }
  iso_text_ = good ? number_text(wanted) : now ? number_text(*now) : "";
}

void ImportPage::set_box(const Box& box) {
  if (box == box_) return;
  box_ = box;
  volume_.region = region_of(*opened_.scan, box_);
  show_region();
  changed();
}

void ImportPage::show_region() {
  roi_text_ = volume_.region ? scenario::region_text(*volume_.region) : "";
}

void ImportPage::take_roi() {
  std::optional<scenario::Region> region;
  if (!roi_text_.empty()) {
    const auto read = scenario::parse_region(roi_text_);
    if (!read) {
      trouble_ = read.error().text;
      return show_region();
    }
    region = *read;
  }
  const auto box = box_of(*opened_.scan, region);
  if (!box)
    trouble_ = box.error().text;
  else
    set_box(*box);
  show_region();
}

void ImportPage::take_voxel() {
  double wanted = 0;
  if (!voxel_text_.empty() && (!number_of(voxel_text_, wanted) || wanted <= 0)) {
    trouble_ = say(Word::import_no_number, voxel_text_);
  } else if (wanted != volume_.voxel_mm) {
    volume_.voxel_mm = wanted;
    changed();
  }
  voxel_text_ = volume_.voxel_mm > 0 ? number_text(volume_.voxel_mm) : "";
}

void ImportPage::show_spacing() {
  const math::Vec3& mm = opened_.scan->spacing_mm;
  spacing_text_ = fmt::format("{:.4g}, {:.4g}, {:.4g}", mm.x(), mm.y(), mm.z());
}

// The scan is read again with the edges that the user typed: three numbers, or one for cubes.
void ImportPage::take_spacing() {
  std::string text = spacing_text_;
  for (std::size_t at; (at = text.find("×")) != std::string::npos;)
    text.replace(at, std::string("×").size(), ",");
  std::replace(text.begin(), text.end(), 'x', ',');
  double edge = 0;
  if (text.find_first_of(",;") == std::string::npos && number_of(text, edge))
    text = fmt::format("{0},{0},{0}", edge);
  std::replace(text.begin(), text.end(), ';', ',');
  const auto wanted = scenario::parse_spacing(text);
  if (!wanted) {
    trouble_ = say(Word::import_no_number, spacing_text_);
    return show_spacing();
  }
  const std::string before = spacing_text_;
  show_spacing();
  if (before == spacing_text_ || *wanted == opened_.scan->spacing_mm) return;
  volume_.spacing_mm = *wanted;
  decide(Answer::other_spacing);
}

bool ImportPage::asked() const {
  const auto& all = opened_.scan->questions;
  return std::any_of(all.begin(), all.end(), [&](const io::Question& question) {
    return !importing::answered(question, volume_);
  });
}

void ImportPage::take_as_it_is() {
  for (const io::Question& question : opened_.scan->questions) switch (question.ask) {
      case io::Ask::missing:
      case io::Ask::absent:
        volume_.allow_missing = true;
        break;
      case io::Ask::spacing:
        volume_.spacing_mm = opened_.scan->spacing_mm;
        break;
      case io::Ask::doubt:
        volume_.as_it_is = true;
        break;
      case io::Ask::volume:
        volume_.series = fmt::format("#{}", opened_.scan->series_taken + 1);
        break;
    }
  changed();
}

void ImportPage::take_labels(std::vector<LabelChoice> wanted) {
  const std::string table = table_of(opened_.labels, wanted);
  KeptTable kept{opened_.volume.labels, false};
  if (!table.empty()) {
    std::error_code nobody_asks;
    const std::filesystem::path& state = desk_.places().state;
    auto written =
        keep_table(state.empty() ? std::filesystem::temp_directory_path(nobody_asks) / "burr_labels"
                                 : state / "labels",
                   table);
    if (!written) {
      trouble_ = written.error().text;
      return;
    }
    kept = std::move(*written);
  }
  // they may still read the table that is removed next
  planning_.reset();
  counting_.reset();
  forget_table();
  if (kept.fresh) own_table_ = kept.path;
  volume_.labels = kept.path.string();
  labels_ = std::move(wanted);
  for (View& view : views_) view.coloured = false;
  changed();
}

void ImportPage::forget_table() {
  std::error_code nobody_asks;
  if (!own_table_.empty()) std::filesystem::remove(own_table_, nobody_asks);
  own_table_.clear();
}

// ---- mouse positions become voxels

Result<ImportPage::Answer> ImportPage::ask(const std::string& ask, double seconds) {
  using Clock = std::chrono::steady_clock;
  trouble_ = ask;
  answer_.reset();
  starting_ = false;
  series_.clear();
  desk_.page = Page::import;
  SDL_StartTextInput();
  const render::Scene empty;
  const Clock::time_point start = Clock::now();
  while (!answer_) {
    const Clock::time_point frame = Clock::now();
    take_events();
    work();
    const Status shown = desk_.show(
        empty, [this] { draw(); }, true);
    if (!shown) return shown.error();
    const bool over = seconds > 0 && Clock::now() - start >= std::chrono::duration<double>(seconds);
    if (interrupted() || over) answer_ = Answer::closed;
    const auto left = std::chrono::milliseconds(33) - (Clock::now() - frame);
    if (left.count() > 0)
      SDL_Delay(
          static_cast<Uint32>(std::chrono::duration_cast<std::chrono::milliseconds>(left).count()));
  }
  SDL_StopTextInput();
  counting_.reset();  // the processor and the memory are for what comes next
  if (*answer_ == Answer::start) own_table_.clear();  // the session needs the file from now on
  desk_.message.clear();
  return *answer_;
}

void ImportPage::take_events() {
  SDL_Event event;
  while (desk_.next(event)) {
    if (event.type == SDL_QUIT) answer_ = Answer::closed;
    if (event.type == SDL_DROPFILE) SDL_free(event.drop.file);
    if (event.type != SDL_KEYDOWN || desk_.ui().typing()) continue;
    const SDL_Keycode key = event.key.keysym.sym;
    if (key == SDLK_ESCAPE) decide(Answer::back);
    if (key == SDLK_RETURN || key == SDLK_KP_ENTER) decide(Answer::start);
  }
}

void ImportPage::decide(Answer answer) {
  if (answer != Answer::start) {
    answer_ = answer;
    return;
  }
  starting_ = true;  // the session starts as soon as the plan is found to be possible
  trouble_.clear();  // a field with an error has been set back
}

void ImportPage::work() {
  if (planning_ && planning_->finished()) {
    auto planned = planning_->take();
    planning_.reset();
    if (!stale_) {
      if (planned) planned_ = std::move(*planned);
      plan_trouble_ = planned ? std::string() : planned.error().text;
      if (const auto now = level(); now && !level_ && !desk_.ui().typing())
        iso_text_ = number_text(*now);
    }
  }
  // not while the mouse drags something: the preview needs the processor
  if (stale_ && !planning_ && !ImGui::IsMouseDown(0)) {
    stale_ = false;
    planning_ = std::make_unique<Loading<Planned>>(
        [scan = opened_.scan, options = volume_](Progress& /*unused*/) {
          return plan_session(*scan, options);
        });
  }
  count();
  if (starting_ && !stale_ && !planning_) {
    starting_ = false;
    if (plan_trouble_.empty()) answer_ = Answer::start;
  }
  desk_.message = trouble_words(!trouble_.empty()        ? trouble_
                                : !plan_trouble_.empty() ? plan_trouble_
                                                         : parts_trouble_);
}

// ---- all steps

namespace {

Result<OpenedScan> read_by_page(Desk& desk, const scenario::BoneRecipe& volume,
                                const std::string& title, bool& closed) {
  return load<OpenedScan>(
      desk, title, [volume](Progress& progress) { return open_scan(volume, progress); }, closed);
}

// Of several series the user chooses one; `opened` becomes that.
Status choose_series(Desk& desk, OpenedScan& opened, const std::string& title, double seconds,
                     bool& closed) {
  Result<SeriesPage::Choice> choice = SeriesPage(desk, opened).ask(seconds);
  if (!choice) return choice.error();
  closed = choice->closed;
  if (closed) return fine();
  if (!choice->series) return error(Trouble::interrupted, "stopped");
  scenario::BoneRecipe other = opened.volume;
  other.series = fmt::format("#{}", *choice->series + 1);
  if (*choice->series == static_cast<std::size_t>(opened.scan->series_taken)) {
    const auto& asked = opened.scan->questions;  // of a file of several volumes: which one
    if (std::any_of(asked.begin(), asked.end(),
                    [](const io::Question& one) { return one.ask == io::Ask::volume; }))
      opened.volume.series = other.series;
    return fine();
  }
  auto reopened = read_by_page(desk, other, title, closed);
  if (closed) return fine();
  if (!reopened) return reopened.error();
  opened = std::move(*reopened);
  return fine();
}

Result<WindowSession> ready_from(WorkOptions options, const io::Scan& scan, Progress& whole) {
  if (const Status taken = take_case(options); !taken) return taken.error();
  options.keep_greys = true;
  base::OneBar progress(whole, workshop::steps_to_picture(options.volume, true));
  auto work = open_work(options, progress, &scan);
  if (!work) return work.error();
  return make_window_session(options, std::move(*work), progress);
}

}  // namespace

Result<WindowSession> open_by_page(Desk& desk, WorkOptions& options, const std::string& title,
                                   double seconds, bool& closed) {
  const Error gone = error(Trouble::interrupted, "stopped");
  auto opened = read_by_page(desk, options.volume, title, closed);
  if (!opened) return opened.error();
  if (closed) return gone;
  if (opened->scan->series.size() > 1 && options.volume.series.empty()) {
    if (const Status chosen = choose_series(desk, *opened, title, seconds, closed); !chosen)
      return chosen.error();
    if (closed) return gone;
  }
  auto page = std::make_unique<ImportPage>(desk, std::move(*opened));
  std::string trouble;
  for (;;) {
    const auto answer = page->ask(trouble, seconds);
    if (!answer) return answer.error();
    trouble.clear();
    if (*answer == ImportPage::Answer::closed) {
      closed = true;
      return gone;
    }
    if (*answer == ImportPage::Answer::back) return gone;
    if (*answer == ImportPage::Answer::other_series ||
        *answer == ImportPage::Answer::other_spacing) {
      const bool series = *answer == ImportPage::Answer::other_series;
      scenario::BoneRecipe other = series ? options.volume : page->volume();
      if (series) other.series = page->series();
      auto reopened = read_by_page(desk, other, title, closed);
      if (closed) return gone;
      if (reopened)
        page = std::make_unique<ImportPage>(desk, std::move(*reopened));
      else if (reopened.error().trouble != Trouble::interrupted)
        trouble = reopened.error().text;
      continue;
    }
    WorkOptions chosen = options;
    chosen.volume = page->volume();
    Result<WindowSession> ready = load<WindowSession>(
        desk, title,
        [chosen, scan = page->scan()](Progress& progress) {
          return ready_from(chosen, *scan, progress);
        },
        closed);
    if (closed) return gone;
    if (ready) {
      options = chosen;
      return ready;
    }
    if (ready.error().trouble != Trouble::interrupted) trouble = ready.error().text;
  }
}

}  // namespace burr::app
