#include "window/replay/replay_page.h"

#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <optional>
#include <utility>

#include "burr/render/picture.h"
#include "burr/scenario/open_lesson.h"
#include "commands/interrupt.h"
#include "window/mill/export_page.h"
#include "window/mill/hud.h"
#include "window/mill/measuring.h"
#include "window/mill/mirror_mode.h"
#include "window/mill/see_through.h"
#include "window/replay/comparison.h"
#include "window/replay/replay_bar.h"
#include "window/replay/replay_view.h"
#include "window/replay/split_view.h"
#include "window/replay/timeline_panel.h"
#include "window/shell/anatomy.h"
#include "window/shell/file_dialog.h"
#include "window/shell/help.h"
#include "window/shell/words.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kPaces[] = {0.25, 0.5, 1, 2, 4, 8};
constexpr double kStep = 1, kSmallStep = 0.05;  // by an arrow key; with Shift  [s]
constexpr double kTurn = 0.006;                 // of the view, per pixel of the mouse  [rad]
constexpr double kShift = 0.5;                  // of the second recording, per key press  [s]
// After this time without input or change the window is drawn this often: a film that is being made
// then has the processor.
constexpr auto kRestsAfter = std::chrono::seconds(1);
constexpr auto kAtRest = std::chrono::milliseconds(100);

class Watch {
 public:
  Watch(Desk& desk, Recorded& recorded, const WatchOptions& options)
      : desk_(desk), recorded_(recorded), scene_(recorded.scene), options_(options) {
    take_titles();
  }

  Result<Closed> run();

 private:
  void take_titles() const;
  void take_events();
  void key(const SDL_Keysym& pressed);
  void act(Action action);
  void leave();
  void move(const SDL_MouseMotionEvent& motion);
  void go(double t);
  void play(bool playing);
  void change_pace(int by);
  void film_here(bool begins);
  void turn_view(double right, double up, bool shift);
  Status show();
  Status open_beside(const std::string& file);
  void close_beside();
  void tell();
  void draw_slices();
  void next_comparison();
  void next_slices();
  void ask_beside();
  void shift(double by);
  void follow();
  void panels();
  void draw_table(const Facts* left);
  void titles() const;
  void ring() const;
  void show_labels(bool shown);
  void show_panels(bool shown);
  void note(std::string text, bool stays = false) {
    note_ = std::move(text);
    noted_ = Clock::now();
    note_stays_ = stays;
  }
  [[nodiscard]] bool page_open() const {
    return help_ || dialog_.open() || (export_ && export_->shown());
  }
  // on the shared clock, until both have ended  [s]
  [[nodiscard]] double seconds() const {
    return std::max(first_->line().seconds, second_ ? second_->line().seconds + now_.shift : 0.0);
  }
  [[nodiscard]] bool at_rest() const;
  [[nodiscard]] double stroke_before(double t) const;
  [[nodiscard]] double stroke_after(double t) const;

  Desk& desk_;
  Recorded& recorded_;
  render::Scene& scene_;
  const WatchOptions& options_;

  render::Camera first_view_;
  std::optional<ReplayView> first_;
  std::unique_ptr<Recorded> beside_;  // shown by second_, if there is one
  std::optional<ReplayView> second_;
  render::Camera second_view_;
  std::optional<FactsJob> facts_;           // of the first recording
  std::unique_ptr<Comparison> comparison_;  // with the second one
  enum class Compare { none, table, colours } compare_ = Compare::table;
  std::optional<SplitView> pair_;
  FileDialog dialog_;
  std::vector<std::string> dropped_;
  Watched now_;
  bool open_ = true, picture_ = false, panels_ = true, help_ = false, scrubbing_ = false;
  bool labels_ = true, leaves_ = false;  // leaves_: leave, even if a film is being made
  std::optional<ExportPage> export_;
  Closed closed_ = Closed::window;
  std::string note_, trouble_;     // trouble_: of the second recording, until a key
  std::optional<Action> pressed_;  // the button of the last picture
  bool writing_ = false;           // a file is being written
  bool note_stays_ = false;        // until it is clicked away
  bool click_ = false;  // a button of the mouse went down, and the mouse has not moved since
  Clock::time_point noted_{}, stirred_ = Clock::now();  // stirred_: last input or change
  double stop_at_ = 0;                                  // playing ends there [s]
};

