// io/dicom_study.h - whose scan it is and to which study it belongs, as a DICOM file states it, for a file that burr
// adds to that study.
//
// It names a patient. It is read only where ReadOptions::study asks for it, never logged or shown, and written only
// into a DICOM file that the user asks for (io/write/write_dicom_seg.h). Plain data. Thread: one at a time.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace burr::io {

struct DicomStudy {
  std::string characters;  // Specific Character Set; empty: ASCII
  // Values as they are in the file, by tag (group << 16 | element): those of the modules Patient, General Study,
  // Patient Study and Frame of Reference.
  std::map<std::uint32_t, std::string> values;
};

inline constexpr std::uint32_t kStudyUid = 0x0020000D, kFrameOfReference = 0x00200052;

}  // namespace burr::io
