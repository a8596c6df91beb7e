// surgeon/believed.h - where a surgeon believes the structures of a case to be, and the regions of
// the case as this surgeon sees them.
//
// Each structure is moved as a whole by an error of perception e: the believed distance of a point
// p is the true distance of p - e (volume/distance_to.h). A region that leans on a structure moves
// with it. What a region takes from the plan instead (axes, points, planes) is seen no better: nobody
// finds a planned axis drawn in the bone. It is moved by an error of the same size, drawn for each
// region, and for the two ends of a curve apart, so that an axis is also tilted.
// Frame: world (LPS). Units: m. Thread: depth() and distance() any number at once. Memory: a tenth of
// the bone's for each structure.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"
#include "burr/volume/distance_to.h"

namespace burr::surgeon {

class Believed {
 public:
  // Looks up the structures that the lesson spares or that a region of it leans on. rms: of the
  // error of perception, per axis; its draws depend on the seed and on the structure's place in the
  // lesson. Error: interrupted.
  [[nodiscard]] static Result<Believed> make(const volume::Bone& bone,
                                             const scenario::CaseLesson& lesson, double rms,
                                             std::uint64_t seed, Progress& progress);

  // Infinity: beyond 12 mm, or the bone has no such structure.
  [[nodiscard]] double distance(const std::string& structure, const math::Vec3& p) const;
  // By how much it is believed to lie elsewhere.
  [[nodiscard]] math::Vec3 error_of(const std::string& structure) const;
  [[nodiscard]] bool known(const std::string& structure) const;
  // By how much the plan of a region is believed to lie elsewhere, at the first point of its curves
  // and at their last. A ball, box or half-space moves as the first.
  struct PlanError {
    math::Vec3 first = math::Vec3::Zero(), last = math::Vec3::Zero();
  };
  [[nodiscard]] PlanError plan_error_of(const std::string& region) const;

  // Depth below the border of a region, positive inside: exact for one shape, a bound for several.
  // The lesson must be placed (scenario::place) and outlive the function.
  using Depth = std::function<double(const math::Vec3&)>;
  [[nodiscard]] Depth region(const scenario::CaseRegion& region) const;

 private:
  struct Seen {
    volume::DistanceTo distance;
    math::Vec3 error = math::Vec3::Zero();
  };
  [[nodiscard]] double depth_in(const scenario::Shape& shape, const math::Vec3& p) const;
  [[nodiscard]] static scenario::Shape moved(scenario::Shape shape, const PlanError& error);

  std::map<std::string, Seen> seen_;
  std::map<std::string, PlanError> plan_;  // by region
};

// The structures that must stay whole: all that the lesson calls intact but plates of bone (which
// are thinned) and glass.
[[nodiscard]] std::vector<const scenario::Structure*> spared_of(const scenario::CaseLesson& lesson);

}  // namespace burr::surgeon
