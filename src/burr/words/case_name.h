// words/case_name.h - the names of burr's own cases. Thread: main.
#pragma once

#include <string>

namespace burr::words {

// "Temporal bone", in the user's language; an unknown case keeps its name.
[[nodiscard]] std::string name_of_case(const std::string& name);

// What somebody worked on, as burr calls it: a case or a phantom ("jaw?long"), "DICOM scan", "recording".
// In the user's language; anything else is returned as it is.
[[nodiscard]] std::string name_of_work(const std::string& what);

}  // namespace burr::words
