// What stands over the picture on the page for milling: figures, texts, panels, pages.
#include <algorithm>
#include <cctype>
#include <chrono>
#include <utility>

#include "burr/rt/flags.h"
#include "burr/workshop/device_book.h"
#include "burr/workshop/suction_hand.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"
#include "window/mill/mill_keys.h"
#include "window/mill/steps_panel.h"
#include "window/mill/window.h"

namespace burr::app {
namespace {

constexpr std::pair<std::uint32_t, Word> kFlagWords[] = {
    {rt::kFlagNotFinite, Word::flag_not_finite},
    {rt::kFlagHandLost, Word::flag_hand_lost},
    {rt::kFlagWatchdog, Word::flag_watchdog},
    {rt::kFlagJump, Word::flag_jump},
    {rt::kFlagForceLimited, Word::flag_force_limited},
    {rt::kFlagThermal, Word::flag_thermal},
    {rt::kFlagCandidates, Word::flag_candidates},
    {rt::kFlagReserve, Word::flag_reserve},
    {rt::kFlagUndoFull, Word::flag_undo_full},
    {rt::kFlagRestoring, Word::flag_restoring},
    {rt::kFlagNotCut, Word::flag_not_cut},
    {rt::kFlagPutOff, Word::flag_put_off},
};

// How the mouse mills.
std::string hint(bool left) {
  const auto begins = [](std::string text) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
  };
  return say(Word::mill_hint, begins(word(left ? Word::key_right : Word::key_left)),
             begins(word(left ? Word::key_left : Word::key_right)));
}

}  // namespace

// The flags that a surgeon should see at once, in the user's language. Two are left out: work that
// is put off has its own sign, and the force's bar shows the limit.
std::string flag_texts(std::uint32_t flags) {
  std::string text;
  flags &= ~(rt::kFlagPutOff | rt::kFlagForceLimited);
  for (const auto& [flag, says] : kFlagWords)
    if ((flags & flag) != 0) text += (text.empty() ? "" : ", ") + std::string(word(says));
  return text;
}

std::string flag_words(std::uint32_t flags) {
  std::string text;
  for (const auto& [flag, says] : kFlagWords)
    if ((flags & flag) != 0) text += (text.empty() ? "" : ", ") + std::string(english(says));
  return text;
}

void Mill::note_troubles() {
  for (const std::string& trouble : std::exchange(desk_.troubles, {})) notes_.note(trouble);
}

void Mill::update_status() {
  if (!notes_.due()) return;
  note_troubles();
  MillNotes::Stands now;
  now.warning = options_.warning ? options_.warning() : std::string();
  if (now.warning.empty() && parts_.hand.stopped()) now.warning = word(Word::stopped);
  if (now.warning.empty()) now.warning = session_.hand().trouble();
  if (now.warning.empty() && hands_.suction != nullptr)
    now.warning = hands_.suction->hand().trouble();
  // a mouse has no motors that could get warm, and nobody feels its ticks
  const std::uint32_t hidden = hands_.real == nullptr ? rt::kFlagThermal | rt::kFlagWatchdog : 0U;
  if (now.warning.empty()) now.warning = flag_texts(row_.contact.flags & ~hidden);
  now.released = session_.servo().released() && (row_.hand.buttons & device::kLifted) == 0;
  now.progress = over_.pages->exporting().progress();
  now.measured = parts_.hand.measuring().words();
  if (hands_.real == nullptr && row_.ledger.removed <= 0)
    now.hint = hint(desk_.settings.left_handed);
  now.trouble = over_.pages->exporting().trouble();
  desk_.status_text = notes_.renew(now);
}

HudState Mill::hud() const {
  const sim::SessionSettings& settings = session_.settings();
  const MillTools& tools = parts_.tools;
  HudState s;
  s.force = row_.contact.force.norm();
  s.device_limit = session_.hand().spec().peak_force;
  parts_.hand.tell(s);
  s.speed = row_.spindle_rad_s;
  s.full_speed = tools.drill().full_speed();
  if (settings.servo.motor.torque > 0)
    s.load = std::clamp(row_.cutting_nm / settings.servo.motor.torque, 0.0, 1.0);
  s.burr_diameter = 2 * scene_.burr.radius;
  if (const scenario::RackTool* tool = tools.rack().tool(row_.tool.number); tool != nullptr) {
    s.tool = tools.rack().title(row_.tool.number);
    s.burr_diameter = scenario::cutting_width(*tool);
    s.turns = tool->cutter.drive == tool::Drive::turning;
    s.motor = tool::full_speed(tool->cutter) > 0;
  }
  s.mode = tools.drill().mode();
  s.diamond = scene_.burr.diamond;
  s.removed = options_.earlier.removed + row_.ledger.removed - row_.ledger.undone;
  s.seconds = options_.earlier.seconds + static_cast<double>(row_.tick) / settings.servo.rate_hz;
  s.spares = options_.allowed.distance && options_.spared_distance != nullptr &&
             !options_.spared_distance->empty();
  if (s.spares && tools.nearest()) {
    s.nearest = tools.nearest();
    s.nearest->name = anatomy(s.nearest->name);
  }
  s.device = hands_.real != nullptr || hands_.suction != nullptr;
  s.ticks = ticks_.health(session_.shed() != tick::Shed::none, Clock::now());
  const rt::TickSummary summary = ticks_.stats().summary();
  s.p99_us = summary.p99_us;
  s.max_us = summary.max_us;
  s.missed = ticks_.missed();
  s.picture_step = picture_step_;
  s.column = parts_.view.column();
  s.pixel = scene_.camera.view_height() / std::max(1, desk_.renderer().height());
  if (const edit::Mirror mirror = tools.mirror(); mirror.on())
    s.mirror = mirror_words(session_.bone().grid(), mirror);
  s.note = notes_.text().empty() ? parts_.hand.measuring().words() : notes_.text();
  s.note_stays = notes_.stays();
  if (s.note.empty()) s.note = parts_.work_case.cue_text();
  s.warning = notes_.warning();
  return s;
}

