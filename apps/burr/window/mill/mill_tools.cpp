// The rack of tools on the page: what is in the hand, and how the mouse holds it.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "burr/workshop/tool_places.h"
#include "shared/word_names.h"
#include "window/mill/mill.h"
#include "window/mill/rack_panel.h"

namespace burr::app {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kStep = 15 * kDegree;  // of a key, a button, a step of the wheel

}  // namespace

// place: ToolRack::kCutting, kDiamond, or a number of the session's list.
void Mill::take_tool(int place) {
  menu_.reset();
  note(drill_.take_tool(std::max(place, -1), rack_.tool(place)));
  grip_.take(rack_.tool(place));
  if (place >= 0) return note(say(Word::tool_now, rack_.title(place)));
  const bool diamond = place == ToolRack::kDiamond;
  note(diamond != scene_.burr.diamond
           ? drill_.toggle_kind()
           : std::string(word(diamond ? Word::now_diamond : Word::now_fluted)));
}

// The next tool of the rack; after the last comes the round burr, because a pedal has one button for it.
void Mill::next_tool(int by) {
  const int first = scene_.burr.diamond ? ToolRack::kDiamond : ToolRack::kCutting;
  const int count = rack_.size() + 1, now = drill_.tool() + 1;
  const int next = (now + by + count) % count;
  take_tool(next == 0 ? first : next - 1);
}

void Mill::roll_tool(double steps) {
  if (!holds_by_mouse()) return note(word(Word::tool_not_turned));
  grip_.roll(kStep * steps);
  note(say(Word::tool_rolled, static_cast<int>(std::lround(grip_.rolled() / kDegree))));
}

void Mill::lean_tool(double steps) {
  if (!holds_by_mouse()) return note(word(Word::tool_not_turned));
  grip_.lean(kStep * steps);
  note(say(Word::tool_leaned, static_cast<int>(std::lround(grip_.leaned() / kDegree))));
}

// The user's hand cannot turn the tool, so the page does.
bool Mill::holds_by_mouse() const {
  return hands_.real == nullptr && !headset_.wand() && !grip_.burr();
}

// Before the picture of the window, which may not be interrupted by another.
void Mill::draw_rack_pictures() {
  if (std::exchange(renewed_, desk_.renewed()) != desk_.renewed()) rack_.forget();
  if (menu_ == Menu::rack) rack_.step(desk_.renderer(), session_.settings().servo.burr);
}

void Mill::draw_rack_panel() {
  tool::Burr burr = session_.settings().servo.burr;
  burr.radius = session_.burr_radius();
  std::optional<RackGrip> grip;
  if (holds_by_mouse())
    grip = {static_cast<int>(std::lround(grip_.leaned() / kDegree)),
            static_cast<int>(std::lround(grip_.rolled() / kDegree))};
  const RackPressed pressed =
      draw_rack(desk_.ui(), rack_.tiles(drill_.tool(), scene_.burr.diamond, burr), grip);
  if (pressed.lean != 0) lean_tool(pressed.lean);
  if (pressed.roll != 0) roll_tool(pressed.roll);
  if (pressed.tile) {
    const auto keep = menu_;  // a tool of the mouse may need to be turned next
    take_tool(static_cast<int>(*pressed.tile) + ToolRack::kCutting);
    menu_ = keep;
  }
  if (pressed.close) menu_.reset();
}

// Of the cutting parts to what must be spared: the round burr is its radius around one place, another
// tool a set of places on its surface.
std::optional<HudState::Nearest> Mill::nearest_spared() {
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

}  // namespace burr::app
