// What the user reads on the page: the state of the session, panels, messages.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <utility>

#include "burr/haptics/contact.h"
#include "burr/render/scene.h"
#include "burr/rt/flags.h"
#include "burr/tick/second_hand.h"
#include "burr/workshop/device_book.h"
#include "burr/workshop/fault_file.h"
#include "burr/workshop/work_view.h"
#include "shared/front_words.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"
#include "window/mill/steps_panel.h"
#include "window/mill/views_bar.h"

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

void Mill::look_at_session() {
  if (session_.view(row_)) {
    ticks_.see(row_, session_.settings().servo.rate_hz, Clock::now());
    draw_tool();
    render::show_contact(scene_, row_.hand.world_from_tool.p, row_.contact.proxy,
                         row_.contact.force);
    if (options_.loudspeaker != nullptr)
      options_.loudspeaker->update(row_,
                                   hands_.suction != nullptr ? &hands_.suction->now() : nullptr);
  }
  note(drill_.look());
  show_mirror(scene_, session_.bone().grid(), mirror_.now());
  plane_.show(scene_);
  nearest_ = nearest_spared();
  tick::FaultReport fault;
  // the force of a haptic device was released. A late mouse is no news: it pushes nobody
  if (session_.fault(fault) && hands_.real != nullptr) {
    status_.warn_released(say(Word::let_go, flag_texts(fault.flags)), Clock::now());
    keep_fault_of(session_.hand(), fault);
  }
  if (hands_.suction != nullptr && session_.second_hand()->faults().take(fault)) {
    status_.warn_released(say(Word::let_go, flag_texts(fault.flags)), Clock::now());
    keep_fault_of(hands_.suction->hand(), fault);
  }
}

// The burr is where the bone lets it be. A mouse has no orientation: the shaft is drawn as a hand
// would hold it. Only the picture is concerned.
void Mill::draw_tool() {
  constexpr double kShownSpin = 9;  // 40 000 rpm are too fast to see [rad/s]
  const Clock::time_point now = Clock::now();
  const double seconds =
      std::min(0.1, std::chrono::duration<double>(now - std::exchange(held_at_, now)).count());
  const bool own = hands_.real != nullptr || headset_.wand();
  if (row_.tool.number >= 0) {  // its direction matters to what it cuts: drawn as it is held
    workshop::put_tool(scene_, row_, false);
    looks_.put(scene_, row_.tool.number);
    return;
  }
  const math::Pose hand = {row_.contact.proxy, row_.hand.world_from_tool.q};
  scene_.burr.other = nullptr;
  scene_.burr.world_from_tool =
      own ? hand : held_.at(scene_, hand.p, desk_.settings.left_handed, seconds);
  if (row_.spindle_rad_s > 0)
    scene_.burr.turn = std::remainder(scene_.burr.turn + kShownSpin * seconds, 6.2832);
}

void Mill::keep_fault_of(const device::Device& hand, const tick::FaultReport& fault) {
  const std::filesystem::path& state = desk_.places().state;
  if (state.empty()) return;
  const auto kept = workshop::keep_fault(
      state / "faults",
      workshop::fault_text(fault, hand.spec(), session_.settings().servo.rate_hz, hand.trouble()));
  note(kept ? say(Word::fault_kept, kept->string()) : kept.error().text);
}

void Mill::note(std::string text) {
  text = in_options(text);
  if (!text.empty()) status_.note(std::move(text), Clock::now());
}

std::string Mill::hint() const {
  const bool left = desk_.settings.left_handed;
  const auto begins = [](std::string text) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
  };
  return say(Word::mill_hint, begins(word(left ? Word::key_right : Word::key_left)),
             begins(word(left ? Word::key_left : Word::key_right)));
}

void Mill::note_troubles() {
  for (const std::string& trouble : std::exchange(desk_.troubles, {})) note(trouble);
}

