#include "window/mill/tool_rack.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "burr/workshop/tool_picture.h"
#include "shared/word_names.h"

namespace burr::app {

ToolRack::ToolRack(std::vector<scenario::RackTool> tools)
    : tools_(std::move(tools)), pictures_(tools_.size() + 2) {}

const scenario::RackTool* ToolRack::tool(int number) const {
  return number >= 0 && number < size() ? &tools_[static_cast<std::size_t>(number)] : nullptr;
}

std::string ToolRack::title(int number) const {
  const scenario::RackTool* one = tool(number);
  return one != nullptr ? one->title.in(spoken().code) : std::string();
}

void ToolRack::step(render::Renderer& renderer, const tool::Burr& burr) {
  for (std::size_t n = 0; n < pictures_.size(); ++n) {
    if (pictures_[n].name() != 0) continue;
    tool::Burr round = burr;
    round.kind = n == 0 ? tool::BurrKind::cutting : tool::BurrKind::diamond;
    const render::Scene scene = n < 2 ? workshop::tip_picture(round, kAspect)
                                      : workshop::tip_picture(tools_[n - 2].tool, kAspect);
    const auto image = renderer.image(scene, kWide, kHigh);
    if (image) pictures_[n].put(image->width, image->height, 3, image->rgb);
    return;
  }
}

void ToolRack::forget() {
  for (Texture& picture : pictures_) picture.forget();
}

std::vector<RackTile> ToolRack::tiles(int number, bool diamond, const tool::Burr& burr) const {
  std::vector<RackTile> all;
  for (const bool of_diamond : {false, true})
    all.push_back({word(of_diamond ? Word::rack_diamond : Word::rack_cutting),
                   say(Word::burr_now, 2e3 * burr.radius), pictures_[all.size()].name(),
                   number < 0 && of_diamond == diamond});
  for (int n = 0; n < size(); ++n)
    all.push_back({title(n), about(*tool(n)), pictures_[static_cast<std::size_t>(n) + 2].name(),
                   n == number});
  return all;
}

std::string about(const scenario::RackTool& tool) {
  const double wide_mm = 0.1 * std::round(1e4 * scenario::cutting_width(tool));
  switch (tool.cutter.drive) {
    case tool::Drive::turning:
      break;
    case tool::Drive::oscillating:
    case tool::Drive::reciprocating:
      return say(Word::rack_strokes, 60 * tool.cutter.cycles_hz, wide_mm);
    case tool::Drive::pushed:
      return say(Word::rack_pushed, wide_mm);
    case tool::Drive::struck:
      return say(Word::rack_struck, tool.cutter.blow_j, wide_mm);
  }
  return say(Word::rack_turns, tool.cutter.speed_rad_s * 30 / std::numbers::pi, wide_mm);
}

}  // namespace burr::app
