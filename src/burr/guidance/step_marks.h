// guidance/step_marks.h - what a step of the case is about, for a picture: the target, the planes of a cut, what is to
// be spared, and places for orientation. Each is marked in its own way, and never one as another.
//
// Pure functions. Thread: any. Units: SI. Frame: world.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/step_target.h"
#include "burr/volume/tissue.h"

namespace burr::guidance {

enum class MarkKind {
  target,  // to be worked on: a ring
  plane,   // of a cut: lines on the bone
  spare,   // must stay: a crossed ring
  place,   // for orientation: a small cross
};
[[nodiscard]] const char* word_of(MarkKind kind);  // "target", "plane", "spare", "place"

struct StepMark {
  MarkKind kind = MarkKind::place;
  math::Vec3 at = math::Vec3::Zero();
  double radius = 0;  // [m]
  std::string name;   // in the case; empty: it goes with the one before
  bool operator==(const StepMark& other) const = default;
};

struct StepMarks {
  std::vector<StepMark> marks;  // one of kind plane stands where the name of the cut is written
  std::vector<std::array<math::Vec3, 2>> outline;  // of the planes: ends of lines
  std::vector<volume::TissueId> target, spare;     // tissues
  [[nodiscard]] bool has(MarkKind kind) const;
};

// target: where the work lies on the bone; nullptr: not known (yet), then a target that only structures
// bound has no ring, and a cut no lines.
[[nodiscard]] StepMarks marks_of(const scenario::Step& step, const scenario::CaseLesson& lesson,
                                 const volume::TissueTable& tissues,
                                 const scoring::StepTarget* target);

// Colours: red, green, blue. Those of tissues are of target and spare.
struct MarkColour {
  float red = 0, green = 0, blue = 0;
};
[[nodiscard]] MarkColour colour_of(MarkKind kind);

}  // namespace burr::guidance
