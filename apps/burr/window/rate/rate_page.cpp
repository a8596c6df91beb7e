#include "window/rate/rate_page.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <random>
#include <utility>

#include "burr/render/camera.h"
#include "burr/render/picture.h"
#include "burr/school/ratings.h"
#include "burr/school/store.h"
#include "school/products.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "window/rate/product_bone.h"
#include "window/rate/rate_panel.h"
#include "window/ui/loading.h"
#include "window/ui/texture.h"

namespace burr::app {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kTurn = 0.006;    // of the view, for each pixel of the mouse [rad]
constexpr double kKeyTurn = 0.12;  // for each press of a key [rad]
constexpr double kStep = 1.15;     // of the zoom
constexpr float kViewsHigh = 124;  // the buttons of the views, with their margin [points]
constexpr std::chrono::milliseconds kFrame(33);

std::string name_of(const report::ProductView& view) {
  constexpr std::pair<const char*, Word> kSideNames[] = {{"straight", Word::rate_straight},
                                                         {"below", Word::rate_below},
                                                         {"left", Word::rate_from_left},
                                                         {"right", Word::rate_from_right}};
  for (const auto& [name, says] : kSideNames)
    if (view.name == name) return word(says);
  constexpr std::pair<render::Plane, Word> kPlaneNames[] = {
      {render::Plane::axial, Word::axial},
      {render::Plane::coronal, Word::coronal},
      {render::Plane::sagittal, Word::sagittal}};
  for (const auto& [plane, says] : kPlaneNames)
    if (view.slice && view.slice->plane == plane)
      return say(Word::rate_section, word(says), view.name.back());
  return view.name;
}

class Rate {
 public:
  Rate(Desk& desk, RateState& state, const RateOptions& options,
       std::unique_ptr<school::Store> store)
      : desk_(desk), state_(state), options_(options), store_(std::move(store)) {
    if (state_.seed == 0) state_.seed = std::random_device()() | 1U;
    shown_.rater = state_.rater;
    if (!state_.rater.empty()) begin();
  }

  Result<Closed> run() {
    desk_.page = Page::rate;
    desk_.renderer().title("burr");
    renewed_ = desk_.renewed();
    SDL_StartTextInput();
    const Clock::time_point start = Clock::now();
    Status drawn = fine();
    while (!closed_ && drawn) {
      const Clock::time_point frame = Clock::now();
      take_events();
      take_bone();
      drawn = draw();
      if (interrupted()) closed_ = Closed::window;
      if (options_.seconds > 0 &&
          Clock::now() - start >= std::chrono::duration<double>(options_.seconds))
        closed_ = Closed::window;
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(kFrame - (Clock::now() - frame));
      if (left.count() > 0 && !closed_)
        SDL_WaitEventTimeout(nullptr, static_cast<int>(left.count()));
    }
    put_down();
    if (!drawn) return drawn.error();
    if (!options_.screenshot.empty())
      if (const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
          !kept)
        return kept.error();
    return *closed_;
  }

 private:
  // ---- the queue

  void begin() {
    if (const Status good = school::check_name(word(Word::rate_you), shown_.rater); !good) {
      shown_.note = in_options(good.error()).text;
      return;
    }
    if (state_.rater != shown_.rater) {  // another person has another queue
      state_.session.clear();
      state_.marks.clear();
      state_.later.clear();
    }
    state_.rater = shown_.rater;
    shown_.asks_who = false;
    shown_.note.clear();
    next();
  }

  // The product that was marked before, otherwise the first that was not put off; those come again at the end.
  const school::Product* chosen(const std::vector<school::Product>& queue) {
    for (const school::Product& one : queue)
      if (one.session == state_.session) return &one;
    for (const school::Product& one : queue)
      if (!state_.later.contains(one.session)) return &one;
    state_.later.clear();
    return queue.empty() ? nullptr : &queue.front();
  }

  void next() {
    loading_.reset();
    bone_.reset();
    shown_.items.clear();
    shown_.views.clear();
    shown_.trouble.clear();
    shown_.heading = word(Word::rate_title);
    shown_.at = shown_.view = 0;
    shown_.making = false;
    const auto queue = products_here(*store_, state_.rater, "", state_.seed);
    if (!queue) {
      shown_.trouble = in_options(queue.error()).text;
      return;
    }
    shown_.left = queue->here.size();
    shown_.elsewhere = queue->elsewhere;
    const school::Product* product = chosen(queue->here);
    if (product == nullptr) {
      state_.session.clear();
      shown_.note += (shown_.note.empty() ? "" : " ") + std::string(word(Word::rate_nothing));
      return;
    }
    if (state_.session != product->session) state_.marks.clear();
    state_.session = product->session;
    shown_.heading = say(Word::rate_product, name_of_case(product->case_name));
    const auto items = product_items(*store_, product->session, product->rubric_hash);
    if (!items) {
      shown_.trouble = in_options(items.error()).text;
      return;
    }
    for (const ProductItem& one : *items) {
      const RateState::Mark& mark = state_.marks[one.id];
      shown_.items.push_back({one.id, one.in(spoken().code), mark.mark, mark.reason});
    }
    open_bone(product->session);
  }

