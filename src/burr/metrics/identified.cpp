#include "burr/metrics/identified.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "burr/metrics/shares.h"

namespace burr::metrics {
namespace {

constexpr double kSlice = 1e-3;  // [m]

struct Best {
  double cover = kUnseen;
  math::Vec3 at = math::Vec3::Zero();
  bool any = false;
};

std::map<int, Best> slices_of(const Cover& cover, const Course& course) {
  std::map<int, Best> slices;
  for (const CoverSample& one : cover.samples) {
    Best& best = slices[static_cast<int>(std::floor(course.along(one.surface.place) / kSlice))];
    if (!best.any || one.cover < best.cover) best = {one.cover, one.surface.place, true};
  }
  return slices;
}

double found_share(const std::vector<Identified::Slice>& slices, double x) {
  int found = 0;
  for (const Identified::Slice& one : slices) found += one.cover <= x ? 1 : 0;
  return static_cast<double>(found) / static_cast<double>(slices.size());
}

void remember(Identified& out, double cover, const math::Vec3& at) {
  if (cover < out.least_cover) {
    out.least_cover = cover;
    out.least_at = at;
  }
  if (cover > out.worst_cover) {
    out.worst_cover = cover;
    out.worst_at = at;
  }
}

}  // namespace

std::string too_coarse(double voxel, double needed) {
  if (voxel <= needed * (1 + 1e-9)) return {};
  char text[160];
  std::snprintf(text, sizeof text,
                "the voxels are too coarse for this threshold: %.2f mm; it needs %.2f mm or finer",
                voxel * 1e3, needed * 1e3);
  return text;
}

Assessed<Identified> identified(const Cover& cover, const IdentifiedSettings& settings) {
  if (std::string reason = too_coarse(cover.voxel, settings.x / 2); !reason.empty())
    return NotAssessable{std::move(reason)};
  Identified out;
  out.mark.threshold = settings.y.value_or(settings.course ? 0.6 : 0.3);
  if (settings.course) {
    for (const auto& [number, best] : slices_of(cover, *settings.course)) {
      out.slices.push_back({number * kSlice, best.cover});
      remember(out, best.cover, best.at);
    }
    out.mark.value = found_share(out.slices, settings.x);
    out.mark.error =
        share_error(out.mark.value, found_share(out.slices, settings.x - cover.error),
                    found_share(out.slices, settings.x + cover.error), out.slices.size());
  } else {
    const auto thin = [&](const CoverSample& one, double shift) {
      return one.cover <= settings.x + shift;
    };
    for (const CoverSample& one : cover.samples) remember(out, one.cover, one.surface.place);
    out.mark.value = share_of(cover, 0, thin);
    out.mark.error = share_error(out.mark.value, share_of(cover, -cover.error, thin),
                                 share_of(cover, cover.error, thin), cover.samples.size());
  }
  out.mark.met = out.mark.value >= out.mark.threshold;
  return out;
}

}  // namespace burr::metrics