ToolbarState Mill::bar_state() const {
  ToolbarState state;
  state.mode = parts_.tools.drill().mode();
  state.measures = parts_.hand.measuring().on();
  state.mirrors = parts_.tools.mirror().on();
  state.diamond = scene_.burr.diamond;
  state.coolant = parts_.tools.drill().irrigated();
  state.slices = parts_.view.slices_shown();
  state.see_through = scene_.look.opacity < 1;
  state.suction = parts_.tools.sucks();
  state.views = over_.menu == Menu::views;
  state.menu = over_.menu == Menu::all;
  state.rack = over_.menu == Menu::rack;
  state.structures = parts_.side.leaf() == Leaf::structures;
  state.task = parts_.side.leaf() == Leaf::task || parts_.side.leaf() == Leaf::steps;
  state.sound = options_.loudspeaker != nullptr && options_.loudspeaker->is_on();
  return state;
}

void Mill::panels() {
  Ui& ui = desk_.ui();
  parts_.hand.measuring().draw(ui, scene_.camera);
  if (!over_.page()) parts_.pointer.draw(parts_.hand.pressing());
  if (over_.panels) draw_figures();
  station_.marks().draw(ui, scene_.camera, parts_.view.column());
  pages();
}

void Mill::draw_figures() {
  Ui& ui = desk_.ui();
  if (draw_hud(ui, hud())) notes_.click_away();
  parts_.view.slices().write_names(scene_, ui);
  if (row_.ledger.removed > 0) parts_.side.leave_task();
  if (!over_.page()) parts_.view.draw_bar(ui, parts_.hand.work());
  parts_.names.draw_pins(ui, parts_.side.right());
  parts_.work_case.draw_light(ui, parts_.view.column());
  parts_.side.draw(ui);
  if (options_.done_ends && !over_.page() && draw_done_button(ui, parts_.view.column()))
    actions_.declare_done();
  parts_.view.draw_orientation(ui);
  draw_menu_panel();
  if (const auto pressed = draw_toolbar(ui, bar_state())) actions_.act(*pressed);
  if (!over_.page()) parts_.names.draw_name(ui, parts_.hand.pressing());
}

// The items of the menu are those keys of the table that have no button.
void Mill::draw_menu_panel() {
  Ui& ui = desk_.ui();
  if (!over_.menu) return;
  switch (*over_.menu) {
    case Menu::rack:
      return parts_.tools.draw_panel(ui);
    case Menu::pieces:
      if (parts_.pieces.draw_panel(ui)) parts_.hand.lift();
      return;
    case Menu::views:
    case Menu::all:
      if (draw_key_menu(ui, actions_, over_.menu == Menu::views, desk_.settings.left_handed))
        over_.menu.reset();
  }
}

void Mill::pages() {
  const device::DeviceSpec spec =
      hands_.real != nullptr ? hands_.real->spec() : device::DeviceSpec();
  DeviceLeaf device{hands_.id, spec.peak_force, spec.peak_torque > 0, hands_.preferences};
  const OverPages::Changed changed = over_.pages->draw(
      hands_.real != nullptr ? &device : nullptr, parts_.work_case.open_steps(), becomes_of_it());
  if (changed.done) actions_.end_as_done();
  if (changed.leave) actions_.end_as_left();
  if (changed.device) keep_device_preferences();
  if (changed.force_limit)
    session_.command({tick::CommandKind::user_force, parts_.hand.user_limit()});
  if (!changed.settings) return;
  parts_.hand.take_settings();
  note_troubles();
}

// Of the session, if it is left now.
Word Mill::becomes_of_it() const {
  const Word told = options_.left_as ? options_.left_as() : Word::leave_told_lost;
  const bool worked =
      row_.ledger.removed > 0 || row_.ledger.added > 0 || options_.earlier.seconds > 0;
  return told == Word::leave_told_kept && !worked ? Word::leave_told_nothing : told;
}

// Saves them in the book of devices; the new force limit is used at once.
void Mill::keep_device_preferences() {
  const double peak = hands_.real->spec().peak_force, requested = hands_.preferences.max_force_n;
  hands_.max_force = requested > 0 ? std::min(peak, requested) : peak;
  session_.command({tick::CommandKind::user_force, parts_.hand.user_limit()});
  workshop::DeviceBook book = workshop::DeviceBook::read(workshop::users_book());
  book.put(hands_.id, hands_.preferences);
  const Status kept = book.write(workshop::users_book());
  if (!kept) notes_.note(kept.error().text);
}

void Mill::leave_picture() {
  const Result<std::string> left = desk_.leave_picture(options_.folder);
  notes_.note(left ? say(Word::picture_left, *left) : left.error().text);
}

}  // namespace burr::app
