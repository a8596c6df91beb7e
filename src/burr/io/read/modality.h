// io/read/modality.h - what kind of picture a scan is, and whether bone is bright in it. Internal to
// io.
//
// Thread: any.
#pragma once

#include <string>

#include "burr/io/scan.h"

namespace burr::io {

// Modality of DICOM as it stands in the file; where it is empty, that of the SOP class; empty:
// neither says it.
[[nodiscard]] std::string modality_of(const std::string& stated, const std::string& sop_class);

// Made with X-rays, or of a kind that may be: bone is bright.
[[nodiscard]] bool by_rays(const std::string& modality);

// Sets scan.modality. Asks where bone is not bright in such a picture, and where the two
// statements contradict each other. file: its name.
void take_modality(const std::string& stated, const std::string& sop_class, const std::string& file,
                   Scan& scan);

}  // namespace burr::io
