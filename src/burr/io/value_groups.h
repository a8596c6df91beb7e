// io/value_groups.h - which values a grey scan holds: the groups of voxels that belong to one
// material, as air, soft tissue or bone.
//
// Only even places count, where a voxel is nearly as its neighbours: there the histogram has narrow
// peaks, and half-filled voxels at edges do not blur it. What the scanner did not measure (NaN, or
// the value `outside`) is left out. A stretched or shifted scan has the same groups, stretched and
// shifted.
// Units: those of the scan. Thread: any; plain data.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "burr/math/vec3.h"

namespace burr::io {

// At most about two million voxels, evenly spread, and how steep the scan is at each.
struct ValueSample {
  std::vector<float> values;
  std::vector<float> steep;  // change from voxel to voxel; infinite beside voxels left out
  std::size_t left_out = 0;  // sampled voxels that hold nothing measured
};

// The box [from, from + size) of a scan of scan_size voxels (x fastest).
[[nodiscard]] ValueSample sample_values(const float* values, const math::Ijk& scan_size,
                                        const math::Ijk& from, const math::Ijk& size,
                                        std::optional<float> outside);

struct ValueGroup {
  double value = 0;  // its middle
  double share = 0;  // of the even places
  double width = 0;  // at half its height
};

struct ValueGroups {
  std::vector<ValueGroup> all;  // by value, lowest first
  double low = 0, high = 0;     // where the groups were looked for: without the rare extremes
};

[[nodiscard]] ValueGroups groups_of(const ValueSample& sample);

// The value below which `share` of the sample lies. The sample must hold values.
[[nodiscard]] double value_at_share(const ValueSample& sample, double share);
// Share of the sample between two values, both included.
[[nodiscard]] double share_between(const ValueSample& sample, double low, double high);

}  // namespace burr::io
