#include "burr/volume/distance_to.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "burr/rt/thread.h"

namespace burr::volume {
namespace {

constexpr std::uint16_t kBeyond = 65535;
constexpr int kFarthest = 255;  // voxels; the square must be below kBeyond

// Squared distances along one line of voxels, and the tissue that each belongs to.
struct Line {
  explicit Line(std::size_t size) : square(size), tissue(size), parabola(size), from(size) {}
  std::vector<std::uint16_t> square;
  std::vector<TissueId> tissue;
  // the envelope: its parabolas, and from where on each of them is the lowest
  std::vector<int> parabola, from;
};

// The nearest labelled voxel in a row (0: none): one pass forward, one backward.
void nearest_in_row(const std::vector<TissueId>& labels, Line& line) {
  const int size = static_cast<int>(labels.size());
  int far = kFarthest + 1;
  TissueId whose = 0;
  const auto here = [&](int i) {
    const TissueId label = labels[static_cast<std::size_t>(i)];
    far = label != 0 ? 0 : std::min(far + 1, kFarthest + 1);
    if (far == 0) whose = label;
  };
  for (int i = 0; i < size; ++i) {
    here(i);
    line.square[static_cast<std::size_t>(i)] =
        far > kFarthest ? kBeyond : static_cast<std::uint16_t>(far * far);
    line.tissue[static_cast<std::size_t>(i)] = whose;
  }
  far = kFarthest + 1;
  for (int i = size - 1; i >= 0; --i) {
    here(i);
    if (far * far >= line.square[static_cast<std::size_t>(i)]) continue;
    line.square[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(far * far);
    line.tissue[static_cast<std::size_t>(i)] = whose;
  }
}

// The lower envelope of the parabolas (x - i)^2 + square[i]; then calls put(n, square, tissue) for
// the positions x = n step, n = 0 .. kept - 1.
template <class Put>
void envelope(Line& line, int size, int kept, int step, const Put& put) {
  const auto at = [&line](int x, int i) {
    return (x - i) * (x - i) + int{line.square[static_cast<std::size_t>(i)]};
  };
  int last = -1;  // index in the envelope
  for (int i = 0; i < size; ++i) {
    if (line.square[static_cast<std::size_t>(i)] == kBeyond) continue;
    const auto top = [&] { return line.parabola[static_cast<std::size_t>(last)]; };
    const auto top_from = [&] { return line.from[static_cast<std::size_t>(last)]; };
    while (last >= 0 && at(top_from(), top()) > at(top_from(), i)) --last;
    int from = 0;
    if (last >= 0) {
      // the last whole x at which the top parabola is not higher
      const int numerator = i * i - top() * top() + int{line.square[static_cast<std::size_t>(i)]} -
                            int{line.square[static_cast<std::size_t>(top())]};
      const int divisor = 2 * (i - top());
      from = 1 + numerator / divisor;  // not below 0: the top is lower somewhere
      if (from > (kept - 1) * step) continue;
    }
    ++last;
    line.parabola[static_cast<std::size_t>(last)] = i;
    line.from[static_cast<std::size_t>(last)] = from;
  }
  for (int n = kept - 1; n >= 0; --n) {
    const int x = n * step;
    while (last > 0 && line.from[static_cast<std::size_t>(last)] > x) --last;
    const int i = last < 0 ? 0 : line.parabola[static_cast<std::size_t>(last)];
    const int square = last < 0 ? int{kBeyond} : at(x, i);
    put(n, static_cast<std::uint16_t>(std::min(square, int{kBeyond})),
        line.tissue[static_cast<std::size_t>(i)]);
  }
}

// Calls work(n) for n = 0..count-1, each once; each thread has its own room. False: cancelled.
template <class Room, class Work>
bool in_parallel(int count, int threads, const Progress& progress, const Room& room,
                 const Work& work) {
  std::atomic<int> next{0};
  std::atomic<bool> stop{false};
  const auto take = [&](bool asks) {
    Room own = room;
    for (int n = next++; n < count && !stop; n = next++) {
      work(n, own);
      if (asks && progress.cancelled()) stop = true;
    }
  };
  rt::on_threads(threads, [&take](int thread) { take(thread == 0); });
  return !stop;
}

std::size_t sized(int n) { return static_cast<std::size_t>(n); }

}  // namespace

class DistanceTo::Maker {
 public:
  Maker(const Bone& bone, std::span<const TissueId> tissues) : bone_(bone) {
    for (const TissueId tissue : tissues) {
      wanted_[tissue] = true;
      solid_[tissue] = bone.tissues()[tissue].kind == TissueKind::solid;
    }
  }

