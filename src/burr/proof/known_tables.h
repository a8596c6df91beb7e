// proof/known_tables.h - for each built-in case a table of bones with the right answer of every item that follows from the shapes.
//
// A table is a text, tables/CASE.txt, to be read and checked by hand:
//
//     case jaw
//     coarser 0.35                                                  the second voxel size [mm]
//     few 8                                                         so many of the bones, the first, do for other bones of --bone
//     let BED  cyl on implant_axis -6 0 0 on implant_axis 10 0 0 2   {BED} stands for this from here on
//     left out: nerve.intact  it needs a recording
//     bone the bed 0.5 mm too deep
//       cut {BED} ; ...                                             known_shape.h
//       bed.depth    0.5         depth                              item, right value, tolerance (right.h)
//       bed.cleared  gone({BED}) share
//       teeth.intact met                                            the verdict alone
//
// Thread: any. Errors: one sentence with table, line, what is wrong and what to write.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/proof/right.h"

namespace burr::proof {

struct KnownLine {
  std::string name;
  std::string shapes;  // known_shape.h
  std::vector<Right> right;
};

// An item whose answer follows from no shape, or not without a recording.
struct LeftOut {
  std::string item, why;
};

struct KnownTable {
  std::string case_name;
  double coarser_mm = 0;  // the second voxel size
  std::size_t few = 0;    // of the bones, the first, for other bones of `--bone`; 0: all
  std::vector<KnownLine> bones;
  std::vector<LeftOut> left_out;
};

// file: for errors.
[[nodiscard]] Result<KnownTable> read_table(std::string_view text, const std::string& file);
// The cases that have a table, and the table of one.
[[nodiscard]] std::vector<std::string> known_cases();
[[nodiscard]] Result<KnownTable> known_table(const std::string& case_name);

}  // namespace burr::proof
