#include "window/mill/mill_tools.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "burr/tick/second_hand.h"
#include "burr/workshop/suction_hand.h"
#include "burr/workshop/tool_places.h"
#include "burr/workshop/work_view.h"
#include "shared/word_names.h"
#include "window/mill/rack_panel.h"

namespace burr::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStep = 15 * kDegree;  // of a key, a button, a step of the wheel

}  // namespace

MillTools::MillTools(const MillSite& site, MillCase& work_case, const WornHeadset& headset)
    : desk_(site.desk),
      session_(site.session),
      scene_(site.scene),
      hands_(site.hands),
      options_(site.options),
      row_(site.row),
      notes_(site.notes),
      over_(site.over),
      case_(work_case),
      headset_(headset),
      drill_(site.session, site.scene.burr),
      rack_(site.options.rack),
      mirror_(site.session.bone().grid()),
      looks_(site.session.settings().servo.tools),
      suction_(site.options.left.suction) {
  grip_.take(rack_.tool(drill_.tool()));
}

void MillTools::take(int place) {
  over_.menu.reset();
  notes_.note(drill_.take_tool(std::max(place, -1), rack_.tool(place)));
  grip_.take(rack_.tool(place));
  if (place >= 0) return notes_.note(say(Word::tool_now, rack_.title(place)));
  const bool diamond = place == ToolRack::kDiamond;
  notes_.note(diamond != scene_.burr.diamond
                  ? drill_.toggle_kind()
                  : std::string(word(diamond ? Word::now_diamond : Word::now_fluted)));
}

void MillTools::suit(const scenario::Step& step) {
  if (step.tool.empty()) {
    notes_.note(drill_.suit(step));
    return grip_.take(rack_.tool(drill_.tool()));
  }
  for (int place = 0; place < rack_.size(); ++place)
    if (rack_.tool(place)->name == step.tool && place != drill_.tool()) return take(place);
}

void MillTools::next(int by) {
  const int first = scene_.burr.diamond ? ToolRack::kDiamond : ToolRack::kCutting;
  const int count = rack_.size() + 1, now = drill_.tool() + 1;
  const int next = (now + by + count) % count;
  take(next == 0 ? first : next - 1);
}

void MillTools::roll(double steps) {
  if (!holds_by_mouse()) return notes_.note(word(Word::tool_not_turned));
  grip_.roll(kStep * steps);
  notes_.note(say(Word::tool_rolled, static_cast<int>(std::lround(grip_.rolled() / kDegree))));
}

void MillTools::lean(double steps) {
  if (!holds_by_mouse()) return notes_.note(word(Word::tool_not_turned));
  grip_.lean(kStep * steps);
  notes_.note(say(Word::tool_leaned, static_cast<int>(std::lround(grip_.leaned() / kDegree))));
}

void MillTools::lean_on() {
  constexpr double kAlmostFlat = 1.56;  // [rad]
  lean(grip_.leaned() > kAlmostFlat ? -6 : 1);
}

// The user's hand cannot turn the tool, so the page does.
bool MillTools::holds_by_mouse() const {
  return hands_.real == nullptr && !headset_.wand() && !grip_.burr();
}

void MillTools::toggle_mirror() {
  mirror_.toggle();
  note_mirror();
}

void MillTools::mirror_at_tip() {
  if (!case_.allows(Action::mirror)) return case_.say_refused();
  mirror_.place_at(scene_.burr.world_from_tool.p);
  note_mirror();
}

void MillTools::mirror_next_plane() {
  if (!case_.allows(Action::mirror)) return case_.say_refused();
  mirror_.next_plane();
  note_mirror();
}

void MillTools::note_mirror() {
  session_.command(tick::command_for(mirror_.now()));
  notes_.note(mirror_words(session_.bone().grid(), mirror_.now()));
}

void MillTools::toggle_suction() {
  suction_ = !suction_;
  sucked_ = Clock::now();
  notes_.note(word(suction_ ? Word::suction_on : Word::suction_off));
}

void MillTools::suck(workshop::LiveSurface& live) {
  constexpr double kMost = 0.1;  // of one picture [s]
  const double seconds =
      std::chrono::duration<double>(Clock::now() - std::exchange(sucked_, Clock::now())).count();
  if (suction_ && desk_.settings.effects)
    live.suck(scene_.burr.world_from_tool.p, suction_reach(), std::min(seconds, kMost));
}