  [[nodiscard]] Result<DistanceTo> make(const DistanceSettings& settings, Progress& progress) {
    if (!find_voxels()) return DistanceTo();
    choose(settings);
    // the result of the first two passes: few columns and rows, all slices
    squares_.assign(in_slice_ * sized(size_.z()), kBeyond);
    whose_.assign(squares_.size(), 0);
    made_.square_.assign(in_slice_ * sized(kept_.z()), kBeyond);
    made_.tissue_.assign(made_.square_.size(), 0);
    const char* stage = "measuring the distance to structures to spare";
    progress.report(0, stage);
    const bool flat = in_parallel(size_.z(), settings.threads, progress, Room(*this),
                                  [this](int k, Room& room) { along_rows_and_columns(k, room); });
    progress.report(0.8, stage);
    if (!flat || !in_parallel(kept_.y(), settings.threads, progress, Line(sized(size_.z())),
                              [this](int m, Line& line) { through_slices(m, line); }))
      return error(Trouble::interrupted, "stopped");
    progress.report(1, stage);
    return std::move(made_);
  }

 private:
  // buffers for one slice
  struct Room {
    explicit Room(const Maker& maker)
        : row(sized((maker.kept_.x() - 1) * maker.made_.step_ + 1)),
          column(sized(maker.size_.y())),
          labels(row.square.size()),
          squares(sized(maker.kept_.x()) * column.square.size()),
          whose(squares.size()) {}
    Line row, column;
    std::vector<TissueId> labels;
    std::vector<std::uint16_t> squares;  // (columns kept x rows)
    std::vector<TissueId> whose;
  };

  // the tissue that voxel v of a brick counts as; 0: none
  [[nodiscard]] TissueId counted(const TissueId* tissue, const Field* field, int v) const {
    if (!wanted_[tissue[v]]) return 0;
    return !solid_[tissue[v]] || (field != nullptr && field[v] >= kIso) ? tissue[v] : TissueId{0};
  }

  // The box of bricks that hold such voxels. False: there are none.
  [[nodiscard]] bool find_voxels() {
    bool found = false;
    for (BrickIndex brick = 0; brick < bone_.brick_count(); ++brick) {
      const TissueId* tissue = bone_.brick_tissue(brick);
      const Field* field = bone_.brick_field(brick);
      bool here = false;
      for (int v = 0; tissue != nullptr && v < kBrickVoxels && !here; ++v)
        here = counted(tissue, field, v) != 0;
      if (!here) continue;
      const math::Ijk first = bone_.brick_ijk(brick);
      lo_ = found ? math::Ijk(lo_.cwiseMin(first)) : first;
      hi_ = found ? math::Ijk(hi_.cwiseMax(first)) : first;
      found = true;
    }
    return found;
  }

  // Decides which voxels of the grid are kept: every step-th, and one at the far border or beyond it;
  // of those, the ones from which anything within the reach is interpolated.
  void choose(const DistanceSettings& settings) {
    const Grid& grid = bone_.grid();
    made_.grid_ = grid;
    made_.reach_ = std::min(settings.reach, kFarthest * grid.voxel);
    for (made_.step_ = 1;; ++made_.step_) {
      const int step = made_.step_;
      made_.all_ = ((grid.size.array() + (step - 2)) / step + 1).matrix();
      // farther than the reach by the diagonal of a cell
      const int margin = static_cast<int>(std::ceil(made_.reach_ / grid.voxel)) + 2 * step + 2;
      made_.first_ = ((lo_.array() - margin).max(0) / step).matrix();
      const math::Ijk end =
          ((hi_.array() + (kBrickEdge + margin)) / step + 2).min(made_.all_.array()).matrix();
      kept_ = end - made_.first_;
      in_slice_ = sized(kept_.x()) * sized(kept_.y());
      const std::size_t whole =
          sized(made_.all_.x()) * sized(made_.all_.y()) * sized(made_.all_.z());
      if (whole <= std::max<std::size_t>(settings.most_kept, 8)) break;
    }
    made_.kept_ = kept_;
    start_ = made_.first_ * made_.step_;
    size_ = ((kept_.array() - 1) * made_.step_ + 1).min((grid.size - start_).array()).matrix();
  }

  void along_rows_and_columns(int k, Room& room) {
    const std::size_t columns = sized(kept_.x()), step = sized(made_.step_);
    for (int j = 0; j < size_.y(); ++j) {
      read_row(start_.y() + j, start_.z() + k, room.labels);
      nearest_in_row(room.labels, room.row);
      for (std::size_t n = 0; n < columns; ++n) {
        room.squares[sized(j) * columns + n] = room.row.square[n * step];
        room.whose[sized(j) * columns + n] = room.row.tissue[n * step];
      }
    }
    for (std::size_t n = 0; n < columns; ++n) {
      for (std::size_t j = 0; j < room.column.square.size(); ++j) {
        room.column.square[j] = room.squares[j * columns + n];
        room.column.tissue[j] = room.whose[j * columns + n];
      }
      const std::size_t to = sized(k) * in_slice_ + n;
      envelope(room.column, size_.y(), kept_.y(), made_.step_,
               [&](int m, std::uint16_t square, TissueId tissue) {
                 squares_[to + sized(m) * columns] = square;
                 whose_[to + sized(m) * columns] = tissue;
               });
    }
  }