void Mill::update_status() {
  const Clock::time_point now = Clock::now();
  if (now - said_ < std::chrono::milliseconds(200)) return;
  said_ = now;
  note_troubles();
  std::string lasting = options_.warning ? options_.warning() : std::string();
  if (lasting.empty() && lifts_.stopped) lasting = word(Word::stopped);
  if (lasting.empty()) lasting = session_.hand().trouble();
  if (lasting.empty() && hands_.suction != nullptr) lasting = hands_.suction->hand().trouble();
  // a mouse has no motors that could get warm, and nobody feels its ticks
  const std::uint32_t hidden = hands_.real == nullptr ? rt::kFlagThermal | rt::kFlagWatchdog : 0U;
  if (lasting.empty()) lasting = flag_texts(row_.contact.flags & ~hidden);
  warning_ = status_.warning(now, in_options(lasting));
  // after the reason of the release: what the user should do
  if (lasting.empty() && session_.servo().released() && (row_.hand.buttons & device::kLifted) == 0)
    warning_ += (warning_.empty() ? "" : ". ") + std::string(word(Word::begins_free));
  const std::string progress = pages_->exporting().progress();
  if (!progress.empty()) status_.forget_kept();  // of the export before
  note_ = status_.note(now, progress);
  // the value of a measurement is not kept: the strip shows the one that stands in the picture
  const std::string measured = note_.empty() ? measuring_.words() : std::string();
  if (note_.empty() && measured.empty() && hands_.real == nullptr && row_.ledger.removed <= 0)
    note_ = hint();
  const std::string& trouble = pages_->exporting().trouble();
  const std::string& told = note_.empty() ? measured : note_;
  desk_.status_text = !trouble.empty()                   ? trouble
                      : warning_.empty() || told.empty() ? warning_ + told
                                                         : warning_ + "; " + told;
}

float Mill::column() const {
  return scene_.insets.empty()
             ? 0
             : static_cast<float>(desk_.renderer().width() - scene_.insets.front().x);
}

HudState Mill::hud() const {
  const sim::SessionSettings& settings = session_.settings();
  HudState s;
  s.force = row_.contact.force.norm();
  s.user_limit = user_limit();
  s.device_limit = session_.hand().spec().peak_force;
  s.press = pressing() ? press_.depth() : press_.full();
  s.press_most = Press::kMost;
  s.pressing = hands_.real != nullptr ? row_.hand.pedal > 0
               : headset_.wand()      ? headset_.trigger()
                                      : pressing();
  if (plane_.on() && !headset_.wand()) {  // in the plane the hand itself is inside the bone
    s.press = row_.contact.touching ? row_.contact.depth : 0;
    s.pressing = row_.contact.touching;
  }
  s.speed = row_.spindle_rad_s;
  s.full_speed = drill_.full_speed();
  if (settings.servo.motor.torque > 0)
    s.load = std::clamp(row_.cutting_nm / settings.servo.motor.torque, 0.0, 1.0);
  s.burr_diameter = 2 * scene_.burr.radius;
  if (const scenario::RackTool* tool = rack_.tool(row_.tool.number); tool != nullptr) {
    s.tool = rack_.title(row_.tool.number);
    s.burr_diameter = scenario::cutting_width(*tool);
    s.turns = tool->cutter.drive == tool::Drive::turning;
    s.motor = tool::full_speed(tool->cutter) > 0;
  }
  s.mode = drill_.mode();
  s.diamond = scene_.burr.diamond;
  s.removed = options_.earlier.removed + row_.ledger.removed - row_.ledger.undone;
  s.seconds = options_.earlier.seconds + static_cast<double>(row_.tick) / settings.servo.rate_hz;
  s.spares = options_.allowed.distance && options_.spared_distance != nullptr &&
             !options_.spared_distance->empty();
  if (s.spares && nearest_) {
    s.nearest = nearest_;
    s.nearest->name = anatomy(nearest_->name);
  }
  s.device = hands_.real != nullptr || hands_.suction != nullptr;
  s.ticks = ticks_.health(session_.shed() != tick::Shed::none, Clock::now());
  const rt::TickSummary summary = ticks_.stats().summary();
  s.p99_us = summary.p99_us;
  s.max_us = summary.max_us;
  s.missed = ticks_.missed();
  s.picture_step = picture_step_;
  s.column = column();
  s.pixel = scene_.camera.view_height() / std::max(1, desk_.renderer().height());
  if (const edit::Mirror mirror = mirror_.now(); mirror.on())
    s.mirror = mirror_words(session_.bone().grid(), mirror);
  s.note = note_.empty() ? measuring_.words() : note_;
  s.note_stays = status_.kept() && !note_.empty();
  if (s.note.empty() && cue_ != guidance::Technique::Cue::none) s.note = cue_text();
  s.warning = warning_;
  return s;
}