std::optional<sim::PieceMover::Suction> MillTools::splinter_suction() const {
  using workshop::SuctionHand;
  sim::PieceMover::Suction by;
  if (hands_.suction != nullptr && workshop::sucks(hands_.suction->now())) {
    const tick::TickRow& row = hands_.suction->now();
    by = {row.contact.proxy, row.tool.radius + sim::PieceMover::kSuctionReach, row.tool.radius,
          true};
    return by;
  }
  if (!suction_) return {};
  by.mouth = scene_.burr.world_from_tool.p;
  by.reach = suction_reach() + sim::PieceMover::kSuctionReach;
  by.bore = SuctionHand::kRadius;
  return by;
}

// Fresh bone, dust and water of both hands' tools.
void MillTools::see_cuts(workshop::LiveSurface& live) {
  const tick::ServoSettings& servo = session_.settings().servo;
  const bool cuts = hands_.suction != nullptr && hands_.suction->tool() != nullptr;
  const tick::TickRow* second = cuts ? &hands_.suction->now() : nullptr;
  live.see(workshop::wound_tick(row_, servo.rate_hz, servo.tools, second));
  if (!cuts) return;
  const tool::ShapedTool& tool = *session_.second_hand()->settings().tool;
  live.see_beside(workshop::wound_tick(*second, servo.rate_hz, {&tool, 1}));
}

void MillTools::wet(workshop::LiveSurface& live, bool begun, bool moves) {
  if (!desk_.settings.effects)
    live.look_plain();
  else if (begun)
    see_cuts(live);
  suck(live);
  tube_.lead(hands_.suction, scene_, live, desk_.settings.effects, moves);
}

// The burr is where the bone lets it be. A mouse has no orientation: the shaft is drawn as a hand
// would hold it. Only the picture is concerned.
void MillTools::show_row() {
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

void MillTools::look() {
  notes_.note(drill_.look());
  show_mirror(scene_, session_.bone().grid(), mirror_.now());
  nearest_ = nearest_spared();
}

// Of the cutting parts to what must be spared: the round burr is its radius around one place, another
// tool a set of places on its surface.
MillTools::Nearest MillTools::nearest_spared() {
  if (options_.spared_distance == nullptr) return std::nullopt;
  const math::Pose& pose = scene_.burr.world_from_tool;
  const scenario::RackTool* tool = rack_.tool(row_.tool.number);
  if (tool == nullptr) {
    auto near = options_.spared_distance->nearest(pose.p);
    if (!near) return std::nullopt;
    return HudState::Nearest{std::move(near->name), near->distance - scene_.burr.radius};
  }
  if (std::exchange(placed_, row_.tool.number) != row_.tool.number)
    places_ = workshop::places_on(tool->tool);
  std::optional<HudState::Nearest> least;
  for (const math::Vec3& place : places_) {
    auto near = options_.spared_distance->nearest(pose * place);
    if (near && (!least || near->distance < least->distance))
      least = {std::move(near->name), near->distance};
  }
  return least;
}

void MillTools::draw_pictures() {
  if (std::exchange(renewed_, desk_.renewed()) != desk_.renewed()) rack_.forget();
  if (over_.menu == Menu::rack) rack_.step(desk_.renderer(), session_.settings().servo.burr);
}

void MillTools::draw_panel(Ui& ui) {
  tool::Burr burr = session_.settings().servo.burr;
  burr.radius = session_.burr_radius();
  std::optional<RackGrip> grip;
  if (holds_by_mouse())
    grip = {static_cast<int>(std::lround(grip_.leaned() / kDegree)),
            static_cast<int>(std::lround(grip_.rolled() / kDegree))};
  const RackPressed pressed =
      draw_rack(ui, rack_.tiles(drill_.tool(), scene_.burr.diamond, burr), grip);
  if (pressed.lean != 0) lean(pressed.lean);
  if (pressed.roll != 0) roll(pressed.roll);
  if (pressed.tile) {
    const auto keep = over_.menu;  // a tool of the mouse may need to be turned next
    take(static_cast<int>(*pressed.tile) + ToolRack::kCutting);
    over_.menu = keep;
  }
  if (pressed.close) over_.menu.reset();
}

}  // namespace burr::app
