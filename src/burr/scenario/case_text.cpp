// What is asked of a case's text without reading it.
#include <numbers>

#include "burr/scenario/case.h"

namespace burr::scenario {

double burr_mm(const Case& work) {
  return work.session ? work.file_burr_mm : 2e3 * work.burr.radius;
}
double rpm(const Case& work) {
  return work.session ? work.file_rpm : work.full_speed * 60 / (2 * std::numbers::pi);
}
double voxel_mm(const Case& work) { return work.session ? work.file_voxel_mm : 1e3 * work.voxel; }

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
