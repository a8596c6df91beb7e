// io/read/dicom_stack.h - slices of one volume put behind each other: their distance, what is uneven
// about it, and where slices are missing between others. Internal to io.
//
// Units: mm. Frame: LPS. Thread: one at a time. Errors and names: no patient data.
#pragma once

#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/read/dicom_series.h"
#include "burr/io/scan.h"

namespace burr::io {

// Gaps between slices along the stack, and what they tell.
struct Holes {
  std::size_t missing = 0;  // slices, all together
  std::size_t holes = 0;    // places where they are missing
  std::string where;        // "21 between slices 17 and 18 (11 mm)"
};
// Gaps of two or more usual ones, in whole multiples, that stand alone: slices are missing there.
// Three or more equal wide gaps beside each other are another distance, not a hole.
[[nodiscard]] Holes holes_in(const std::vector<double>& gaps, double usual);

// What a picture of a flat detector states in place of Pixel Spacing, as the end of a sentence: the
// distance of its pixels at the detector, which is larger than in the patient, so it is offered and not
// taken. Empty: it states none.
[[nodiscard]] std::string imager_offer(const DicomFrame& frame);

struct Stacking {
  Order order = Order::positions;
  bool check_scan = true;  // asks where slices are missing; false: as burr did before 2026-11-29
};

// The position of each slice relative to the first; a notice says what is uneven. Sets the size and
// spacing along the slices, and makes uneven or shifted slices even and upright.
[[nodiscard]] Status stack(const Series& series, const std::vector<Slice>& slices,
                           const Stacking& how, const std::string& file, Scan& scan,
                           Progress& progress);

}  // namespace burr::io
