// io/read/dicom_facts.h - the facts of a DICOM file that burr needs: geometry, scale, phase, segments.
// Internal to io. Units: mm. Frame: LPS. Thread: any.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "burr/io/read/dicom_elements.h"
#include "burr/math/vec3.h"

namespace burr::io {

// What tells apart the volumes that share a series: two phases, two kernels, two energies. A fact
// that the file does not state keeps its default.
struct DicomPhase {
  static constexpr double kUnknown = -1e30;
  int acquisition = 0, temporal = 0;
  double cardiac_percent = kUnknown, trigger_ms = kUnknown, time_s = kUnknown, kvp = kUnknown,
         echo_ms = kUnknown, energy_kev = kUnknown;  // energy: of a monoenergetic picture
  std::string kernel, type, stack;
  std::vector<std::uint32_t> index;  // Dimension Index Values
};

// Geometry and scale of one frame.
struct DicomFrame {
  bool has_position = false, has_orientation = false, has_spacing = false;
  bool has_location = false;
  math::Vec3 position_mm = math::Vec3::Zero();  // centre of the first pixel, LPS
  math::Vec3 row = math::Vec3::UnitX();         // direction of a row: to the next column
  math::Vec3 column = math::Vec3::UnitY();
  double row_gap_mm = 1, column_gap_mm = 1;  // distance between rows, between columns
  // Imager Pixel Spacing or Nominal Scanned Pixel Spacing, between rows and between columns: at the
  // detector, so larger than in the patient; 0: not stated.
  std::array<double, 2> imager_gap_mm = {0, 0};
  double magnification = 0;  // Estimated Radiographic Magnification Factor; 0: not stated
  double slope = 1, intercept = 0;
  bool has_rescale = false;
  bool has_lone_intercept = false;  // a Rescale Intercept without a slope
  double lone_intercept = 0;
  double thickness_mm = 0;
  double location_mm = 0;  // Slice Location, if has_location
  int segment = 0;         // of a segmentation: the segment that it shows; 0: not stated
  DicomPhase phase;
};

// One segment of a segmentation (Segment Sequence).
struct DicomSegment {
  int number = 0;
  std::string label;                  // in UTF-8
  std::string scheme, code, meaning;  // Segmented Property Type Code Sequence
  bool has_colour = false;
  std::array<int, 3> lab{};  // Recommended Display CIELab Value, as stored
};

struct DicomHeader {
  std::filesystem::path path;
  std::string transfer_syntax, sop_class, sop_instance, study, series, frame_of_reference, modality,
      image_type, kernel, description, photometric, rescale_type;
  std::string study_date;  // "2019-03-07"; empty: not stated
  // Not empty: the file ends early or its structure is broken. The facts before that place are here.
  std::string damage;
  std::string unreadable;       // a number of the geometry that is none, as "Pixel Spacing \"x\""
  std::string bad_scale;        // the same of Rescale Slope or Intercept
  bool decimal_commas = false;  // a number is written as "0,5"
  int own_positions = 0;        // frames that state a position of their own
  int series_number = 0, instance = 0, acquisition = 0;
  int rows = 0, columns = 0, frame_count = 1, samples = 1;
  int bits_allocated = 0, bits_stored = 0, high_bit = 0;
  bool is_signed = false, has_modality_lut = false, has_padding = false, padding_range = false;
  std::int64_t padding = 0, padding_end = 0;  // stored values
  double between_slices_mm = 0;
  bool inverted = false;  // dark is dense: MONOCHROME1, or a Presentation LUT Shape of INVERSE
  // What the header says should be there; 0: it does not say.
  int images_in_acquisition = 0, instances_in_series = 0;
  int described_frames = 0;   // items of the Per-Frame Functional Groups Sequence
  std::string concatenation;  // UID; this file is part `part` of `parts`
  int part = 0, parts = 0;
  std::vector<DicomFrame> frames;  // (frame_count)

  // of a segmentation
  std::string segmentation_type;  // BINARY, FRACTIONAL, LABELMAP
  int most_fractional = 0;        // Maximum Fractional Value
  std::vector<DicomSegment> segments;
  bool other_frame_of_reference = false;  // a group of a frame states one of its own

  bool big_endian = false, deflated = false;  // big_endian: the pixels
  bool has_pixels = false, float_pixels = false, encapsulated = false;
  std::uint64_t pixels_at = 0, pixels_length = 0;  // in the file, or in the inflated data set
};

// GE's own transfer syntax: implicit, with big-endian pixels.
inline constexpr const char* kGePrivate = "1.2.840.113619.5.2";

// The energy that a text names, as "MonoE 70 keV" [keV]; DicomPhase::kUnknown: it names none.
[[nodiscard]] double energy_in(std::string_view text);

// Copies the facts of a data set into the header, whose transfer syntax is already there. Numbers that
// are none are noted in it.
void take_dicom_facts(const DicomWalker& set, DicomHeader& header);

}  // namespace burr::io
