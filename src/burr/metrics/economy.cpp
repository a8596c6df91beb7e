#include "burr/metrics/economy.h"

namespace burr::metrics {

Economy economy_of(const Track& track, double path, std::size_t strokes, const Region& steps) {
  constexpr const char* kNothing = "nothing was removed";
  constexpr const char* kNoRegion = "no step of the case names a region";
  Economy out;
  out.path = path;
  for (const TrackSample& one : track.samples) {
    if (!one.cutting()) continue;
    out.volume += one.removed;
    if (steps && !(steps(one.raw) > -one.radius)) out.outside += one.removed;
  }
  if (!(out.volume > 0)) {
    out.per_path = out.strokes_per_volume = NotAssessable{kNothing};
    out.outside_share = NotAssessable{kNothing};
    return out;
  }
  out.strokes_per_volume = static_cast<double>(strokes) / out.volume;
  if (!steps) {
    out.per_path = out.outside_share = NotAssessable{kNoRegion};
    return out;
  }
  out.outside_share = out.outside / out.volume;
  if (path > 0)
    out.per_path = (out.volume - out.outside) / path;
  else
    out.per_path = NotAssessable{"the burr never moved"};
  return out;
}

}  // namespace burr::metrics
