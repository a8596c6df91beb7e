// apps/burr/window/replay/facts.h - what a recording says of the structures that must not be cut, and
// what it took away: the numbers beside the pictures.
//
//     auto facts = facts_of("s.mcap", recipe, progress);     // seconds; on a thread of its own
//     facts->nearest_in(12.0, 12.1)                          // least distance in that 0.1 s
//
// The distance is that from the burr's surface to the nearest tissue that the case, or the table of
// tissues, says to spare (workshop/spared_distance.h); below 0 inside. A violation is a time in which
// a turning burr was more than half a voxel deep in one, as in mill/injury.h.
// Thread: any; needs nothing of the window. Frame: world. Units: m, s. Memory: the bone as it was.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/recipe.h"
#include "burr/volume/bone.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"

namespace burr::app {

struct Violation {
  double from = 0, until = 0;  // [s]
  std::string name;            // of the tissue
  double deepest = 0;          // of the burr's surface in it [m]
};

struct Facts {
  static constexpr std::size_t kParts = 4096;  // of the whole time
  static constexpr float kFar = std::numeric_limits<float>::infinity();

  struct Part {
    float distance = kFar;  // the least; kFar: beyond the range, or no tick [m]
    volume::TissueId tissue = 0;
  };

  double seconds = 0;
  std::uint64_t hash = 0;   // of the bone before the first tick
  bool spares = false;      // there is something to spare
  std::vector<Part> parts;  // (kParts); empty if nothing is to be spared
  std::vector<Violation> violations;
  std::vector<workshop::TissueLoss> lost;  // at the end, largest loss first
  std::shared_ptr<volume::Bone> before;    // at the first tick

  // The least between two moments; if they lie in one part, that part's.
  [[nodiscard]] Part nearest_in(double from_s, double to_s) const;
  // Of the whole recording; none: never within range, or nothing is to be spared.
  struct Least {
    double t = 0, distance = 0;  // [s], [m]
    std::string name;
  };
  [[nodiscard]] std::optional<Least> least() const;
  [[nodiscard]] std::string name_of(const Part& part) const;
};

// volume: where the bone is found. Errors: the file or its bone cannot be read; interrupted.
[[nodiscard]] Result<Facts> facts_of(const std::string& recording,
                                     const scenario::BoneRecipe& volume, Progress& progress);

// A row of the table of what two recordings took away; the tissues of both, largest loss first.
struct LossRow {
  std::string name;
  double left = 0, right = 0;  // [m^3]
  bool spare = false;
};
[[nodiscard]] std::vector<LossRow> compared(const std::vector<workshop::TissueLoss>& left,
                                            const std::vector<workshop::TissueLoss>& right);

}  // namespace burr::app