ToolbarState Mill::bar_state() const {
  ToolbarState state;
  state.mode = drill_.mode();
  state.measures = measuring_.on();
  state.mirrors = mirror_.now().on();
  state.diamond = scene_.burr.diamond;
  state.coolant = drill_.irrigated();
  state.slices = slices_shown_;
  state.see_through = scene_.look.opacity < 1;
  state.suction = suction_;
  state.views = menu_ == Menu::views;
  state.menu = menu_ == Menu::all;
  state.rack = menu_ == Menu::rack;
  state.structures = leaf_ == Leaf::structures;
  state.task = leaf_ == Leaf::task || leaf_ == Leaf::steps;
  state.sound = options_.loudspeaker != nullptr && options_.loudspeaker->is_on();
  return state;
}

void Mill::panels() {
  Ui& ui = desk_.ui();
  measuring_.draw(ui, scene_.camera);
  if (!page_open()) pointer_.draw(pressing());
  if (panels_) {
    if (draw_hud(ui, hud())) {
      status_.forget_kept();
      said_ = {};  // the line is gone in the next picture
    }
    slices_->write_names(scene_, ui);
    // the text disappears when the first bone is removed; a key shows it again
    if (row_.ledger.removed > 0 && !std::exchange(task_read_, true) && leaf_ == Leaf::task)
      leaf_ = steps_offered() && options_.allowed.steps == workshop::Offer::always ? Leaf::steps
                                                                                   : Leaf::none;
    if (!page_open()) {
      const ViewsBar bar =
          draw_views_bar(ui, views_.kind(), scene_.camera.view_height(),
                         views_.deep() ? std::optional(views_.beyond()) : std::nullopt);
      if (bar.view) take_view(*bar.view);
      if (bar.magnify != 0) magnify(bar.magnify);
      if (bar.refocus != 0) refocus(bar.refocus);
    }
    draw_pins();
    light_.draw(ui, scene_.camera);
    draw_side_panel();
    if (options_.done_ends && !page_open() && draw_done_button(ui, column())) declare_done();
    draw_orientation();
    draw_menu_panel();
    if (const auto pressed = draw_toolbar(ui, bar_state())) act(*pressed);
    if (!page_open()) draw_name();
  }
  notes_.draw(ui, scene_.camera, column());
  pages();
}

void Mill::pages() {
  const device::DeviceSpec spec =
      hands_.real != nullptr ? hands_.real->spec() : device::DeviceSpec();
  DeviceLeaf device{hands_.id, spec.peak_force, spec.peak_torque > 0, hands_.preferences};
  const OverPages::Changed changed =
      pages_->draw(hands_.real != nullptr ? &device : nullptr, open_steps());
  if (changed.done) end_as_done();
  if (changed.device) keep_device_preferences();
  if (changed.force_limit) session_.command({tick::CommandKind::user_force, user_limit()});
  if (!changed.settings) return;
  press_.begin_at(1e-3 * desk_.settings.press_mm);
  note_troubles();
}

// Saves them in the book of devices; the new force limit is used at once.
void Mill::keep_device_preferences() {
  const double peak = hands_.real->spec().peak_force, requested = hands_.preferences.max_force_n;
  hands_.max_force = requested > 0 ? std::min(peak, requested) : peak;
  session_.command({tick::CommandKind::user_force, user_limit()});
  workshop::DeviceBook book = workshop::DeviceBook::read(workshop::users_book());
  book.put(hands_.id, hands_.preferences);
  const Status kept = book.write(workshop::users_book());
  if (!kept) note(kept.error().text);
}

void Mill::leave_picture() {
  picture_ = false;
  const Result<std::string> left = desk_.leave_picture(options_.folder);
  note(left ? say(Word::picture_left, *left) : left.error().text);
}

}  // namespace burr::app
