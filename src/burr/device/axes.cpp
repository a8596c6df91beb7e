#include "burr/device/axes.h"

#include <sstream>
#include <utility>

namespace burr::device {
namespace {

using math::Mat3;
using math::Quat;
using math::Vec3;

struct Way {
  const char* word;
  Vec3 way;
};
const Way kWays[] = {{"right", {1, 0, 0}}, {"left", {-1, 0, 0}}, {"up", {0, 1, 0}},
                     {"down", {0, -1, 0}}, {"near", {0, 0, 1}},  {"far", {0, 0, -1}}};

}  // namespace

std::optional<Quat> axes_from_words(std::string_view words) {
  std::istringstream in{std::string(words)};
  Mat3 axes = Mat3::Zero();
  int count = 0;
  for (std::string word; in >> word; ++count) {
    if (count == 3) return std::nullopt;
    for (const Way& one : kWays)
      if (word == one.word) axes.col(count) = one.way;
  }
  if (count != 3 || axes.determinant() != 1) return std::nullopt;
  return Quat(axes).normalized();
}

std::string words_of_axes(const Quat& hand_from_device) {
  std::string words;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 way = hand_from_device * Vec3(Vec3::Unit(axis));
    const Way* nearest = &kWays[0];
    for (const Way& one : kWays)
      if (one.way.dot(way) > nearest->way.dot(way)) nearest = &one;
    words += (axis > 0 ? " " : "") + std::string(nearest->word);
  }
  return words;
}

}  // namespace burr::device
