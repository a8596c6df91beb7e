// guidance/step_rings.h - what a step of the case is about: rings around places and regions, and tissues to light.
//
// Pure functions. Thread: any. Units: SI. Frame: world.
#pragma once

#include <string>
#include <vector>

#include "burr/math/vec3.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/tissue.h"

namespace burr::guidance {

// A ring of the picture: around a ball at `at`.
struct Ring {
  math::Vec3 at = math::Vec3::Zero();
  double radius = 0;  // [m]
  std::string name;
  bool operator==(const Ring& other) const = default;
};

// The landmarks and regions among `show` of a step, its region if it shows nothing. Parts of a region
// that are defined by structures have no ring.
[[nodiscard]] std::vector<Ring> rings_of(const scenario::Step& step,
                                         const scenario::CaseLesson& lesson);

// The tissues of the structures among `show`, of its own structure if it shows nothing.
[[nodiscard]] std::vector<volume::TissueId> lit_tissues(const scenario::Step& step,
                                                        const scenario::CaseLesson& lesson,
                                                        const volume::TissueTable& tissues);

// The colour of such a tissue: red, green, blue.
inline constexpr float kLitColour[3] = {0.35F, 0.95F, 0.45F};

}  // namespace burr::guidance
