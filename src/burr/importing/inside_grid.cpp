#include "burr/importing/inside_grid.h"

#include <algorithm>

namespace burr::importing {

void leave_margins(InsideGrid& inside) {
  // where the second layer is the first that is inside, the ramp still reaches beyond the border
  constexpr int kLayers = 2;
  const math::Ijk& n = inside.size;
  const auto any = [&inside, &n](const math::Ijk& from, const math::Ijk& to) {
    for (int z = from.z(); z < to.z(); ++z)
      for (int y = from.y(); y < to.y(); ++y) {
        const std::size_t row = static_cast<std::size_t>(n.x()) *
                                (static_cast<std::size_t>(y) +
                                 static_cast<std::size_t>(n.y()) * static_cast<std::size_t>(z));
        for (int x = from.x(); x < to.x(); ++x)
          if (inside.inside(row + static_cast<std::size_t>(x))) return true;
      }
    return false;
  };
  for (int a = 0; a < 3; ++a) {
    math::Ijk low = n, high = math::Ijk::Zero();
    low[a] = std::min(kLayers, n[a]);
    high[a] = std::max(n[a] - kLayers, 0);
    inside.margin[a] = any(math::Ijk::Zero(), low) || any(high, n) ? kMargin : 0;
  }
}

}  // namespace burr::importing
