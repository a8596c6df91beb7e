// importing/bone_level.h - where bone begins in a scan that is not in Hounsfield units.
//
// Air, soft tissue and bone are looked for in the values (io/value_groups.h). 300 HU lies above soft
// tissue by a quarter of the distance from air to soft tissue, so bone begins there. Two other methods judge it: the upper threshold
// of three classes (Otsu 1979), and whether the values at the level lie on edges and not within a
// material.
// A scan that is stretched or shifted has the same level, stretched and shifted.
// Units: those of the scan. Thread: any. docs/use/own_ct.md has what it measured on real scans.
#pragma once

#include <cstdint>
#include <string>

#include "burr/io/scan.h"

namespace burr::importing {

// high: air, soft tissue and bone were found, and both other methods agree. medium: one of them
// agrees, or there are two materials only and the level is half-way. low: neither agrees, or one
// material only, or something that the estimate rests on does not hold; look at the bone before you
// trust it.
enum class Sure : std::uint8_t { low, medium, high };
[[nodiscard]] const char* word_of(Sure sure);

struct BoneLevel {
  double level = 0;
  Sure sure = Sure::low;
  bool found = false;  // false: the values hold one material only, and there is no level
  std::string why;     // one sentence
};

// The box [from, from + size) of a grey scan. check_scan: what the estimate rests on is checked, and
// where it fails (values that were cut off, a border that is bone) the estimate is `low`; false: as
// burr did before 2026-11-29.
[[nodiscard]] BoneLevel estimate_bone_level(const io::Scan& scan, const math::Ijk& from,
                                            const math::Ijk& size, bool check_scan = true);

}  // namespace burr::importing
