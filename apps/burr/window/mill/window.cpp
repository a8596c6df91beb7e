#include "window/mill/window.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "burr/render/picture.h"
#include "burr/render/stereo.h"
#include "burr/tick/second_hand.h"
#include "burr/workshop/fault_file.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/seen.h"
#include "burr/workshop/suction_hand.h"
#include "burr/workshop/work_view.h"
#include "shared/interrupt.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"
#include "window/mill/mill_keys.h"

namespace burr::app {

Mill::Mill(Desk& desk, sim::Session& session, const mouse::Hands& hands, surface::Worker& worker,
           render::Scene& scene, const WindowOptions& options)
    : desk_(desk),
      session_(session),
      worker_(worker),
      scene_(scene),
      hands_(hands),
      options_(options),
      over_{.panels = desk.settings.panels},
      site_{desk_, session_, scene_, hands_, options_, row_, notes_, over_},
      parts_(site_),
      actions_(site_, parts_),
      input_(site_, parts_, actions_),
      station_(site_, parts_.work_case) {}

Result<Closed> Mill::run() {
  workshop::LiveSurface live(session_, worker_, scene_, desk_.renderer().software(),
                             desk_.governor);
  begin();
  const Clock::time_point start = Clock::now();
  Clock::time_point frame_at = start;
  Status shown = fine();
  while (actions_.open() && shown && !interrupted()) {
    shown = frame(live);
    if (actions_.take_picture()) leave_picture();

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
      actions_.quit();
      time_over_ = true;
    }
  }
  end(live);
  if (!shown) return shown.error();
  if (!options_.screenshot.empty()) {
    const Status kept = render::write_png(desk_.renderer().shown(), options_.screenshot);
    if (!kept) return kept.error();
  }
  return actions_.closed();
}

void Mill::begin() {
  desk_.page = Page::milling;
  desk_.renderer().title(options_.title.empty() ? "burr" : options_.title + " - burr");
  scene_.scale_bar = false;  // the page has its own
  scene_.burr.visible = true;
  if (parts_.hand.user_limit() != session_.settings().servo.limit.user_force)
    session_.command({tick::CommandKind::user_force, parts_.hand.user_limit()});
  note_troubles();
  parts_.view.begin();
  if (options_.mode == record::Mode::exam) notes_.note(word(Word::exam_begins));
  over_.pages.emplace(desk_, session_, scene_, options_, &mill_help_rows);
  parts_.pieces.begin();
  over_.pages->exporting().know_pieces([this] { return parts_.pieces.moved(); });
  parts_.work_case.begin();
  parts_.pointer.begin();
  parts_.hand.begin();
  parts_.follower.begin();
  session_.start();
}

// One picture: reads the user's input, reads the session, and draws.
Status Mill::frame(workshop::LiveSurface& live) {
  input_.take_events();
  parts_.hand.take_pads();
  look_at_session();
  parts_.pieces.look();
  parts_.view.look();
  parts_.tools.wet(live, ticks_.begun(), !parts_.pieces.carries());
  notes_.note(parts_.headset.begin(live.governor(), scene_.camera));
  stop_at_injury();
  parts_.hand.point();
  parts_.hand.measure();
  if (ticks_.begun()) look_at_case();
  parts_.follower.look();
  if (ExportPage::Note note = over_.pages->exporting().step(); note.stays)
    notes_.keep(std::move(note.text));
  else
    notes_.note(std::move(note.text));
  update_status();
  parts_.names.look(parts_.side.leaf() == Leaf::structures, parts_.hand.pressing());
  parts_.view.step(parts_.hand.below());
  parts_.tools.draw_pictures();
  return show(live);
}

void Mill::look_at_session() {
  if (session_.view(row_)) {
    ticks_.see(row_, session_.settings().servo.rate_hz, Clock::now());
    parts_.tools.show_row();
    render::show_contact(scene_, row_.hand.world_from_tool.p, row_.contact.proxy,
                         row_.contact.force);
    if (options_.loudspeaker != nullptr)
      options_.loudspeaker->update(row_,
                                   hands_.suction != nullptr ? &hands_.suction->now() : nullptr);
  }
  parts_.tools.look();
  parts_.hand.show_plane();
  tick::FaultReport fault;
  // the force of a haptic device was released. A late mouse is no news: it pushes nobody
  if (session_.fault(fault) && hands_.real != nullptr) {
    notes_.warn_released(say(Word::let_go, flag_texts(fault.flags)));
    keep_fault_of(session_.hand(), fault);
  }
  if (hands_.suction != nullptr && session_.second_hand()->faults().take(fault)) {
    notes_.warn_released(say(Word::let_go, flag_texts(fault.flags)));
    keep_fault_of(hands_.suction->hand(), fault);
  }
}

