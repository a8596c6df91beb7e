// io/write/seg_options.h - how a DICOM segmentation is written, and what became of its segments
// (write_dicom_seg.h).
//
// Plain structs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "burr/io/dicom_study.h"

namespace burr::io {

// A code of a public list, for example {"91609006", "SCT", "Mandible"}.
struct DicomCode {
  std::string value, scheme, meaning;
};
// What a structure is, as somebody who knows has said.
struct SegmentCodes {
  std::optional<DicomCode> category, type;
};

// How the segments are stored: one bit a voxel for each, or one number a voxel for all (PS3.3 C.8.20.2, since 2024).
enum class SegKind : std::uint8_t { binary, label_map };

enum class SegmentedBy : std::uint8_t { automatic, semiautomatic, manual };

struct SegOptions {
  std::optional<DicomStudy> study;  // whose scan was segmented; none: a new study of nobody
  std::string uid_root;             // of new UIDs; empty: 2.25, which needs no registration
  SegKind kind = SegKind::binary;
  std::map<int, SegmentCodes> codes;  // by label
  SegmentedBy by = SegmentedBy::semiautomatic;
  std::string algorithm;  // name, for all but manual; empty: burr and its version
};

struct SegSegment {
  int number = 0;  // in the file
  int label = 0;
  std::string name;
  std::size_t voxels = 0;
};

}  // namespace burr::io
