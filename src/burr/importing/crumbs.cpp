#include "burr/importing/crumbs.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace burr::importing {
namespace {

using math::Ijk;

// Which parts hang together by now. A tree with a part that is no crumb never joins another such tree.
class Trees {
 public:
  explicit Trees(const Parts& parts) : above_(parts.parts.size()), whole_(parts.parts.size()) {
    std::iota(above_.begin(), above_.end(), 0U);
    for (std::size_t n = 0; n < whole_.size(); ++n) whole_[n] = parts.parts[n] >= kCrumb;
  }
  // False: they are joined already, or must stay apart.
  bool join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t one = root(a), other = root(b);
    if (one == other || (whole_[one] && whole_[other])) return false;
    const std::uint32_t low = std::min(one, other), high = std::max(one, other);
    above_[high] = low;
    whole_[low] = whole_[one] || whole_[other];
    return true;
  }

 private:
  std::uint32_t root(std::uint32_t part) {
    while (above_[part] != part) part = above_[part] = above_[above_[part]];
    return part;
  }
  std::vector<std::uint32_t> above_;
  std::vector<bool> whole_;
};

class Voxels {
 public:
  Voxels(const Ijk& size, std::vector<std::int16_t>& voxels) : size_(size), voxels_(voxels) {}
  std::int16_t& at(const Ijk& v) {
    return voxels_[static_cast<std::size_t>(v.x()) +
                   static_cast<std::size_t>(size_.x()) *
                       (static_cast<std::size_t>(v.y()) +
                        static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(v.z()))];
  }

 private:
  Ijk size_;
  std::vector<std::int16_t>& voxels_;
};

// Raises the voxels between two that share an edge or a corner: of the ways over faces, the one whose
// lowest value is highest.
std::size_t bridge(Voxels& voxels, const Ijk& from, const Ijk& step, std::int16_t level) {
  std::array<int, 3> axes = {0, 1, 2};
  std::array<int, 3> best = axes;
  int most = -40000;
  do {
    Ijk at = from;
    int lowest = 40000;
    for (const int axis : axes) {
      if (step[axis] == 0) continue;
      at[axis] += step[axis];
      lowest = std::min(lowest, int{voxels.at(at)});
    }
    if (lowest > most) {
      most = lowest;
      best = axes;
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  std::size_t raised = 0;
  Ijk at = from;
  for (const int axis : best) {
    if (step[axis] == 0) continue;
    at[axis] += step[axis];
    if (voxels.at(at) >= level) continue;
    voxels.at(at) = level;
    ++raised;
  }
  return raised;
}

}  // namespace

std::size_t join_crumbs(const Parts& parts, std::int16_t level, std::vector<std::int16_t>& voxels) {
  // the largest come first: without a crumb at the end there is none
  if (parts.parts.size() < 2 || parts.parts.back() >= kCrumb) return 0;
  Trees trees(parts);
  Voxels values(parts.size, voxels);
  std::size_t raised = 0;
  std::size_t row = 0;
  for (int k = 0; k < parts.size.z(); ++k)
    for (int j = 0; j < parts.size.y(); ++j, ++row)
      for (std::size_t n = parts.starts[row]; n < parts.starts[row + 1]; ++n) {
        const Run& run = parts.runs[n];
        if (parts.parts[run.part] >= kCrumb) continue;
        for (int i = run.from; i < run.to; ++i)
          for (int other = 0; other < 27; ++other) {
            const Ijk step(other % 3 - 1, other / 3 % 3 - 1, other / 9 - 1);
            if (step.cwiseAbs().sum() < 2) continue;  // itself, and over a face
            const auto part = parts.part_at(Ijk(i, j, k) + step);
            if (part && *part != run.part && trees.join(run.part, *part))
              raised += bridge(values, {i, j, k}, step, level);
          }
      }
  return raised;
}

}  // namespace burr::importing
