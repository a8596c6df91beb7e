#include "window/parts/see_through.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "shared/word_names.h"

namespace burr::app {

std::string step_see_through(render::Scene& scene, bool back) {
  constexpr std::array kOpacities = {1.0, 0.6, 0.35, 0.15};
  std::size_t nearest = 0;
  for (std::size_t n = 1; n < kOpacities.size(); ++n)
    if (std::abs(kOpacities[n] - scene.look.opacity) <
        std::abs(kOpacities[nearest] - scene.look.opacity))
      nearest = n;
  const std::size_t count = kOpacities.size();
  scene.look.opacity = kOpacities[(nearest + (back ? count - 1 : 1)) % count];
  if (scene.look.opacity == 1) return word(Word::bone_whole);
  return say(Word::see_through, 100 * (1 - scene.look.opacity));
}

}  // namespace burr::app
