// apps/burr/window/mill/suction_tube.h - the tube in the other hand: how it is drawn, and what it takes away.
//
// Thread: main.
#pragma once

#include <chrono>

#include "burr/render/scene.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/suction_hand.h"

namespace burr::app {

class SuctionTube {
 public:
  // hand: nullptr where there is none. clears: what it sucks goes from the surface
  void lead(workshop::SuctionHand* hand, render::Scene& scene, workshop::LiveSurface& live,
            bool clears);

 private:
  std::chrono::steady_clock::time_point sucked_;  // until then it was led
};

}  // namespace burr::app
