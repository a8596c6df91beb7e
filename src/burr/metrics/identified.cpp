#include "burr/metrics/identified.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include "burr/metrics/line_and_plane.h"
#include "burr/metrics/shares.h"

namespace burr::metrics {
namespace {

constexpr double kSlice = 1e-3;  // [m]

struct Part {
  double cover = kUnseen;
  math::Vec3 at = math::Vec3::Zero();
  std::vector<std::pair<double, double>> covers;  // with their weights
};

std::map<int, Part> slices_of(const Cover& cover, const Course& course) {
  std::map<int, Part> slices;
  for (const CoverSample& one : cover.samples) {
    Part& part = slices[static_cast<int>(std::floor(course.along(one.surface.place) / kSlice))];
    if (part.covers.empty() || one.cover < part.cover) {
      part.cover = one.cover;
      part.at = one.surface.place;
    }
    part.covers.emplace_back(one.cover, one.surface.faces);
  }
  return slices;
}

double found_share(const std::vector<Identified::Slice>& slices, double x) {
  int found = 0;
  for (const Identified::Slice& one : slices) found += one.field_cover <= x ? 1 : 0;
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
    for (auto& [number, part] : slices_of(cover, *settings.course)) {
      out.slices.push_back(
          {number * kSlice, part.cover, weighted_quantile(std::move(part.covers), settings.field)});
      remember(out, part.cover, part.at);
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