// The names of structures are those of the recorded case.
void Watch::take_titles() const {
  take_titles_of(nullptr);
  const auto& info = recorded_.player->info().work_case;
  if (!info) return;
  if (const auto lesson = scenario::parse_lesson(info->text, info->name)) take_titles_of(&*lesson);
}

Result<Closed> Watch::run() {
  desk_.page = Page::replay;
  desk_.renderer().title("burr");
  export_.emplace(desk_, nullptr, scene_, options_.folder, [this] {
    recorded_.film.effects = desk_.settings.effects;
    recorded_.film.plan.from = now_.film_from;
    recorded_.film.plan.until = now_.film_until;
    return std::optional(recorded_.film);
  });
  first_view_ = scene_.camera;
  first_.emplace(recorded_, desk_.renderer().software(), desk_.governor);
  if (!options_.beside.empty()) {
    const Status opened = open_beside(options_.beside);
    if (!opened && opened.error().trouble != Trouble::interrupted) return opened.error();
  }
  now_.film_until = first_->line().seconds;
  if (!workshop::read_spared(recorded_.player->info()).empty()) facts_.emplace(recorded_);
  now_.t = std::max(0.0, options_.from);
  now_.playing = options_.from < 0 || options_.until > options_.from;
  stop_at_ = options_.until > options_.from ? options_.until : seconds();

  const Clock::time_point start = Clock::now();
  Clock::time_point frame = start, last = start;
  Status shown = fine();
  while (open_ && shown && !interrupted()) {
    const Clock::time_point began = Clock::now();
    take_events();
    // playing continues, unless the user drags along the time line
    const double passed = std::chrono::duration<double>(began - last).count();
    last = began;
    if (now_.playing && !scrubbing_) now_.t += now_.pace * std::min(passed, 0.25);
    if (now_.playing && !scrubbing_ && now_.t >= std::min(stop_at_, seconds())) {
      now_.t = std::min(stop_at_, seconds());
      now_.playing = false;
    }
    if (now_.t >= seconds()) {
      now_.t = seconds();
      if (!scrubbing_) now_.playing = false;
    }
    // a slow computer shows fewer moments; the session does not take longer
    first_->want(now_.t);
    if (second_) second_->want(now_.t - now_.shift);
    if (ExportPage::Told told = export_->step(); !told.text.empty())
      note(std::move(told.text), told.stays);
    const bool writes = !export_->progress().empty();
    if (writes && !writing_) note({});  // the line is for what is being written now
    writing_ = writes;
    if (!note_stays_ && Clock::now() - noted_ > std::chrono::seconds(6)) note({});
    shown = show();
    if (now_.playing || scrubbing_ || !first_->settled() || (second_ && !second_->settled()) ||
        !desk_.renderer().refined())
      stirred_ = Clock::now();
    // not while the panels are drawn: it may be the second bone's end, which is being shown
    if (const auto pressed = std::exchange(pressed_, std::nullopt)) act(*pressed);
    if (std::exchange(picture_, false)) {
      const Result<std::string> left = desk_.leave_picture(options_.folder);
      note(left ? say(Word::picture_left, *left) : left.error().text);
    }
    frame = std::max(frame + std::chrono::microseconds(16'667), Clock::now());
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(frame - Clock::now());
    if (at_rest())
      SDL_WaitEventTimeout(nullptr, static_cast<int>(kAtRest.count()));  // an event ends the wait
    else if (wait.count() > 0)
      SDL_Delay(static_cast<Uint32>(wait.count()));
    if (options_.seconds > 0 &&
        std::chrono::duration<double>(Clock::now() - start).count() >= options_.seconds)
      open_ = false;
  }
  export_.reset();
  close_beside();
  facts_.reset();
  first_.reset();
  if (!shown) return shown.error();
  if (!options_.screenshot.empty()) {
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
  }
  return closed_;
}

// Draws one picture: of one recording, or of both in halves of the window.
Status Watch::show() {
  // dust would lie over the colours
  const bool effects = desk_.settings.effects && !(comparison_ && compare_ == Compare::colours);
  first_->look(effects, now_.playing, desk_.settings.left_handed);
  if (second_) second_->look(effects, now_.playing, desk_.settings.left_handed);
  tell();
  now_.buttons.clear();
  now_.table = {};
  const bool told = !note_.empty() && Clock::now() - noted_ < std::chrono::seconds(3);
  const auto over = panels_ || page_open() || told ? [this] { panels(); } : std::function<void()>();
  Status shown = fine();
  if (second_) {
    follow();
    shown = pair_->draw({&scene_, &second_->scene()}, desk_.renderer().width(),
                        desk_.renderer().height());
    desk_.renderer().make_current();
    first_->drawn(pair_->took_s(0), pair_->redrawn(0));
    second_->drawn(pair_->took_s(1), pair_->redrawn(1));
    if (shown) shown = desk_.show(pair_->both(), over);
  } else {
    const Clock::time_point drawing = Clock::now();
    shown = desk_.show(scene_, over);
    first_->drawn(std::chrono::duration<double>(Clock::now() - drawing).count(),
                  desk_.renderer().figures().redrawn);
  }
  now_.shown = first_->shown();
  now_.known = first_->known();
  now_.force = first_->force();
  now_.removed = first_->removed();
  now_.diameter = 2 * first_->tool_of_values().radius;
  now_.behind = first_->behind() || (second_ && second_->behind());
  now_.beside = second_.has_value();
  now_.shown_beside = second_ ? second_->shown() : 0;
  now_.removed_beside = second_ ? second_->removed() : 0;
  now_.note = !export_->trouble().empty() ? export_->trouble()
              : !trouble_.empty()         ? trouble_
                                          : note_;
  now_.note_stays = note_stays_ && !note_.empty();
  now_.panels = panels_;
  now_.help = help_;
  now_.exporting = export_->shown();
  if (options_.seen != nullptr) *options_.seen = now_;
  return shown;
}

// ---- the second recording

Status Watch::open_beside(const std::string& file) {
  if (!options_.open)
    return error(Trouble::usage, file + ": a second recording cannot be opened here");
  bool closed = false;
  auto opened = options_.open(file, closed);
  desk_.page = Page::replay;
  if (closed) open_ = false;
  if (!opened) return opened.error();
  close_beside();
  beside_ = std::make_unique<Recorded>(std::move(*opened));
  second_.emplace(*beside_, desk_.renderer().software(), desk_.governor);
  second_->show_labels(labels_);
  second_view_ = beside_->scene.camera;
  // if both have the same bone, both are seen from the same viewpoint
  if (same_grid(recorded_.bone->grid(), beside_->bone->grid())) second_view_ = first_view_;
  pair_.emplace();
  if (!facts_) facts_.emplace(recorded_);
  comparison_ = std::make_unique<Comparison>(*first_, *second_);
  return fine();
}

void Watch::close_beside() {
  comparison_.reset();
  pair_.reset();
  second_.reset();
  beside_.reset();
  now_.shift = 0;
}

// Shows distances, the table of losses, the colours of the difference, and slices.
void Watch::tell() {
  if (facts_) facts_->step();
  const Facts* first = facts_ ? facts_->facts() : nullptr;
  if (comparison_) {
    comparison_->step(first);
    comparison_->colour(compare_ == Compare::colours);
  }
  draw_slices();
  now_.measured = first != nullptr && (!comparison_ || comparison_->right() != nullptr);
  const bool coloured = comparison_ && comparison_->coloured();
  if (coloured == std::exchange(now_.coloured, coloured)) return;
  // the tools would hide what they cut
  first_->scene().burr.visible = !coloured;
  if (second_) second_->scene().burr.visible = !coloured;
}

// Slices of both at the same place, in a column at the right of each half.
void Watch::draw_slices() {
  const int height = desk_.renderer().height();
  const int wide = second_ ? desk_.renderer().width() / 2 : desk_.renderer().width();
  const int bottom = static_cast<int>(184 * desk_.ui().unit());
  const ReplayView& of = now_.slices == 2 && second_ ? *second_ : *first_;
  const math::Vec3 place = of.place();
  first_->slices().update(scene_, place, now_.slices != 0, labels_, wide, height, bottom);
  if (second_)
    second_->slices().update(second_->scene(), place, now_.slices != 0, labels_,
                             desk_.renderer().width() - wide, height, bottom);
}

void Watch::next_comparison() {
  if (!second_) return ask_beside();
  if (!comparison_) return;
  compare_ = compare_ == Compare::none    ? Compare::table
             : compare_ == Compare::table ? Compare::colours
                                          : Compare::none;
  if (compare_ == Compare::colours && now_.measured && !comparison_->comparable())
    note(word(Word::beside_other_bone));
}

void Watch::next_slices() {
  now_.slices = (now_.slices + 1) % (second_ ? 3 : 2);
  if (now_.slices != 0)
    note(word(now_.slices == 2 ? Word::slices_right
              : second_        ? Word::slices_left
                               : Word::slices_burr));
}

void Watch::ask_beside() {
  if (second_) return close_beside();
  dialog_.ask(word(Word::dialog_second), FileDialog::Wanted::recordings);
  SDL_StartTextInput();
}

void Watch::shift(double by) {
  if (!second_) return note(word(Word::replay_second_first));
  // limits: the second begins no later than the first ends, and ends no earlier than the first
  // begins
  now_.shift = std::clamp(now_.shift + by, -second_->line().seconds, first_->line().seconds);
  note(say(Word::replay_shifted, now_.shift));
}

// Moves the second camera like the first: the same turn, shift and zoom since the start.
void Watch::follow() {
  render::Camera camera = scene_.camera;
  camera.target = second_view_.target + (camera.target - first_view_.target);
  camera.distance *= second_view_.distance / first_view_.distance;
  camera.azimuth += second_view_.azimuth - first_view_.azimuth;
  constexpr double kHighest = 1.55;  // just below the pole
  camera.elevation = std::clamp(camera.elevation + second_view_.elevation - first_view_.elevation,
                                -kHighest, kHighest);
  second_->scene().camera = camera;
  second_->scene().look.opacity = scene_.look.opacity;
}

bool Watch::at_rest() const { return Clock::now() - stirred_ > kRestsAfter; }

double Watch::stroke_before(double t) const {
  const double first = first_->line().stroke_before(t).value_or(0);
  if (!second_) return first;
  return std::max(first,
                  second_->line().stroke_before(t - now_.shift).value_or(-now_.shift) + now_.shift);
}

double Watch::stroke_after(double t) const {
  const double first = first_->line().stroke_after(t).value_or(seconds());
  if (!second_) return first;
  const auto other = second_->line().stroke_after(t - now_.shift);
  return other ? std::min(first, *other + now_.shift) : first;
}

// ---- mouse and keys

void Watch::take_events() {
  SDL_Event event;
  while (desk_.next(event)) {
    stirred_ = Clock::now();
    switch (event.type) {
      case SDL_QUIT:
        open_ = false;
        break;
      case SDL_WINDOWEVENT:  // SDL_QUIT comes with the last window only, and the halves have others
        if (event.window.event == SDL_WINDOWEVENT_CLOSE) open_ = false;
        break;
      case SDL_DROPFILE:
        if (event.drop.file != nullptr) dropped_.emplace_back(event.drop.file);
        SDL_free(event.drop.file);
        break;
      case SDL_KEYDOWN:
        trouble_.clear();
        click_ = false;
        if (dialog_.open()) {  // it takes letters and arrows itself
          if (event.key.keysym.sym == SDLK_ESCAPE) dialog_.cancel();
        } else if (!desk_.ui().typing()) {
          key(event.key.keysym);
        }
        break;
      case SDL_MOUSEMOTION:
        if (std::abs(event.motion.xrel) + std::abs(event.motion.yrel) > 1) click_ = false;
        move(event.motion);
        break;
      case SDL_MOUSEBUTTONDOWN:
        click_ = !panels_ && !page_open();
        break;
      case SDL_MOUSEBUTTONUP:  // the only way back to the panels without a key
        if (std::exchange(click_, false)) show_panels(true);
        break;
      case SDL_MOUSEWHEEL:
        if (!page_open() && !desk_.ui().over_panel())
          render::zoom(scene_.camera, std::pow(1.15, desk_.settings.zoom_pace * event.wheel.y));
        break;
      case SDL_MULTIGESTURE:
        render::zoom(scene_.camera, std::exp(4 * static_cast<double>(event.mgesture.dDist)));
        break;
      default:
        break;
    }
  }
  if (auto chosen = dialog_.answer()) {
    SDL_StopTextInput();
    if (!chosen->empty()) dropped_.push_back(*chosen);
  }
  for (const std::string& file : std::exchange(dropped_, {})) {
    const Status opened = open_beside(file);
    if (!opened && opened.error().trouble != Trouble::interrupted) trouble_ = opened.error().text;
  }
}

void Watch::key(const SDL_Keysym& pressed) {
  const bool shift_held = (pressed.mod & KMOD_SHIFT) != 0, ctrl = (pressed.mod & KMOD_CTRL) != 0;
  switch (pressed.sym) {
    case SDLK_ESCAPE:
      if (page_open()) {
        help_ = false;
        if (export_->choosing())
          export_->stop_choosing();
        else
          export_->show(false);
        break;
      }
      [[fallthrough]];
    case SDLK_q:
      return leave();
    case SDLK_SPACE:
      return act(Action::play);
    case SDLK_LEFT:
      if (ctrl) return act(Action::stroke_back);
      return shift_held ? go(now_.t - kSmallStep) : act(Action::step_back);
    case SDLK_RIGHT:
      if (ctrl) return act(Action::stroke_on);
      return shift_held ? go(now_.t + kSmallStep) : act(Action::step_on);
    case SDLK_UP:
    case SDLK_DOWN:
      return turn_view(0, pressed.sym == SDLK_UP ? 12 : -12, shift_held);
    case SDLK_HOME:
      return go(0);
    case SDLK_END:
      return go(seconds());
    case SDLK_COMMA:
    case SDLK_MINUS:
    case SDLK_KP_MINUS:
      return act(Action::slower);
    case SDLK_PERIOD:
    case SDLK_PLUS:
    case SDLK_EQUALS:
    case SDLK_KP_PLUS:
      return act(Action::faster);
    case '{':  // Shift + [ on many keyboards
      return shift(-kSmallStep);
    case '}':
      return shift(kSmallStep);
    case SDLK_LEFTBRACKET:
    case SDLK_PAGEDOWN:
      return shift_held ? shift(-kSmallStep) : act(Action::earlier);
    case SDLK_RIGHTBRACKET:
    case SDLK_PAGEUP:
      return shift_held ? shift(kSmallStep) : act(Action::later);
    case SDLK_t:
      return note(step_see_through(scene_, shift_held));
    default:
      break;
  }
  constexpr std::pair<SDL_Keycode, Action> kLetters[] = {
      {SDLK_b, Action::beside},     {SDLK_c, Action::compare},   {SDLK_v, Action::slices},
      {SDLK_f, Action::first_view}, {SDLK_l, Action::labels},    {SDLK_p, Action::picture},
      {SDLK_e, Action::export_},    {SDLK_TAB, Action::hide},    {SDLK_F1, Action::help},
      {SDLK_h, Action::help},       {SDLK_i, Action::film_from}, {SDLK_o, Action::film_until}};
  for (const auto& [sym, action] : kLetters)
    if (sym == pressed.sym) return act(action);
}

// What the buttons do, and the keys for the same.
void Watch::act(Action action) {
  switch (action) {
    case Action::play:
      return play(!now_.playing);
    case Action::slower:
      return change_pace(-1);
    case Action::faster:
      return change_pace(1);
    case Action::film_from:
      return film_here(true);
    case Action::film_until:
      return film_here(false);
    case Action::step_back:
      return go(now_.t - kStep);
    case Action::step_on:
      return go(now_.t + kStep);
    case Action::stroke_back:
      return go(stroke_before(now_.t - 0.5));
    case Action::stroke_on:
      return go(stroke_after(now_.t));
    case Action::beside:
      return ask_beside();
    case Action::compare:
      return next_comparison();
    case Action::earlier:
      return shift(-kShift);
    case Action::later:
      return shift(kShift);
    case Action::slices:
      return next_slices();
    case Action::see_through:
      return note(step_see_through(scene_, false));
    case Action::first_view:
      scene_.camera = first_view_;
      return;
    case Action::labels:
      return show_labels(!labels_);
    case Action::picture:
      picture_ = true;
      return;
    case Action::export_:
      export_->show(!export_->shown());
      help_ = false;
      return;
    case Action::help:
      help_ = !help_;
      export_->show(false);
      return;
    case Action::hide:
      return show_panels(!panels_);
    case Action::leave:
      return leave();
    default:  // of the page for milling
      return;
  }
}

// While a file is being written, only the second call leaves.
void Watch::leave() {
  if (!export_->progress().empty() && !std::exchange(leaves_, true))
    return note(word(Word::export_wait));
  closed_ = Closed::page;
  open_ = false;
}

void Watch::show_panels(bool shown) {
  panels_ = shown;
  if (!shown) note(word(Word::replay_panels_hidden));
}

void Watch::go(double t) { now_.t = std::clamp(t, 0.0, seconds()); }

void Watch::play(bool playing) {
  // at the end, playing starts from the beginning
  if (playing && now_.t >= seconds()) now_.t = 0;
  stop_at_ = seconds();  // only the first playing ends at a moment
  now_.playing = playing;
}

void Watch::change_pace(int by) {
  const auto at = std::find(std::begin(kPaces), std::end(kPaces), now_.pace) - std::begin(kPaces);
  now_.pace = kPaces[std::clamp<std::ptrdiff_t>(at + by, 0, std::ssize(kPaces) - 1)];
}

// The film of the first recording begins or ends at this moment. A mark that the other one has passed
// leaves: the part is then as long as possible. The same moment again: the mark leaves.
void Watch::film_here(bool begins) {
  const double end = first_->line().seconds, t = std::min(now_.t, end);
  double &mine = begins ? now_.film_from : now_.film_until,
         &other = begins ? now_.film_until : now_.film_from;
  mine = mine == t ? (begins ? 0 : end) : t;
  if (now_.film_from >= now_.film_until) other = begins ? end : 0;
  if (now_.film_from >= now_.film_until) mine = begins ? 0 : end;
  note(say(Word::film_part, clock_of(now_.film_from), clock_of(now_.film_until)));
}

void Watch::turn_view(double right, double up, bool shift) {
  int wide = 1, high = 1;
  if (SDL_Window* window = SDL_GL_GetCurrentWindow()) SDL_GetWindowSize(window, &wide, &high);
  if (shift)
    render::pan(scene_.camera, right / high, up / high);
  else
    render::orbit(scene_.camera, kTurn * desk_.settings.turn_pace * right,
                  kTurn * desk_.settings.turn_pace * up);
}

// Nothing is milled on this page, so both buttons turn the view.
void Watch::move(const SDL_MouseMotionEvent& motion) {
  if (page_open() || scrubbing_ || desk_.ui().over_panel()) return;
  if ((motion.state & (SDL_BUTTON_LMASK | SDL_BUTTON_RMASK)) != 0)
    turn_view(-motion.xrel, motion.yrel, false);
  if ((motion.state & SDL_BUTTON_MMASK) != 0) turn_view(-motion.xrel, motion.yrel, true);
}

void Watch::show_labels(bool shown) {
  labels_ = shown;
  first_->show_labels(shown);
  if (second_) second_->show_labels(shown);
}

// ---- drawing

namespace {

TimelineMoment moment_of(const ReplayView& side, double from) {
  return {.line = &side.line(),
          .from = from,
          .known = side.known(),
          .force = side.force(),
          .removed = side.removed(),
          .speed = side.speed(),
          .burr_diameter = 2 * side.tool_of_values().radius,
          .mode = side.tool_of_values().mode};
}

}  // namespace

// Writes the title of each half.
void Watch::titles() const {
  const Ui& ui = desk_.ui();
  const float u = ui.unit(), middle = std::floor(ui.width() / 2);
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.AddRectFilled({middle - std::max(1.0F, u), 0}, {middle + std::max(1.0F, u), ui.height()},
                     ink::rgb(0, 0, 0));
  const auto title = [&](const ReplayView& side, float x) {
    const std::string& text = side.recorded().title;
    const float w = std::min(ui.width_of(Ui::Letter::strong, text) + 24 * u, middle - 24 * u);
    const float h = ui.height_of(Ui::Letter::strong) + 12 * u;
    const std::string name = fmt::format("##title{}", x > 0 ? 2 : 1);
    desk_.ui().panel(name.c_str(), x + 12 * u, 12 * u, w, h);
    ui.write(x + 24 * u, 18 * u, Ui::Letter::strong, ink::kText, text);
    ImGui::End();
  };
  title(*first_, 0);
  title(*second_, middle);
}

// Draws a ring round the place that is looked at.
void Watch::ring() const {
  if (!options_.place || second_) return;
  constexpr double kRadius = 1.5e-3;  // [m]
  const Ui& ui = desk_.ui();
  const render::Camera& camera = scene_.camera;
  const auto middle = on_picture(camera, *options_.place, ui.width(), ui.height());
  const auto edge =
      on_picture(camera, *options_.place + kRadius * camera.right(), ui.width(), ui.height());
  if (!middle || !edge) return;  // behind the eye
  const float u = ui.unit();
  const float r = std::max(std::hypot(edge->x - middle->x, edge->y - middle->y), 8 * u);
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.AddCircle({middle->x + u, middle->y + u}, r, ink::rgb(0, 0, 0, 150), 48, 2 * u);
  draw.AddCircle(*middle, r, ink::kWarn, 48, 2 * u);
}

// Between the two bones, where it covers neither place of work. Slices lie there too: then it begins
// right of those of the left bone.
void Watch::draw_table(const Facts* left) {
  if (!comparison_ || compare_ == Compare::none) return;
  Ui& ui = desk_.ui();
  const float u = ui.unit(), middle = std::floor(ui.width() / 2), w = Comparison::kWide * u;
  now_.table = {Action::compare, now_.slices == 0 ? middle - w / 2 : middle + 8 * u, 56 * u, w,
                ui.height() / 2};
  if (comparison_->draw(ui, now_.table.x, now_.table.y, left, compare_ == Compare::colours))
    compare_ = compare_ == Compare::colours ? Compare::table : Compare::colours;
}

void Watch::panels() {
  Ui& ui = desk_.ui();
  if (dialog_.open()) return dialog_.draw(ui);
  ring();
  if (!panels_ && !page_open()) {  // only what the user must know to see them again
    float bottom = ui.height() - 10 * ui.unit();
    static_cast<void>(line_above(ui, bottom, note_, false, {0, ui.width()}));
    return;
  }
  if (panels_) {
    TimelineState s;
    s.first = moment_of(*first_, 0);
    s.first.facts = facts_ ? facts_->facts() : nullptr;
    if (second_) s.second = moment_of(*second_, now_.shift);
    if (comparison_) s.second.facts = comparison_->right();
    s.seconds = seconds();
    s.t = now_.t;
    s.playing = now_.playing;
    s.behind = now_.behind;
    s.pace = now_.pace;
    s.film_from = now_.film_from;
    s.film_until = now_.film_until;
    if (const edit::Mirror now = tick::mirror_of(first_->tool()); now.on() && !second_)
      draw_mirror_sign(ui, mirror_words(recorded_.bone->grid(), now), 0);
    s.note = note_.empty() ? export_->progress() : note_;
    s.note_stays = note_stays_ && !note_.empty();
    if (s.note.empty()) s.note = options_.note;
    now_.line = s.note;
    s.warning = !trouble_.empty()                      ? trouble_
                : first_->trouble().empty() && second_ ? second_->trouble()
                                                       : first_->trouble();
    if (second_) titles();
    draw_table(s.first.facts);
    if (!scene_.insets.empty() && !second_)
      s.column = ui.width() - static_cast<float>(scene_.insets.front().x);
    if (now_.slices != 0) {
      first_->slices().write_names(scene_, ui);
      if (second_) second_->slices().write_names(second_->scene(), ui, std::floor(ui.width() / 2));
    }
    const TimelineDone done = draw_timeline(ui, s);
    now_.buttons = done.places;
    constexpr float kStrip = 184;  // [points]
    const auto pressed = draw_replay_bar(ui,
                                         {.beside = second_.has_value(),
                                          .compares = comparison_ && compare_ != Compare::none,
                                          .slices = now_.slices != 0,
                                          .see_through = scene_.look.opacity < 1,
                                          .labels = labels_},
                                         ui.height() - kStrip * ui.unit(), now_.buttons);
    scrubbing_ = done.scrubbed.has_value();
    if (done.scrubbed) go(*done.scrubbed);
    if (done.play) play(!now_.playing);
    if (done.pace != 0) change_pace(done.pace);
    if (done.film_from) film_here(true);
    if (done.film_until) film_here(false);
    if (done.note_away) note({});
    pressed_ = pressed;
  }
  if (help_) help_ = draw_replay_help(ui);
  if (export_->shown()) export_->draw();
}

}  // namespace

Result<Closed> watch(Desk& desk, Recorded& recorded, const WatchOptions& options) {
  return Watch(desk, recorded, options).run();
}

}  // namespace burr::app
