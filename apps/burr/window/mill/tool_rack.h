// apps/burr/window/mill/tool_rack.h - the rack of a session: the round burr as cutting and as diamond
// burr, then the tools of the session's list, with their pictures and names.
//
// A picture is drawn once, one tool in each picture of the window while the panel is open.
// Thread: main, with the window's context.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "burr/render/renderer.h"
#include "burr/scenario/rack.h"
#include "window/mill/rack_panel.h"
#include "window/ui/texture.h"

namespace burr::app {

class ToolRack {
 public:
  static constexpr int kCutting = -2, kDiamond = -1;  // places before the session's list

  explicit ToolRack(std::vector<scenario::RackTool> tools);

  // number: as in the session's list; nullptr: the round burr.
  [[nodiscard]] const scenario::RackTool* tool(int number) const;
  [[nodiscard]] std::string title(int number) const;
  [[nodiscard]] int size() const { return static_cast<int>(tools_.size()); }

  // Draws what is missing of one picture. burr: as it is in the hand now.
  void step(render::Renderer& renderer, const tool::Burr& burr);
  // The textures were destroyed with their context.
  void forget();
  // number: in the hand; diamond: the round burr is one. Tile n stands for the place n + kCutting.
  [[nodiscard]] std::vector<RackTile> tiles(int number, bool diamond, const tool::Burr& burr) const;

 private:
  static constexpr int kWide = 204, kHigh = 144;  // of a picture [pixel]
  static constexpr double kAspect = static_cast<double>(kWide) / kHigh;
  std::vector<scenario::RackTool> tools_;
  std::vector<Texture> pictures_;
};

// "turns at 80 000 rpm, cuts 3 mm wide", in the user's language.
[[nodiscard]] std::string about(const scenario::RackTool& tool);

}  // namespace burr::app
