#include "burr/scenario/lesson.h"

#include <fmt/core.h>

#include <algorithm>

#include "burr/base/printable.h"

namespace burr::scenario {
namespace {

template <class Item>
const Item* named(const std::vector<Item>& all, std::string_view name, std::string Item::*field) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Item& one) { return one.*field == name; });
  return found == all.end() ? nullptr : &*found;
}

// Looks up the names of a lesson's landmarks; the first name that nobody has is an error.
class Placer {
 public:
  Placer(CaseLesson& lesson, const std::string& file) : lesson_(lesson), file_(file) {}

  [[nodiscard]] Status all() {
    for (CaseRegion& region : lesson_.regions)
      for (std::vector<Shape>* shapes : {&region.add, &region.take})
        for (Shape& shape : *shapes) {
          put(shape, shape.a);
          put(shape, shape.b);
          if (shape.kind == ShapeKind::tube) put_curve(shape);
        }
    for (PlannedPiece& piece : lesson_.pieces) {
      if (piece.near.landmark.empty()) continue;
      if (const Landmark* found = lesson_.landmark(piece.near.landmark); found != nullptr)
        piece.near.at = found->points.front();
      else
        fail(piece.line, fmt::format("near: there is no landmark \"{}\"",
                                     base::printable(piece.near.landmark)));
    }
    for (const Step& step : lesson_.steps)
      for (const std::string& name : step.show)
        if (lesson_.structure(name) == nullptr && lesson_.region(name) == nullptr &&
            lesson_.landmark(name) == nullptr)
          fail(step.line, fmt::format("show: there is no structure, region or landmark \"{}\"",
                                      base::printable(name)));
    return wrong_ ? Status(*wrong_) : fine();
  }

 private:
  void put(const Shape& shape, Place& place) {
    if (place.landmark.empty()) return;
    const Landmark* found = lesson_.landmark(place.landmark);
    if (found == nullptr) return unknown(shape, place.landmark);
    place.at = found->points.front();
  }
  void put_curve(Shape& shape) {
    if (shape.curve.empty()) return;
    const Landmark* found = lesson_.landmark(shape.curve);
    if (found == nullptr) return unknown(shape, shape.curve);
    if (found->points.size() < 2)
      return fail(shape.line, fmt::format("along: the landmark \"{}\" is a point; give one that "
                                          "is a curve",
                                          base::printable(shape.curve)));
    shape.points = found->points;
  }
  void unknown(const Shape& shape, const std::string& name) {
    std::vector<std::string_view> names;
    for (const Landmark& one : lesson_.landmarks) names.push_back(one.name);
    fail(shape.line, fmt::format("{}: there is no landmark \"{}\"; {}", word_of(shape.kind),
                                 base::printable(name),
                                 names.empty() ? "give [[landmark]] with name and at_mm"
                                               : "use one of " + base::list_of(names)));
  }
  void fail(std::uint32_t line, const std::string& what) {
    if (!wrong_) wrong_ = error(fmt::format("{}: line {}: {}", file_, line, what));
  }

  CaseLesson& lesson_;
  const std::string& file_;
  std::optional<Error> wrong_;
};

}  // namespace

const std::string& Texts::in(std::string_view language) const {
  static const std::string nothing;
  for (const std::string_view each : {language, std::string_view("en")})
    if (const auto found = by_language.find(each); found != by_language.end()) return found->second;
  return by_language.empty() ? nothing : by_language.begin()->second;
}

const char* word_of(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::ball:
      return "ball";
    case ShapeKind::capsule:
      return "capsule";
    case ShapeKind::box:
      return "box";
    case ShapeKind::half_space:
      return "half-space";
    case ShapeKind::tube:
      return "tube";
    case ShapeKind::within:
      return "within";
    case ShapeKind::between:
      return "between";
  }
  return "";
}

const char* word_of(Intact intact) {
  switch (intact) {
    case Intact::unsaid:
      break;
    case Intact::solid:
      return "solid";
    case Intact::soft:
      return "soft";
    case Intact::plate:
      return "plate";
  }
  return "";
}

const Landmark* CaseLesson::landmark(std::string_view name) const {
  return named(landmarks, name, &Landmark::name);
}
const CaseRegion* CaseLesson::region(std::string_view name) const {
  return named(regions, name, &CaseRegion::name);
}
const Structure* CaseLesson::structure(std::string_view name) const {
  return named(structures, name, &Structure::name);
}
const Step* CaseLesson::step(std::string_view id) const { return named(steps, id, &Step::id); }

Result<CaseLesson> place(CaseLesson lesson, std::span<const Landmark> of_the_bone,
                         const std::string& file) {
  for (const Landmark& one : of_the_bone) {
    const auto own = std::find_if(lesson.landmarks.begin(), lesson.landmarks.end(),
                                  [&](const Landmark& each) { return each.name == one.name; });
    if (own == lesson.landmarks.end()) {
      lesson.landmarks.push_back(one);
    } else if (own->points.empty()) {
      own->points = one.points;
      own->normal = one.normal;
    }
  }
  std::erase_if(lesson.landmarks, [](const Landmark& one) { return one.points.empty(); });
  if (Status placed = Placer(lesson, file).all(); !placed) return placed.error();
  return lesson;
}

}  // namespace burr::scenario
