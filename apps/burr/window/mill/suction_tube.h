// apps/burr/window/mill/suction_tube.h - the suction tube, or the tool, in the other hand: draws it;
// a tube clears the surface.
//
// Thread: main.
#pragma once

#include <chrono>

#include "burr/render/scene.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/second_tool.h"
#include "burr/workshop/suction_hand.h"

namespace burr::app {

class SuctionTube {
 public:
  // hand: nullptr if there is none. clears: what is sucked disappears from the surface. turns: the
  // hand's axes follow the view
  void lead(workshop::SuctionHand* hand, render::Scene& scene, workshop::LiveSurface& live,
            bool clears, bool turns);

 private:
  workshop::SecondTool drawn_;
  std::chrono::steady_clock::time_point sucked_;  // time of the last call of lead()
};

}  // namespace burr::app
