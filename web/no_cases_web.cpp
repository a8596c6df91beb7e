// The page reads no cases from files, and its recordings have none: what the writer of recordings asks
// about a case is never called. In place of scenario/case.cpp and read_case.cpp.
#include <string>

#include "burr/scenario/case.h"

namespace burr::scenario {

Result<Case> parse_case(std::string_view, std::string_view file) {
  return error(Trouble::usage, std::string(file) + ": a page reads no cases");
}
bool names_no_file(const Case&) { return false; }
std::uint64_t text_hash(std::string_view) { return 0; }
const char* word_of(Goal) { return ""; }

}  // namespace burr::scenario
