// metrics/intact_soft.h - was a soft structure spared: how deep a turning burr went into it.
//
// A burr neither feels nor cuts soft tissue, so the bone at the end says nothing about it. Over all
// ticks in which the burr turned (above 5 % of its full speed):
//
//     p       = max (r - D_S(c))                              how deep
//     touched = p > p1,   p1 = h / 2, and 0.2 mm more for a diamond burr, whose grit is blunt
//     entered = p > p2,   p2 = 0.5 mm (not calibrated)
//     volume  = voxels of S inside the union of those balls
//
// D_S is up to half a voxel too short and 0.4 too long. Between two ticks the burr may have been
// deeper: with p1 and p2 at the ticks and s the way between them at most (p1 + p2 + s) / 2, since no
// depth changes faster than the burr moves. The error of p is half a voxel, and what that adds; what
// happened in a gap is not known. Where the centre of the head itself is in the structure, p is
// r + h / 2 and not more. Beyond its reach there is no contact. A tick without a radius does not
// count. Frame: world. Units: SI. Thread: one. Memory: the marks of the structure's
// voxels; none per tick.
#pragma once

#include <cstddef>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/metrics/voxel_marks.h"
#include "burr/metrics/voxel_set.h"
#include "burr/volume/distance_to.h"
#include "burr/volume/grid.h"

namespace burr::metrics {

// A stretch of time in which something went on; pauses below 50 ms do not end it.
struct Contact {
  double begin = 0, end = 0;           // [s]
  double seconds = 0;                  // in contact
  double depth = 0;                    // the largest [m]
  double force = 0, mean_force = 0;    // largest, mean [N]
  math::Vec3 at = math::Vec3::Zero();  // centre of the head at the largest depth
};

// Collects contacts; keeps the first kMostContacts and counts all.
class Contacts {
 public:
  Contacts();
  void add(const Moment& now, double depth);
  [[nodiscard]] const std::vector<Contact>& list() const { return list_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  Contact* open_contact(const Moment& now);
  std::vector<Contact> list_;
  std::size_t count_ = 0;
  double seconds_ = 0, last_ = -1e9;
};
inline constexpr std::size_t kMostContacts = 256;

struct IntactSoftSettings {
  double p2 = 0.5e-3;            // [m]
  double more_diamond = 0.2e-3;  // added to p1 for a diamond burr [m]
};

struct IntactSoft {
  Mark touched;       // value: p less what a diamond burr may; threshold: p1 [m]. met: not touched
  Mark entered;       // value: p; threshold: p2 [m]. met: not entered
  double volume = 0;  // of the structure that the burr went through [m^3]
  std::vector<Contact> contacts;  // in which it was touched
  std::size_t contact_count = 0;
  double deepest_at = 0;  // [s]; only if p > 0
  math::Vec3 deepest_place = math::Vec3::Zero();
};

class IntactSoftMaker {
 public:
  // structure: its voxels in `grid`; distance: to the same labels. Both outlive this.
  IntactSoftMaker(const volume::Grid& grid, const VoxelSet& structure,
                  const volume::DistanceTo& distance, const Worked& worked,
                  const IntactSoftSettings& settings);
  void add(const Moment& now);
  // Not assessable: the structure is not in the bone; the burr never turned; or no radius was
  // recorded while it did.
  [[nodiscard]] Assessed<IntactSoft> finish() const;

 private:
  volume::Grid grid_;
  const VoxelSet& structure_;
  const volume::DistanceTo& distance_;
  Worked worked_;
  IntactSoftSettings settings_;
  VoxelMarks through_;
  Contacts contacts_;
  // the largest at a tick, and at most between two ticks; less what a diamond burr may
  double deepest_ = -1e9, between_ = -1e9;            // [m]
  double deepest_less_ = -1e9, between_less_ = -1e9;  // [m]
  struct {
    bool known = false;
    math::Vec3 centre = math::Vec3::Zero();
    double depth = 0, less = 0;
  } last_;  // the tick before, if it is near the structure
  double deepest_at_ = 0;
  math::Vec3 deepest_place_ = math::Vec3::Zero(), marked_ = math::Vec3::Constant(1e9);
  double marked_radius_ = 0;
  bool turned_ = false, radius_ = false;
};

}  // namespace burr::metrics
