// tests/metrics/ticks.h - made recordings: ticks from functions of time.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/moment.h"
#include "burr/metrics/process.h"
#include "burr/tick/rows.h"
#include "burr/volume/grid.h"

namespace burr::metrics::test {

inline constexpr double kRate = 1000;  // [Hz]

// What happens at a moment; all but the place have values of a burr that turns in free air.
struct Happening {
  math::Vec3 place = math::Vec3::Zero();
  double force = 0;  // [N], along z
  bool touching = false;
  double removal = 0;     // [m^3/s]
  double spindle = 5000;  // [rad/s]
  tool::ToolState tool = {.radius = 1e-3, .full_speed = 5000};
  math::Vec3 normal = {0, 0, 1};
};
using Story = std::function<Happening(double t)>;

inline std::vector<tick::TickRow> rows_of(double seconds, const Story& story) {
  std::vector<tick::TickRow> rows;
  double removed = 0;
  const auto count = static_cast<std::uint64_t>(std::llround(seconds * kRate));
  for (std::uint64_t n = 0; n < count; ++n) {
    const Happening now = story(static_cast<double>(n) / kRate);
    tick::TickRow row;
    row.tick = n;
    row.contact.proxy = row.hand.world_from_tool.p = now.place;
    row.contact.touching = now.touching;
    if (now.touching) row.contact.normal = now.normal;
    row.contact.force = {0, 0, now.force};
    row.spindle_rad_s = now.spindle;
    row.tool = now.tool;
    removed += now.removal / kRate;
    row.ledger.removed = removed;
    rows.push_back(row);
  }
  return rows;
}

// The recording without the ticks of [from, to), seconds.
inline void drop(std::vector<tick::TickRow>& rows, double from, double to) {
  std::erase_if(rows, [&](const tick::TickRow& row) {
    const double t = static_cast<double>(row.tick) / kRate;
    return t >= from && t < to;
  });
}

// Ticks that are missing in `rows` are a gap.
inline Process process(const std::vector<tick::TickRow>& rows, const ProcessSettings& settings = {},
                       const volume::Grid& grid = {}) {
  ProcessMaker maker(grid, static_cast<double>(rows.size()) / kRate, settings);
  MomentMaker moments(kRate);
  Moment now;
  std::uint64_t expected = 0;
  for (const tick::TickRow& row : rows) {
    if (moments.make(row, row.tick != expected, now)) maker.add(now);
    expected = row.tick + 1;
  }
  return maker.finish();
}

inline Process process(double seconds, const Story& story, const ProcessSettings& settings = {},
                       const volume::Grid& grid = {}) {
  return process(rows_of(seconds, story), settings, grid);
}

}  // namespace burr::metrics::test