void Mill::keep_fault_of(const device::Device& hand, const tick::FaultReport& fault) {
  const std::filesystem::path& state = desk_.places().state;
  if (state.empty()) return;
  const auto kept = workshop::keep_fault(
      state / "faults",
      workshop::fault_text(fault, hand.spec(), session_.settings().servo.rate_hz, hand.trouble()));
  notes_.note(kept ? say(Word::fault_kept, kept->string()) : kept.error().text);
}

// The burr is lifted: stop and look.
void Mill::stop_at_injury() {
  const MillTools::Nearest& nearest = parts_.tools.nearest();
  if (!parts_.work_case.look_at_injury(nearest, parts_.tools.drill().full_speed())) return;
  parts_.hand.lift();
  if (hands_.real != nullptr && !parts_.hand.stopped()) parts_.hand.stop_or_go_on();
  parts_.work_case.say_injury(nearest->name);
}

void Mill::look_at_case() {
  const MillTools::Nearest& nearest = parts_.tools.nearest();
  parts_.work_case.look_at_steps(over_.pages->asks_done());
  parts_.work_case.look_at_technique(nearest, parts_.tools.rack().tool(row_.tool.number));
  parts_.work_case.keep_diary(sight(), nearest, over_.panels);
}

// What the user sees, for the recording.
record::Sight Mill::sight() const {
  record::Sight sight;
  const render::Camera* worn = parts_.headset.cameras();
  sight.view = worn != nullptr ? workshop::view_of(worn[0], worn[1], row_.tick)
                               : workshop::view_of(scene_.camera, row_.tick);
  sight.view.see_through = 1 - scene_.look.opacity;
  sight.view.colours = parts_.view.labels();
  sight.view.slices = parts_.view.slices_shown() && over_.panels;
  sight.view.panels = over_.panels;
  sight.view.two_eyes = worn != nullptr || desk_.settings.stereo != render::Stereo::off;

  if (sight.view.colours) sight.helps.insert("labels");
  if (sight.view.slices) sight.helps.insert("slices");
  if (scene_.look.opacity < 1) sight.helps.insert("see-through");
  parts_.side.tell(sight);
  if (station_.has_marks()) sight.helps.insert("instructor");
  if (over_.page()) sight.paused = "page";
  if (parts_.hand.stopped()) sight.paused = "stopped";
  return sight;
}

Status Mill::show(workshop::LiveSurface& live) {
  live.update(parts_.headset.cameras());
  const Clock::time_point drawing = Clock::now();
  Status shown = fine();
  // the headset has priority; the window is then drawn about thirty times a second
  if (!parts_.headset.shows() || drawing - window_drawn_ > std::chrono::milliseconds(30)) {
    window_drawn_ = drawing;
    const bool says = over_.panels || over_.page() || parts_.hand.measuring().on() ||
                      parts_.pointer.pad_leads() || station_.has_marks();
    shown = desk_.show(scene_, says ? [this] { panels(); } : std::function<void()>());
  }
  station_.talk();
  parts_.headset.feel(row_, over_.page() || parts_.hand.stopped());
  parts_.headset.end(scene_);
  live.drawn(std::chrono::duration<double>(Clock::now() - drawing).count(),
             desk_.renderer().figures().redrawn);
  picture_step_ = live.governor().step();
  return shown;
}

void Mill::end(workshop::LiveSurface& live) {
  parts_.headset.take_off();
  parts_.pointer.mouse_leads();
  over_.pages.reset();
  parts_.pieces.end();
  session_.stop();
  static_cast<void>(session_.view(row_));  // the last one
  parts_.work_case.end(time_over_);
  if (options_.suction_left) options_.suction_left(parts_.tools.sucks());
  parts_.view.end();
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
