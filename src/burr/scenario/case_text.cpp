// What is asked of a case's text without reading it.
#include "burr/scenario/case.h"

namespace burr::scenario {

std::uint64_t text_hash(std::string_view text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

const char* word_of(Goal goal) {
  switch (goal) {
    case Goal::open:
      break;
    case Goal::expose:
      return "expose";
    case Goal::remove:
      return "remove";
  }
  return "open";
}

}  // namespace burr::scenario