  // j, k: of the grid; labels: from the first voxel of the box on
  void read_row(int j, int k, std::vector<TissueId>& labels) const {
    const int row = (k % kBrickEdge * kBrickEdge + j % kBrickEdge) * kBrickEdge;
    const int begin = start_.x(), end = begin + size_.x();
    for (int i = begin; i < end;) {
      const BrickIndex brick = bone_.brick_at(i / kBrickEdge, j / kBrickEdge, k / kBrickEdge);
      const TissueId* tissue = bone_.brick_tissue(brick);
      const Field* field = bone_.brick_field(brick);
      for (const int last = std::min(end, (i / kBrickEdge + 1) * kBrickEdge); i < last; ++i)
        labels[sized(i - begin)] =
            tissue == nullptr ? TissueId{0} : counted(tissue, field, row + i % kBrickEdge);
    }
  }

  // the third pass, for all kept voxels with index m along j
  void through_slices(int m, Line& line) {
    for (int n = 0; n < kept_.x(); ++n) {
      const std::size_t to = sized(m) * sized(kept_.x()) + sized(n);
      for (std::size_t k = 0; k < line.square.size(); ++k) {
        line.square[k] = squares_[k * in_slice_ + to];
        line.tissue[k] = whose_[k * in_slice_ + to];
      }
      envelope(line, static_cast<int>(line.square.size()), kept_.z(), made_.step_,
               [&](int l, std::uint16_t square, TissueId tissue) {
                 made_.square_[sized(l) * in_slice_ + to] = square;
                 made_.tissue_[sized(l) * in_slice_ + to] = tissue;
               });
    }
  }

  const Bone& bone_;
  std::array<bool, 256> wanted_ = {}, solid_ = {};
  DistanceTo made_;
  math::Ijk lo_ = {0, 0, 0}, hi_ = {0, 0, 0};       // first voxels of the outermost bricks
  math::Ijk start_ = {0, 0, 0}, size_ = {0, 0, 0};  // voxels of the grid that are read
  math::Ijk kept_ = {0, 0, 0};
  std::size_t in_slice_ = 0;            // kept voxels per slice
  std::vector<std::uint16_t> squares_;  // (columns kept x rows kept x slices)
  std::vector<TissueId> whose_;
};

Result<DistanceTo> DistanceTo::make(const Bone& bone, std::span<const TissueId> tissues,
                                    const DistanceSettings& settings, Progress& progress) {
  return Maker(bone, tissues).make(settings, progress);
}

Nearest DistanceTo::at(const math::Vec3& p) const BURR_RT {
  if (empty() || !p.allFinite()) return {};
  const math::Vec3 wanted = grid_.grid_from_world(p) / step_;  // in kept voxels
  const math::Vec3 last = (all_ - math::Ijk::Ones()).cast<double>();
  const math::Vec3 inside = wanted.cwiseMax(0).cwiseMin(last);
  const math::Ijk low = inside.array()
                            .floor()
                            .matrix()
                            .cast<int>()
                            .cwiseMin(all_ - 2 * math::Ijk::Ones())
                            .cwiseMax(0);
  const math::Vec3 part = inside - low.cast<double>();

  double sum = 0, nearest = std::numeric_limits<double>::infinity();
  Nearest found;
  for (int corner = 0; corner < 8; ++corner) {
    const math::Ijk bit(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    const math::Ijk ijk = (low + bit).cwiseMin(all_ - math::Ijk::Ones()) - first_;
    const double weight = (bit.x() ? part.x() : 1 - part.x()) *
                          (bit.y() ? part.y() : 1 - part.y()) * (bit.z() ? part.z() : 1 - part.z());
    if (weight <= 0) continue;
    if ((ijk.array() < 0).any() || (ijk.array() >= kept_.array()).any()) return {};  // too far
    const std::size_t place =
        (static_cast<std::size_t>(ijk.z()) * static_cast<std::size_t>(kept_.y()) +
         static_cast<std::size_t>(ijk.y())) *
            static_cast<std::size_t>(kept_.x()) +
        static_cast<std::size_t>(ijk.x());
    if (square_[place] == kBeyond) return {};
    const double distance = std::sqrt(static_cast<double>(square_[place]));
    sum += weight * distance;
    // the tissue of the corner with the shortest path from here
    const double way = distance + step_ * (part - bit.cast<double>()).norm();
    if (way < nearest) {
      nearest = way;
      found.tissue = tissue_[place];
    }
  }
  // outside the grid: no path to the border is shorter than this (Pythagoras, since the grid is
  // convex)
  const double outside = step_ * (wanted - inside).norm();
  const double distance = grid_.voxel * (std::sqrt(sum * sum + outside * outside) - 0.5);
  if (distance > reach_) return {};
  found.distance = distance;
  return found;
}

}  // namespace burr::volume
