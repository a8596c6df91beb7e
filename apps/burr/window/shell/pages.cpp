#include "window/shell/pages.h"

#include <fmt/core.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "burr/base/one_bar.h"
#include "burr/render/picture.h"
#include "burr/tick/second_hand.h"
#include "burr/workshop/open_bone.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "shared/work.h"
#include "window/import/import_page.h"
#include "window/import/notice_words.h"
#include "window/mill/mill_keys.h"
#include "window/mill/window.h"
#include "window/parts/autosave.h"
#include "window/parts/kept_sessions.h"
#include "window/rate/rate_page.h"
#include "window/replay/playback.h"
#include "window/review/enter_session.h"
#include "window/review/review.h"
#include "window/shell/review_session.h"
#include "window/start/start_page.h"
#include "window/ui/loading.h"

namespace burr::app {
namespace {

// a title without the name of a patient
std::string title_of(const WorkOptions& options, const Settings& settings) {
  const std::string& path = options.volume.source;
  const std::string known = name_of_case(path);
  if (known != path || path.find('/') == std::string::npos) return known;
  const std::filesystem::path file(path);
  if (settings.recent_names) return file.filename().string();
  return word(file.extension() == ".toml" ? Word::start_case_file : Word::start_scan);
}

// What the program ends with.
Status leave_screenshot(Desk& desk, const std::string& file) {
  const Status left = file.empty() ? fine() : render::write_png(desk.renderer().shown(), file);
  return left ? desk.lost : left;
}

}  // namespace

std::string title_of(const WindowSession& ready) {
  const std::string title = ready.lesson ? ready.lesson->title.in(spoken().code) : std::string();
  return title.empty() ? name_of_work(ready.title) : title;
}

Result<WindowSession> open_ready(WorkOptions options, Progress& whole) {
  const Status taken = take_case(options);
  if (!taken) return taken.error();
  options.keep_greys = true;
  base::OneBar progress(whole, workshop::steps_to_picture(options.volume));
  auto work = open_work(options, progress);
  if (!work) return work.error();
  return make_window_session(options, std::move(*work), progress);
}

Result<Closed> mill_with_sound(Desk& desk, WindowSession& ready, const WindowOptions& window) {
  WindowOptions with = window;
  with.spared_distance = ready.spared_distance.get();
  with.title = title_of(ready);
  with.earlier = ready.earlier;
  with.left = ready.left;
  with.greys = ready.greys;
  with.rack = ready.rack;
  with.work_case = ready.work_case;
  with.lesson = ready.lesson;
  with.mode = ready.mode;
  with.allowed = ready.allowed;
  std::unique_ptr<Loudspeaker> loudspeaker;
  if (window.sound) {
    const tick::SecondHand* second = ready.session->second_hand();
    const tool::ShapedTool* tool =
        second != nullptr && second->settings().tool ? &*second->settings().tool : nullptr;
    loudspeaker = std::make_unique<Loudspeaker>(ready.session->settings().servo,
                                                ready.spared_distance->distances(),
                                                ready.allowed.tone_below, tool);
    if (!loudspeaker->trouble().empty()) fmt::print(stderr, "{}\n", loudspeaker->trouble());
    with.loudspeaker = loudspeaker.get();
  }
  auto left = mill(desk, *ready.session, ready.hands, *ready.worker, ready.scene, with);
  if (desk.session_over)
    desk.session_over(ready.session->outcome().seconds, left && *left == Closed::done);
  return left;
}

namespace {

// The bone as it is now, for the list of sessions.
void keep_picture(Desk& desk, const WindowSession& ready, Autosave& autosave) {
  constexpr int kWide = 160, kHigh = 90;  // [pixel]
  render::Scene scene = ready.scene;
  scene.burr.visible = false;
  scene.insets.clear();
  if (const auto small = desk.renderer().image(scene, kWide, kHigh)) autosave.take_picture(*small);
}

// What the page for milling gets of the recording.
WindowOptions with_recording(Desk& desk, const WindowOptions& window, const WindowSession& ready,
                             Autosave* autosave) {
  WindowOptions with = window;
  with.diary = autosave != nullptr ? autosave->diary() : nullptr;
  with.done_ends = (autosave == nullptr || !autosave->is_part()) && ready.work_case &&
                   has_marks(*ready.work_case);
  with.keep = [autosave] { return autosave != nullptr && autosave->keep(); };
  with.left_as = [autosave] {
    return autosave != nullptr && autosave->diary() != nullptr && autosave->trouble().empty()
               ? Word::leave_told_kept
               : Word::leave_told_lost;
  };
  with.suction_left = [autosave](bool on) {
    if (autosave != nullptr) autosave->suction_is(on);
  };
  with.film_of = [autosave, &desk]() -> std::optional<FilmSource> {
    std::optional<FilmSource> source = autosave != nullptr ? autosave->film_source() : std::nullopt;
    if (source) source->effects = desk.settings.effects;
    return source;
  };
  with.warning = [autosave, told = window.warning] {
    std::string warning = told ? told() : std::string();
    if (warning.empty() && autosave != nullptr) warning = autosave->trouble();
    return warning;
  };
  return with;
}

}  // namespace

Result<Closed> mill_and_keep(Desk& desk, WindowSession& ready, const WorkOptions& options,
                             const KeptSession* goes_on, const WindowOptions& window) {
  const scenario::Case* work = ready.work_case ? &*ready.work_case : nullptr;
  const auto sealer = goes_on == nullptr ? sealer_for(desk, ready.identity, work) : nullptr;
  std::unique_ptr<Autosave> autosave;
  if (desk.settings.autosave && !desk.places().state.empty()) {
    throw_old_away(desk.places().state, desk.settings,
                   goes_on != nullptr ? goes_on->file : std::filesystem::path());
    autosave = std::make_unique<Autosave>(desk.places().state, ready, options, desk.settings,
                                          goes_on, sealer);
    if (!autosave->apart().empty()) desk.troubles.push_back(autosave->apart());
  }
  // a recording with a part of the session has no marks
  const bool enters = autosave && autosave->diary() != nullptr && !autosave->is_part();
  const std::string file = enters ? autosave->file().string() : std::string();
  if (enters) session_begins(desk, file, ready.identity, work);
  const WindowOptions with = with_recording(desk, window, ready, autosave.get());
  Result<Closed> left = mill_with_sound(desk, ready, with);
  const bool done = left && *left == Closed::done;
  Result<bool> stays = true;
  if (done) stays = ask_own_marks(desk, ready, *with.diary, window);
  if (autosave) {
    keep_picture(desk, ready, *autosave);
    if (const Status kept = autosave->finish(); !kept) desk.lost = kept;
    tell_of_seal(desk, sealer);
  }
  // one that ended early, on a full disk, counts with what it holds
  std::error_code nobody_asks;
  if (enters)
    session_ended(desk, file, ready.identity, work, std::filesystem::exists(file, nobody_asks));
  if (!done) return left;
  if (!stays) return stays.error();
  if (!*stays) return Closed::window;
  if (!desk.lost || autosave->kept_file().empty()) return Closed::page;
  return review_session(desk, {.file = autosave->kept_file(),
                               .title = title_of(ready),
                               .rubric = rubric_for(*ready.work_case),
                               .volume = options.volume,
                               .marks = ready.allowed.marks,
                               .repeats = true,
                               .seconds = window.seconds,
                               .folder = window.folder,
                               .screenshot = window.screenshot});
}

Result<bool> ask_own_marks(Desk& desk, const WindowSession& ready, record::Diary& diary,
                           const WindowOptions& window) {
  const std::uint64_t ticks = ready.session->outcome().ticks;
  return ask_self_marks(desk, *ready.work_case, diary, ticks > 0 ? ticks - 1 : 0, window.seconds);
}

Result<Closed> watch_file(Desk& desk, const std::string& file, const scenario::BoneRecipe& given,
                          const WatchOptions& options) {
  bool closed = false;
  const auto open = [&desk, &given](const std::string& path, bool& shut) {
    return load<Recorded>(
        desk, say(Word::loading, word(Word::start_recording)),
        [&given, path, state = desk.places().state](Progress& progress) {
          return open_recorded(path, state, given, progress);
        },
        shut);
  };
  auto recorded = open(file, closed);
  if (closed) return Closed::window;
  if (!recorded) return recorded.error();
  // a kept session is in the list of sessions already, and goes when that throws it away
  const std::filesystem::path sessions = desk.places().state / "sessions";
  std::error_code nobody_asks;
  if (!std::filesystem::equivalent(std::filesystem::absolute(file, nobody_asks).parent_path(),
                                   sessions, nobody_asks))
    remember(desk.places().state, file, "recording");
  WatchOptions with = options;
  with.open = open;
  return watch(desk, *recorded, with);
}

namespace {

// Opens what the user chose on the start page and lets him work on it. Closed::page also where it could
// not be opened; `trouble` then says why.
Result<Closed> work_on(Desk& desk, StartPage::Choice& choice, const PagesOptions& options,
                       std::string& trouble) {
  const bool goes_on = choice.go_on.has_value();
  WorkOptions& chosen = *choice.open;
  const std::string title =
      say(Word::loading, goes_on ? shown_title(*choice.go_on) : title_of(chosen, desk.settings));
  bool closed = false;
  Result<WindowSession> ready =
      goes_on ? load<WindowSession>(
                    desk, title,
                    [kept = *choice.go_on](Progress& progress) {
                      return continue_session(kept, progress);
                    },
                    closed)
      : names_a_scan(chosen)
          ? open_by_page(desk, chosen, title, options.seconds, closed)
          : load<WindowSession>(
                desk, title, [chosen](Progress& progress) { return open_ready(chosen, progress); },
                closed);
  if (closed || interrupted()) {
    if (const Status left = leave_screenshot(desk, options.screenshot); !left) return left.error();
    return Closed::window;
  }
  if (!ready) {
    if (ready.error().trouble != Trouble::interrupted) trouble = ready.error().text;
    return Closed::page;
  }
  std::error_code nobody_asks;
  if (!goes_on && std::filesystem::exists(chosen.volume.source, nobody_asks))
    remember(desk.places().state, chosen.volume.source, ready->title,
             ready->lesson ? ready->lesson->title : scenario::Texts());
  for (const std::string& notice : ready->import.notices)
    desk.troubles.push_back(notice_words(notice));
  chosen.identity = ready->identity;
  return mill_and_keep(desk, *ready, chosen, goes_on ? &*choice.go_on : nullptr,
                       {.seconds = options.seconds,
                        .folder = options.folder,
                        .screenshot = options.screenshot,
                        .sound = options.sound});
}

// A recording is played; of a kept session the marks are shown. As work_on().
Result<Closed> look_at(Desk& desk, const StartPage::Choice& choice, const PagesOptions& options,
                       std::string& trouble) {
  const Result<Closed> left = choice.marks_of
                                  ? review_session(desk, {.file = choice.marks_of->file.string(),
                                                          .title = shown_title(*choice.marks_of),
                                                          .rubric = choice.marks_of->rubric,
                                                          .volume = choice.marks_of->options.volume,
                                                          .seconds = options.seconds,
                                                          .folder = options.folder,
                                                          .screenshot = options.screenshot})
                                  : watch_file(desk, choice.open->volume.source, {},
                                               {.seconds = options.seconds,
                                                .folder = options.folder,
                                                .screenshot = options.screenshot});
  if (left) return left;
  if (left.error().trouble != Trouble::interrupted) trouble = left.error().text;
  return Closed::page;
}

}  // namespace

Status run_pages(Desk& desk, const PagesOptions& options) {
  record::Identity who = options.led.identity;
  if (!options.mode_given)
    who.mode = record::mode_of(desk.settings.mode).value_or(record::Mode::free);
  StartPage start(desk, mill_help_rows, options.led.hand, who);
  std::string trouble, last_loss;  // last_loss: of a session that was not kept
  RateState rating;                // of whoever marks products, while burr runs
  for (;;) {
    auto choice = start.ask(trouble, options.seconds);
    if (!choice) return choice.error();
    trouble.clear();
    if (choice->quit) return leave_screenshot(desk, options.screenshot);
    Result<Closed> left = Closed::page;
    if (choice->rate) {
      left = rate(desk, rating, {.seconds = options.seconds, .screenshot = options.screenshot});
      if (!left) {
        trouble = left.error().text;
        left = Closed::page;
      }
    } else if (choice->marks_of || (choice->open && is_recording(choice->open->volume.source))) {
      left = look_at(desk, *choice, options, trouble);
    } else {
      if (choice->go_on) choice->open = choice->go_on->options;
      choice->open->hand = start.hand();
      choice->open->suction = options.led.suction;
      choice->open->publish_as = options.led.publish_as;
      if (desk.settings.shaft_touches) choice->open->touch = haptics::Method::shaft;
      if (choice->go_on) choice->go_on->options = *choice->open;
      do {
        left = work_on(desk, *choice, options, trouble);
        next_attempt(choice->open->identity);
        choice->go_on.reset();  // once more: from the beginning
      } while (left && *left == Closed::again);
    }
    if (!left) return left.error();
    if (*left == Closed::window) return desk.lost;
    if (!desk.lost && std::exchange(last_loss, desk.lost.error().text) != desk.lost.error().text)
      trouble = last_loss;
  }
}

}  // namespace burr::app