  void open_bone(const std::string& session) {
    const auto recording = recording_of(*store_, session);
    if (!recording) {
      shown_.trouble = in_options(recording.error()).text;
      return;
    }
    shown_.making = true;
    loading_ = std::make_unique<Loading<ProductBone>>(
        [file = *recording](Progress& progress) { return open_product(file, progress); });
  }

  void take_bone() {
    if (!loading_) return;
    shown_.progress = loading_->progress().now().fraction;
    if (!loading_->finished()) return;
    auto made = loading_->take();
    loading_.reset();
    shown_.making = false;
    if (!made) {
      shown_.trouble = in_options(made.error()).text;
      return;
    }
    bone_ = std::make_unique<ProductBone>(std::move(*made));
    for (const report::ProductView& view : bone_->views) shown_.views.push_back(name_of(view));
    see(0);
  }

  void keep() {
    if (shown_.items.empty() || shown_.making || !shown_.trouble.empty()) return;
    const auto open = std::find_if(shown_.items.begin(), shown_.items.end(),
                                   [](const RateItem& one) { return one.mark.empty(); });
    if (open != shown_.items.end()) {
      const auto count = std::count_if(open, shown_.items.end(),
                                       [](const RateItem& one) { return one.mark.empty(); });
      shown_.note = say(Word::rate_missing, count);
      shown_.at = static_cast<std::size_t>(open - shown_.items.begin());
      shown_.scroll = true;
      return;
    }
    school::Marking marking{state_.session, state_.rater, true, {}};
    for (const RateItem& one : shown_.items)
      marking.marks.push_back({one.id, one.mark, one.reason});
    if (const Status kept = school::mark(*store_, marking); !kept) {
      shown_.note = in_options(kept.error()).text;
      return;
    }
    state_.session.clear();
    state_.marks.clear();
    shown_.note = word(Word::rate_kept);
    next();
  }

  void later() {
    if (state_.session.empty()) return;
    state_.later.insert(state_.session);
    state_.session.clear();
    state_.marks.clear();
    shown_.note.clear();
    next();
  }

  // What is not kept yet is there again when the rater comes back.
  void put_down() {
    for (const RateItem& one : shown_.items) state_.marks[one.id] = {one.mark, one.reason};
    loading_.reset();
  }

  // ---- keys and mouse

  void take_events() {
    SDL_Event event;
    while (desk_.next(event)) switch (event.type) {
        case SDL_QUIT:
          closed_ = Closed::window;
          break;
        case SDL_KEYDOWN:
          key(event.key.keysym);
          break;
        case SDL_MOUSEMOTION:
          move(event.motion);
          break;
        case SDL_MOUSEWHEEL:
          if (!desk_.ui().over_panel()) zoom(std::pow(kStep, event.wheel.y));
          break;
        default:
          break;
      }
  }

  void key(const SDL_Keysym& pressed) {
    const bool enter = pressed.sym == SDLK_RETURN || pressed.sym == SDLK_KP_ENTER;
    if (enter && (pressed.mod & KMOD_CTRL) != 0) return keep();
    if (desk_.ui().typing()) return;  // Escape leaves the field
    if (pressed.sym == SDLK_ESCAPE) {
      closed_ = Closed::page;
      return;
    }
    if (shown_.asks_who) {
      if (enter) begin();
      return;
    }
    if (pressed.sym >= SDLK_0 && pressed.sym <= SDLK_9)
      return see(static_cast<std::size_t>((pressed.sym - SDLK_0 + 9) % 10));
    if ((pressed.mod & KMOD_CTRL) != 0) return;  // Ctrl + A is no A
    switch (pressed.sym) {
      case SDLK_UP:
        return step_item(-1);
      case SDLK_DOWN:
        return step_item(1);
      case SDLK_LEFT:
        return step_mark(-1);
      case SDLK_RIGHT:
        return step_mark(1);
      case SDLK_r:
        shown_.to_reason = true;
        return;
      case SDLK_a:
        return turn(-kKeyTurn, 0);
      case SDLK_d:
        return turn(kKeyTurn, 0);
      case SDLK_w:
        return turn(0, kKeyTurn);
      case SDLK_s:
        return turn(0, -kKeyTurn);
      case SDLK_PLUS:
      case SDLK_EQUALS:
      case SDLK_KP_PLUS:
        return zoom(kStep);
      case SDLK_MINUS:
      case SDLK_KP_MINUS:
        return zoom(1 / kStep);
      case SDLK_f:
        return see(0);
      default:
        return;
    }
  }

  void step_item(int by) {
    if (shown_.items.empty()) return;
    const auto count = static_cast<int>(shown_.items.size());
    shown_.at =
        static_cast<std::size_t>(std::clamp(static_cast<int>(shown_.at) + by, 0, count - 1));
    shown_.scroll = true;
  }

