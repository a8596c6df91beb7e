#include "burr/device/hand_path.h"

#include <algorithm>

#include "burr/math/turn.h"

namespace burr::device {

PathPoint at(const HandPath& path, double t, std::size_t& hint) noexcept {
  const std::vector<PathPoint>& points = path.points;
  if (points.empty()) return {};
  if (hint >= points.size() || points[hint].t > t) hint = 0;
  while (hint + 1 < points.size() && points[hint + 1].t <= t) ++hint;
  if (hint + 1 >= points.size() || t <= points[hint].t) return points[hint];

  const PathPoint &a = points[hint], &b = points[hint + 1];
  const double s = std::clamp((t - a.t) / (b.t - a.t), 0.0, 1.0);
  PathPoint now;
  now.t = t;
  now.world_from_tool.p = a.world_from_tool.p + s * (b.world_from_tool.p - a.world_from_tool.p);
  now.world_from_tool.q = math::between(a.world_from_tool.q, b.world_from_tool.q, s);
  now.pedal = s < 1 ? a.pedal : b.pedal;  // the pedal is not interpolated
  return now;
}

}  // namespace burr::device
