// importing/label_codes.h - what a table of labels (docs/use/labels.md) says that the structures
// are, in codes of SNOMED CT, for a DICOM segmentation. burr knows no codes of its own.
//
// Thread: any. Errors: what is wrong in the table, one sentence.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/scan.h"
#include "burr/io/write/write_dicom_seg.h"

namespace burr::importing {

struct LabelCodes {
  std::optional<std::int64_t> value;  // of the label in its file; none: known by its name
  std::string name;
  io::SegmentCodes codes;
};

// The entries of a table that have a code. Empty: no table (path empty), a list of names, or no codes in it.
[[nodiscard]] Result<std::vector<LabelCodes>> label_codes(const std::string& table_path);

// By Label::value. An entry with a value is for that label alone, others for all labels of that name.
[[nodiscard]] std::map<int, io::SegmentCodes> codes_of(const std::vector<LabelCodes>& table,
                                                       const std::vector<io::Label>& labels);

}  // namespace burr::importing
