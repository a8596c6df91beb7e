// io/scan.h - the content of a file before it becomes bone: a grid of numbers in the world, in
// memory as it was read.
//
// It holds no patient name, id or path: only what the geometry and the numbers need. Of dates it
// holds those of the studies in a list of series, and nothing that burr writes has them. The one
// exception is `study`, which is empty unless the caller asks for it.
// Units: mm. Frame: LPS. Thread: one at a time; plain data.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/io/dicom_study.h"
#include "burr/io/voxels.h"
#include "burr/math/vec3.h"
#include "burr/volume/tissue.h"

namespace burr::io {

// One label of a label map, as the file names it.
struct Label {
  int value = 0;
  std::string name;
  std::array<float, 3> colour = {0.8F, 0.8F, 0.8F};  // sRGB 0..1
  std::string meaning{};     // what a code of the file says that it is ("Facial nerve"), or empty
  std::int64_t in_file = 0;  // its value in the file, where that differs from `value`; else 0
};

// What the file leaves open and the user must answer before bone is made of the scan.
enum class Ask : std::uint8_t {
  missing = 1,  // slices that could not be read; --allow-missing answers
  spacing,      // a distance that is not stated, or that no scan has; --spacing-mm answers
  absent,       // slices that something says should be there; --allow-missing answers
  doubt,   // it contradicts itself, or is no picture in which bone is bright; --as-it-is answers
  volume,  // the file holds several volumes; --series answers
};
struct Question {
  Ask ask = Ask::missing;
  std::string text;  // a sentence without its full stop; names the file
};

// Scan::format of a volume of AMBF, whose labels are known by their colours.
inline constexpr const char* kAdfFormat = "AMBF volume";

struct Scan {
  math::Ijk size = {0, 0, 0};
  math::Vec3 spacing_mm = {1, 1, 1};          // may differ by axis
  math::Mat3 axes = math::Mat3::Identity();   // columns: directions of i, j, k in LPS, unit;
                                              // right-handed, rotation
  math::Vec3 origin_mm = math::Vec3::Zero();  // centre of voxel (0,0,0), LPS
  Voxels<float> values;         // (x fastest) HU, or whatever the file has; empty for a label map
  Voxels<std::uint8_t> labels;  // (x fastest) value per voxel; empty for a grey scan
  std::vector<Label> label_names;
  bool hounsfield = false;  // values are HU
  // Voxels of exactly this value were not measured (padding, fill): no histogram counts them.
  std::optional<float> outside;
  bool k_reversed = false;  // the slices were put in reverse order to make the axes right-handed:
                            // voxel k here is voxel size.z-1-k of the file
  std::string format;       // "DICOM", "NRRD" ...
  std::string modality;     // as DICOM says it, "CT", "MR", "RTDOSE"; empty: not stated
  // Where a DICOM folder holds several series, or a file several volumes: one line for each, without
  // patient data, as `burr info` lists them, and the index of the one read here.
  std::vector<std::string> series;
  int series_taken = 0;
  std::vector<std::string> series_dates;  // of the study of each, "2019-03-07"; empty: not stated
  std::vector<std::string>
      notices;  // oddities of the file and what was done about each, one sentence each
  std::vector<Question> questions;  // at most a few; importing refuses until they are answered

  std::optional<DicomStudy> study;  // of DICOM, if ReadOptions::study asks for it

  void ask(Ask what, std::string text) { questions.push_back({what, std::move(text)}); }
};

}  // namespace burr::io
