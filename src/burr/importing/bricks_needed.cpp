#include "burr/importing/bricks_needed.h"

#include <algorithm>
#include <cstddef>

#include "burr/io/workers.h"
#include "burr/volume/bone.h"

namespace burr::importing {

using volume::kBrickEdge;

std::vector<std::uint8_t> bricks_needed(const InsideGrid& grid, const math::Ijk& bricks,
                                        Progress& progress, bool& cancelled) {
  const auto bx = static_cast<std::size_t>(bricks.x()), by = static_cast<std::size_t>(bricks.y()),
             bz = static_cast<std::size_t>(bricks.z());
  // for each layer of bricks: its own need, and what its two outer thirds mean for its neighbours
  std::vector<std::uint8_t> own(bx * by * bz), below(bx * by * bz), above(bx * by * bz);
  cancelled = !io::in_pieces(bricks.z(), progress, "looking for bone", [&](int layer) {
    std::vector<std::uint8_t> row(bx + 2);
    const int low = layer * kBrickEdge - grid.margin.z();
    for (int z = std::max(low, 0); z < std::min(low + kBrickEdge, grid.size.z()); ++z)
      for (int y = 0; y < grid.size.y(); ++y) {
        std::fill(row.begin(), row.end(), std::uint8_t{0});
        const std::size_t base =
            static_cast<std::size_t>(grid.size.x()) *
            (static_cast<std::size_t>(y) +
             static_cast<std::size_t>(grid.size.y()) * static_cast<std::size_t>(z));
        bool any = false;
        for (std::size_t b = 0; b < bx; ++b) {
          const int from = static_cast<int>(b) * kBrickEdge - grid.margin.x(),
                    n = std::min(kBrickEdge, grid.size.x() - from);
          unsigned in = 0, kept = 0;
          for (int x = std::max(0, -from); x < n; ++x) {
            const std::size_t v = base + static_cast<std::size_t>(from + x);
            in |= static_cast<unsigned>(grid.inside(v)) << x;
            if (grid.labels != nullptr)
              kept |= static_cast<unsigned>(grid.tissue[grid.labels[v]] != 0);
          }
          if (in == 0 && kept == 0) continue;
          any = true;
          row[b + 1] |= static_cast<std::uint8_t>((in != 0 ? 1 : 0) | (kept != 0 ? 2 : 0));
          if ((in & 0x07U) != 0) row[b] |= 1;      // within three voxels of the previous brick
          if ((in & 0xE0U) != 0) row[b + 2] |= 1;  // and of the next
        }
        if (!any) continue;
        const int row_y = y + grid.margin.y(), brick_y = row_y / kBrickEdge,
                  in_y = row_y % kBrickEdge, in_z = (z + grid.margin.z()) % kBrickEdge;
        for (int dy = -1; dy <= 1; ++dy) {
          if ((dy < 0 && in_y > 2) || (dy > 0 && in_y < 5)) continue;
          if (brick_y + dy < 0 || brick_y + dy >= bricks.y()) continue;
          const std::size_t line =
              bx * (static_cast<std::size_t>(brick_y + dy) + by * static_cast<std::size_t>(layer));
          for (std::size_t b = 0; b < bx; ++b) {
            const std::uint8_t said = dy == 0 ? row[b + 1] : row[b + 1] & 1;
            own[line + b] |= said;
            if (in_z < 3) below[line + b] |= said & 1;
            if (in_z > 4) above[line + b] |= said & 1;
          }
        }
      }
  });
  for (std::size_t z = 0; z < bz; ++z)
    for (std::size_t b = 0; b < bx * by; ++b) {
      if (z > 0) own[b + bx * by * z] |= above[b + bx * by * (z - 1)];
      if (z + 1 < bz) own[b + bx * by * z] |= below[b + bx * by * (z + 1)];
    }
  return own;
}

}  // namespace burr::importing
