#include "window/mill/suction_tube.h"

#include <algorithm>
#include <utility>

#include "burr/workshop/second_tool.h"
#include "shared/window_session.h"

namespace burr::app {

void SuctionTube::lead(workshop::SuctionHand* hand, render::Scene& scene,
                       workshop::LiveSurface& live, bool clears, bool turns) {
  if (hand == nullptr) return;
  const auto now = std::chrono::steady_clock::now();
  const double seconds =
      std::min(0.1, std::chrono::duration<double>(now - std::exchange(sucked_, now)).count());
  if (turns) hand->set_axes(view_of_hand(scene.camera));
  const tick::TickRow& row = hand->now();
  drawn_.put(scene, &row, hand->tool());
  if (clears && workshop::sucks(row)) live.suck(row.contact.proxy, row.tool.radius, seconds);
}

}  // namespace burr::app
