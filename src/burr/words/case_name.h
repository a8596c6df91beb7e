// words/case_name.h - the names of burr's own cases. Thread: main.
#pragma once

#include <string>

namespace burr::words {

// "Temporal bone", in the user's language; an unknown case keeps its name.
[[nodiscard]] std::string name_of_case(const std::string& name);

}  // namespace burr::words
