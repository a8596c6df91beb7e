#include "window/mill/suction_tube.h"

#include <algorithm>
#include <utility>

#include "window/mill/make_ready.h"

namespace burr::app {

using math::Vec3;

void SuctionTube::lead(workshop::SuctionHand* hand, render::Scene& scene,
                       workshop::LiveSurface& live, bool clears) {
  if (hand == nullptr) return;
  const auto now = std::chrono::steady_clock::now();
  const double seconds =
      std::min(0.1, std::chrono::duration<double>(now - std::exchange(sucked_, now)).count());
  hand->set_axes(view_of_hand(scene.camera));
  const workshop::SuctionHand::Seen seen = hand->now();
  std::erase_if(scene.rods, [](const render::Rod& rod) {
    return rod.radius == workshop::SuctionHand::kRadius;
  });
  if (!seen.there) return;
  constexpr double kLong = 60e-3;  // length of the part that is drawn [m]
  const Vec3& mouth = seen.world_from_tool.p;
  scene.rods.push_back({mouth,
                        mouth + seen.world_from_tool.q * Vec3(0, 0, kLong),
                        workshop::SuctionHand::kRadius,
                        {0.72F, 0.76F, 0.8F},
                        false,
                        false});
  if (seen.sucks && clears) live.suck(mouth, workshop::SuctionHand::kRadius, seconds);
}

}  // namespace burr::app
