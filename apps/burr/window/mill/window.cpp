#include "window/mill/window.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "burr/render/picture.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/work_view.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"

namespace burr::app {

Result<Closed> Mill::run() {
  workshop::LiveSurface live(session_, worker_, scene_, desk_.renderer().software(),
                             desk_.governor);
  begin();
  const Clock::time_point start = Clock::now();
  Clock::time_point frame_at = start;
  Status shown = fine();
  while (open_ && shown && !interrupted()) {
    shown = frame(live);
    if (picture_) leave_picture();

    // where the driver does not wait for the screen: 60 pictures a second, and fewer where the
    // computer is too slow for the haptic loop
    const auto pause =
        std::chrono::microseconds(session_.shed() >= tick::Shed::picture ? 100'000 : 16'667);
    frame_at = std::max(frame_at + pause, Clock::now());
    const auto wait =
        std::chrono::duration_cast<std::chrono::milliseconds>(frame_at - Clock::now());
    const bool paced = desk_.headset != nullptr && desk_.headset->running();
    if (wait.count() > 0 && !paced) SDL_Delay(static_cast<Uint32>(wait.count()));
    if (options_.seconds > 0 &&
        std::chrono::duration<double>(Clock::now() - start).count() >= options_.seconds) {
      open_ = false;
      time_over_ = true;
    }
  }
  end(live);
  if (!shown) return shown.error();
  if (!options_.screenshot.empty()) {
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
  }
  return closed_;
}

void Mill::begin() {
  desk_.page = Page::milling;
  desk_.renderer().title(options_.title.empty() ? "burr" : options_.title + " - burr");
  scene_.scale_bar = false;  // the page has its own
  scene_.burr.visible = true;
  press_.begin_at(1e-3 * desk_.settings.press_mm);
  if (user_limit() != session_.settings().servo.limit.user_force)
    session_.command({tick::CommandKind::user_force, user_limit()});
  note_troubles();
  colours_ = scene_.tissue_colours;
  structures_.emplace(session_.bone(), options_.lesson ? &*options_.lesson : nullptr,
                      options_.work_case ? &*options_.work_case : nullptr);
  through_ = scene_.camera.target;  // the work
  if (!options_.work_case) leaf_ = Leaf::none;
  slices_.emplace(session_.bone(), options_.greys);
  const std::filesystem::path& state = desk_.places().state;
  saved_views_.emplace(state.empty() ? state : state / "views.toml",
                       key_of(session_.bone().grid()));
  note(saved_views_->trouble());
  show_labels(labels_);  // an exam begins without the colours of the tissues
  if (options_.mode == record::Mode::exam) note(word(Word::exam_begins));
  pages_.emplace(desk_, session_, scene_, options_, &Mill::help_rows);
  pieces_.emplace(session_, options_.lesson ? &*options_.lesson : nullptr);
  if (steps_offered() && options_.mode != record::Mode::free)
    watch_.emplace(session_.bone(), *options_.lesson);
  pointer_.begin();
  first_view();
  // without a graphics card it would cost every third picture
  views_.deep(!desk_.renderer().software());
  desk_.cap.open();
  lift();
  hands_taken_ = Clock::now();
  session_.start();
}

// One picture: reads the user's input, reads the session, and draws.
Status Mill::frame(workshop::LiveSurface& live) {
  take_events();
  take_hands();
  look_at_session();
  look_at_pieces();
  views_.look(scene_);
  if (!desk_.settings.effects)
    live.look_plain();
  else if (ticks_.begun())
    see_cuts(live);
  suck(live);
  tube_.lead(hands_.suction, scene_, live, desk_.settings.effects, !carries_piece());
  note(headset_.begin(live.governor(), scene_.camera));
  look_at_injury();
  point();
  measure();
  if (ticks_.begun()) begin_steps();
  look_at_measure();
  look_at_technique();
  keep_diary();
  if (ExportPage::Told told = pages_->exporting().step(); told.stays)
    status_.keep(std::move(told.text));
  else
    note(std::move(told.text));
  update_status();
  look_at_names();
  view_turn_.step(scene_.camera, Clock::now());
  slices_->update(scene_, slices_through(), slices_shown_ && panels_, labels_,
                  desk_.renderer().width(), desk_.renderer().height(),
                  static_cast<int>(hud_height(desk_.ui())));
  draw_rack_pictures();
  live.update(headset_.cameras());
  const Clock::time_point drawing = Clock::now();
  Status shown = fine();
  // the headset has priority; the window is then drawn about thirty times a second
  if (!headset_.shows() || drawing - window_drawn_ > std::chrono::milliseconds(30)) {
    window_drawn_ = drawing;
    const bool says =
        panels_ || page_open() || measuring_.on() || pointer_.pad_leads() || !notes_.empty();
    shown = desk_.show(scene_, says ? [this] { panels(); } : std::function<void()>());
  }
  talk();
  headset_.end(scene_);
  live.drawn(std::chrono::duration<double>(Clock::now() - drawing).count(),
             desk_.renderer().figures().redrawn);
  picture_step_ = live.governor().step();
  return shown;
}

void Mill::end(workshop::LiveSurface& live) {
  headset_.take_off();
  pointer_.mouse_leads();
  pages_.reset();
  pieces_->end();
  pieces_->show(scene_, false);
  pieces_.reset();
  session_.stop();
  end_diary();
  light_.off(scene_);
  views_.end(scene_);
  watch_.reset();
  scene_.insets.clear();
  scene_.tissue_colours = colours_;
  scene_.look.opacity = 1;
  live.look_plain();
  worker_.hold_back(false);
  worker_.settle([this](const surface::Skin& skin) { workshop::put_skin(scene_, skin); });
}

Result<Closed> mill(Desk& desk, sim::Session& session, const mouse::Hands& hands,
                    surface::Worker& worker, render::Scene& scene, const WindowOptions& options) {
  return Mill(desk, session, hands, worker, scene, options).run();
}

Status run_window(sim::Session& session, const mouse::Hands& hands, surface::Worker& worker,
                  render::Scene& scene, const WindowOptions& options) {
  auto desk = Desk::open({});
  if (!desk) return desk.error();
  const Result<Closed> left = mill(**desk, session, hands, worker, scene, options);
  if (!left) return left.error();
  return fine();
}

}  // namespace burr::app