  // none, met, not met, cannot be judged
  void step_mark(int by) {
    if (shown_.items.empty()) return;
    std::string& mark = shown_.items[shown_.at].mark;
    const auto found = std::find(kRateMarks.begin(), kRateMarks.end(), mark);
    const int now =
        found == kRateMarks.end() ? 0 : static_cast<int>(found - kRateMarks.begin()) + 1;
    const int then = std::clamp(now + by, 0, static_cast<int>(kRateMarks.size()));
    mark = then == 0 ? "" : kRateMarks[static_cast<std::size_t>(then - 1)];
    shown_.note.clear();
  }

  void move(const SDL_MouseMotionEvent& motion) {
    if (shown_.asks_who || desk_.ui().over_panel()) return;
    const double pace = kTurn * desk_.settings.turn_pace;
    if ((motion.state & (SDL_BUTTON_LMASK | SDL_BUTTON_RMASK)) != 0)
      turn(-pace * motion.xrel, pace * motion.yrel);
    if ((motion.state & SDL_BUTTON_MMASK) != 0 && bone_ && !section_)
      render::pan(view_, -motion.xrel / static_cast<double>(desk_.renderer().height()),
                  motion.yrel / static_cast<double>(desk_.renderer().height()));
  }

  void turn(double right, double up) {
    if (bone_ && !section_) render::orbit(view_, right, up);
  }
  void zoom(double factor) {
    if (bone_ && !section_) render::zoom(view_, factor);
  }

  // ---- the picture

  // The same views as in the pictures of the instructor's page; a section is a flat picture.
  void see(std::size_t number) {
    if (!bone_ || number >= bone_->views.size()) return;
    const report::ProductView& view = bone_->views[number];
    shown_.view = number;
    section_.reset();
    if (!view.slice) {
      view_ = view.camera;
      render::zoom(view_, 1 / kStep);  // panels lie over a part of the window
      return;
    }
    section_ = bone_->section(view);
    put_section();
  }

  void put_section() {
    if (section_) texture_.put(section_->width, section_->height, 3, section_->rgb);
  }

  // What is seen lies in the middle of what the panels leave free.
  Status draw() {
    if (renewed_ != desk_.renewed()) {
      renewed_ = desk_.renewed();
      texture_.forget();
      put_section();
    }
    render::Scene& scene = bone_ && !section_ ? bone_->scene : empty_;
    const float u = desk_.ui().unit(), high = std::max(1.0F, desk_.ui().height());
    if (bone_ && !section_ && u > 0) {
      scene.camera = view_;
      render::pan(scene.camera, 0.5 * kRatePanel * u / high, -0.5 * kViewsHigh * u / high);
      shown_.wide_mm = 1e3 * view_.view_height() * (desk_.ui().width() - kRatePanel * u) / high;
    } else if (section_) {
      shown_.wide_mm = 1e3 * bone_->views[shown_.view].wide();
    }
    RatePressed pressed;
    const Status drawn = desk_.show(
        scene,
        [&] {
          if (section_ && !shown_.asks_who) draw_section();
          pressed = draw_rate(desk_.ui(), shown_);
        },
        shown_.asks_who);
    desk_.status_text = shown_.heading + " " + shown_.note + " " + shown_.trouble;
    if (pressed.begin) begin();
    if (pressed.view >= 0) see(static_cast<std::size_t>(pressed.view));
    if (pressed.keep) keep();
    if (pressed.later) later();
    if (pressed.leave) closed_ = Closed::page;
    return drawn;
  }

  void draw_section() {
    const Ui& ui = desk_.ui();
    const float u = ui.unit(), wide = ui.width() - kRatePanel * u,
                high = ui.height() - kViewsHigh * u;
    const float share = std::min(wide / static_cast<float>(section_->width),
                                 high / static_cast<float>(section_->height));
    const ImVec2 size = {share * static_cast<float>(section_->width),
                         share * static_cast<float>(section_->height)};
    const ImVec2 at = {(wide - size.x) / 2, (high - size.y) / 2};
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled({0, 0}, {ui.width(), ui.height()}, ink::rgb(17, 19, 22));
    draw.AddImage(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_.name())), at,
                  {at.x + size.x, at.y + size.y});
  }

  Desk& desk_;
  RateState& state_;
  const RateOptions& options_;
  std::unique_ptr<school::Store> store_;
  RateShown shown_;
  std::unique_ptr<ProductBone> bone_;
  render::Camera view_;  // as if nothing lay over the window
  render::Scene empty_;
  std::optional<render::Image> section_;  // none: the bone is shown
  Texture texture_;
  int renewed_ = 0;
  std::optional<Closed> closed_;
  std::unique_ptr<Loading<ProductBone>> loading_;  // last: its thread ends first
};

}  // namespace

Result<Closed> rate(Desk& desk, RateState& state, const RateOptions& options) {
  const auto place = school::place_of(desk.store, desk.places());
  if (!place) return place.error();
  auto store = school::Store::open(*place);
  if (!store) return store.error();
  return Rate(desk, state, options, std::move(*store)).run();
}

}  // namespace burr::app
