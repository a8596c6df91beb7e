#include "burr/guidance/step_rings.h"

#include <cmath>
#include <cstddef>

#include "burr/workshop/label_check.h"

namespace burr::guidance {
namespace {

constexpr double kPlace = 0.8e-3;  // radius of the ring around a point [m]

void add_shape(const scenario::Shape& shape, const std::string& name, std::vector<Ring>& rings) {
  using scenario::ShapeKind;
  switch (shape.kind) {
    case ShapeKind::ball:
      rings.push_back({shape.a.at, shape.radius, name});
      return;
    case ShapeKind::capsule:
      rings.push_back({shape.a.at, shape.radius, name});
      rings.push_back({shape.b.at, shape.radius, {}});
      return;
    case ShapeKind::box:
      rings.push_back({shape.a.at, 0.5 * shape.size.minCoeff(), name});
      return;
    case ShapeKind::tube: {
      const auto last = static_cast<double>(shape.points.size() - 1);
      const auto from = static_cast<std::size_t>(std::lround(shape.from * last)),
                 to = static_cast<std::size_t>(std::lround(shape.to * last));
      for (std::size_t n = from; n <= to; ++n)
        rings.push_back({shape.points[n], shape.radius, n == from ? name : std::string()});
      return;
    }
    case ShapeKind::half_space:
    case ShapeKind::within:
    case ShapeKind::between:
      return;
  }
}

void add_named(const std::string& name, const scenario::CaseLesson& lesson,
               std::vector<Ring>& rings) {
  const scenario::CaseRegion* region = lesson.region(name);
  if (region != nullptr)
    for (const scenario::Shape& shape : region->add) add_shape(shape, name, rings);
  if (const scenario::Landmark* place = lesson.landmark(name))
    for (const math::Vec3& point : place->points)
      rings.push_back(
          {point, kPlace, region == nullptr && &point == &place->points.front() ? name : ""});
}

}  // namespace

std::vector<Ring> rings_of(const scenario::Step& step, const scenario::CaseLesson& lesson) {
  std::vector<Ring> rings;
  for (const std::string& name : step.show) add_named(name, lesson, rings);
  if (step.show.empty() && !step.region.empty()) add_named(step.region, lesson, rings);
  return rings;
}

std::vector<volume::TissueId> lit_tissues(const scenario::Step& step,
                                          const scenario::CaseLesson& lesson,
                                          const volume::TissueTable& tissues) {
  std::vector<std::string> names = step.show;
  if (names.empty() && !step.structure.empty()) names.push_back(step.structure);
  std::vector<volume::TissueId> lit;
  for (const std::string& name : names)
    if (const scenario::Structure* structure = lesson.structure(name))
      for (const volume::TissueId id : workshop::tissues_of(*structure, tissues)) lit.push_back(id);
  return lit;
}

}  // namespace burr::guidance
