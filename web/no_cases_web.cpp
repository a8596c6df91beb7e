// TOML is not in this module: a case in a recording is kept as its name and text, which is all that watching it
// asks. In place of scenario/case.cpp and read_case.cpp.
#include <string>

#include "burr/scenario/case.h"

namespace burr::scenario {

Result<Case> parse_case(std::string_view text, std::string_view file) {
  Case work;
  work.name = std::string(file.substr(0, file.rfind('.')));
  work.text = std::string(text);
  return work;
}
bool names_no_file(const Case&) { return false; }
std::uint64_t text_hash(std::string_view text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}
const char* word_of(Goal goal) {
  return goal == Goal::expose ? "expose" : goal == Goal::remove ? "remove" : "open";
}

}  // namespace burr::scenario
