#include "window/replay/watch.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <utility>

#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "window/parts/export_page.h"
#include "window/parts/hud.h"
#include "window/parts/measuring.h"
#include "window/parts/see_through.h"
#include "window/replay/replay_view.h"
#include "window/replay/timeline_panel.h"
#include "window/ui/file_dialog.h"

namespace burr::app {
namespace {

constexpr double kPaces[] = {0.25, 0.5, 1, 2, 4, 8};
constexpr double kStep = 1, kSmallStep = 0.05;  // by an arrow key; with Shift  [s]
constexpr double kTurn = 0.006;                 // of the view, per pixel of the mouse  [rad]
constexpr double kShift = 0.5;                  // of the second recording, per key press  [s]

}  // namespace

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
    if (!opened && opened.error().trouble != Trouble::interrupted)
      trouble_ = in_options(opened.error()).text;
  }
}

void Watch::key(const SDL_Keysym& pressed) {
  const bool shift_held = (pressed.mod & KMOD_SHIFT) != 0, ctrl = (pressed.mod & KMOD_CTRL) != 0;
  if (ctrl && pressed.sym >= SDLK_a && pressed.sym <= SDLK_z) return;  // Ctrl + A is no A
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

}  // namespace burr::app
