#include "window/mill/window.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "commands/command.h"
#include "window/mill/mill.h"
#include "window/shell/words.h"
#include "workshop/live_surface.h"
#include "workshop/work_view.h"

namespace burr::app {

Result<Left> Mill::run() {
  desk_.page = Page::milling;
  scene_.scale_bar = false;  // the panels have one
  scene_.burr.visible = true;
  const tool::Burr& burr = session_.settings().servo.burr;
  scene_.burr.radius = burr.radius;
  scene_.burr.diamond = burr.kind == tool::BurrKind::diamond;
  scene_.burr.shaft_radius = burr.shaft_radius;
  scene_.burr.shaft_length = burr.shaft_length;
  mode_ = session_.settings().servo.mode;
  irrigated_ = session_.settings().servo.irrigated;
  full_speed_ = session_.settings().servo.spindle_rad_s;
  panels_ = desk_.settings.panels;
  help_ = desk_.settings.help;
  press_ = std::clamp(1e-3 * desk_.settings.press_mm, kPressLeast, kPressMost);
  if (user_limit() != session_.settings().servo.limit.user_force)
    session_.command({tick::CommandKind::user_force, user_limit()});
  for (const std::string& trouble : std::exchange(desk_.troubles, {})) note(trouble);

  LiveSurface live(session_, worker_, scene_, desk_.renderer().software());
  slices_.emplace(session_.bone(), options_.greys);
  const std::filesystem::path& state = desk_.places().state;
  saved_views_.emplace(state.empty() ? state : state / "views.toml",
                       key_of(session_.bone().grid()));
  if (!saved_views_->trouble().empty()) note(saved_views_->trouble());
  export_.emplace(desk_, &session_, scene_, options_.folder, options_.film_of);
  colours_ = scene_.tissue_colours;
  desk_.mouse(mouse_x_, mouse_y_);  // before it moves
  aim_at_mouse();
  desk_.cap.open();
  lift();
  hands_taken_ = Clock::now();
  session_.start();
  const Clock::time_point start = Clock::now();
  Clock::time_point frame = start;
  Status shown = fine();
  while (open_ && shown && !interrupted()) {
    take_events();
    take_hands();
    look_at_session();
    if (!desk_.settings.effects)
      live.look_plain();
    else if (first_tick_)
      live.see(wound_tick(row_, session_.settings().servo.rate_hz));
    lead_suction(live);
    begin_headset(live.governor());
    point();
    measure();
    if (std::string told = export_->step(); !told.empty()) note(std::move(told));
    tell();
    slices_->update(scene_, slices_shown_ && panels_, labels_, desk_.renderer().width(),
                    desk_.renderer().height(), static_cast<int>(hud_height(desk_.ui())));
    live.update(seen_ ? headset_cameras_.data() : nullptr);
    const Clock::time_point drawing = Clock::now();
    // whoever wears a headset comes first; the window follows thirty times a second
    if (!seen_ || drawing - window_drawn_ > std::chrono::milliseconds(30)) {
      window_drawn_ = drawing;
      shown = desk_.show(scene_, panels_ || page_open() || measuring_.on() || leads_
                                     ? [this] { panels(); }
                                     : std::function<void()>());
    }
    end_headset();
    live.drawn(std::chrono::duration<double>(Clock::now() - drawing).count(),
               desk_.renderer().figures().redrawn);
    picture_step_ = live.governor().step();
    if (picture_) leave_picture();

    // where the driver does not wait for the screen: 60 pictures a second are enough; and fewer
    // where the machine does not keep up with the hand
    const auto pause =
        std::chrono::microseconds(session_.shed() >= tick::Shed::picture ? 100'000 : 16'667);
    frame = std::max(frame + pause, Clock::now());
    const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(frame - Clock::now());
    const bool paced = desk_.headset != nullptr && desk_.headset->running();
    if (wait.count() > 0 && !paced) SDL_Delay(static_cast<Uint32>(wait.count()));
    if (options_.seconds > 0 &&
        std::chrono::duration<double>(Clock::now() - start).count() >= options_.seconds)
      open_ = false;
  }
  take_off_headset();
  mouse_leads();
  export_.reset();
  session_.stop();
  scene_.insets.clear();
  scene_.tissue_colours = colours_;
  scene_.look.opacity = 1;
  live.look_plain();
  worker_.hold_back(false);
  worker_.settle([this](const surface::Skin& skin) { put_skin(scene_, skin); });
  if (!shown) return shown.error();
  if (!options_.screenshot.empty()) {
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
  }
  return left_;
}

Result<Left> mill(Desk& desk, sim::Session& session, const Hands& hands, surface::Worker& worker,
                  render::Scene& scene, const WindowOptions& options) {
  return Mill(desk, session, hands, worker, scene, options).run();
}

Status run_window(sim::Session& session, const Hands& hands, surface::Worker& worker,
                  render::Scene& scene, const WindowOptions& options) {
  auto desk = Desk::open({});
  if (!desk) return desk.error();
  const Result<Left> left = mill(**desk, session, hands, worker, scene, options);
  if (!left) return left.error();
  return fine();
}

}  // namespace burr::app
