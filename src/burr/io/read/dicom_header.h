// io/read/dicom_header.h - reads the few facts of a DICOM file that burr needs. The parser trusts
// no length: everything is checked against the file size before memory is allocated. Internal to
// io.
//
// It does not read the patient's name, id, birth date or institution, except by read_dicom_study().
// The date of the study is read for the list of series alone (Scan::series_dates).
// Units: mm. Frame: LPS. Thread: any. Errors: one sentence that names the file without its folder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/dicom_study.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/dicom_facts.h"

namespace burr::io {

// Error: not a DICOM file, or of an unknown transfer syntax. A damaged DICOM file is no error here:
// see DicomHeader::damage.
[[nodiscard]] Result<DicomHeader> read_dicom_header(const std::filesystem::path& path);

// Whose file it is and to which study it belongs.
[[nodiscard]] Result<DicomStudy> read_dicom_study(const std::filesystem::path& path);

// Shows `look` the data set of a structure set (RTSTRUCT), with DicomWalker::structure_items. Error: damaged.
[[nodiscard]] Status look_at_structures(const std::filesystem::path& path,
                                        const std::function<void(const DicomWalker& set)>& look);

// The stored pixel values of all frames (columns x rows x frames), before rescaling. Compressed
// pixels are decompressed by GDCM. beyond: how many pixels of an uncompressed file have bits beyond
// Bits Stored that are no sign.
[[nodiscard]] Result<std::vector<std::int32_t>> read_dicom_pixels(const DicomHeader& header,
                                                                  std::size_t* beyond = nullptr);

// Deflated Image Frame Compression: each frame is deflated on its own.
inline constexpr const char* kDeflatedFrames = "1.2.840.10008.1.2.8.1";
// The frames of such a file, one after another; each begins at a byte.
[[nodiscard]] Result<std::vector<std::uint8_t>> inflate_dicom_frames(const DicomHeader& header,
                                                                     std::size_t frame_bytes);

// The bytes of Pixel Data as they are stored, from the file or from its inflated data set.
[[nodiscard]] Result<std::unique_ptr<ByteSource>> open_dicom_pixels(const DicomHeader& header);

}  // namespace burr::io
