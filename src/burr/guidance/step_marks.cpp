#include "burr/guidance/step_marks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "burr/workshop/label_check.h"

namespace burr::guidance {
namespace {

constexpr double kPlace = 0.8e-3;  // radius of the mark at a point [m]

bool has_name(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

class Maker {
 public:
  Maker(const scenario::Step& step, const scenario::CaseLesson& lesson,
        const volume::TissueTable& tissues, const scoring::StepTarget* target)
      : step_(step), lesson_(lesson), tissues_(tissues), target_(target) {}

  StepMarks make() {
    if (!step_.region.empty()) add_target(step_.region);
    for (const std::string& name : step_.show) add_shown(name);
    if (step_.show.empty() && !step_.structure.empty() && !is_spared(step_.structure))
      light(step_.structure, out_.target);
    for (const std::string& name : step_.spare) add_spare(name);
    return std::move(out_);
  }

 private:
  // The step spares it, or the case wants it intact.
  [[nodiscard]] bool is_spared(const std::string& name) const {
    if (has_name(step_.spare, name)) return true;
    const scenario::Structure* one = lesson_.structure(name);
    return one != nullptr && !one->glass &&
           (one->intact == scenario::Intact::soft || one->intact == scenario::Intact::solid);
  }

  void mark(MarkKind kind, const math::Vec3& at, double radius, const std::string& name) {
    // the name stands once
    const bool named = std::any_of(out_.marks.begin(), out_.marks.end(), [&](const auto& one) {
      return one.kind == kind && one.name == name;
    });
    out_.marks.push_back({kind, at, radius, named ? std::string() : name});
  }

  // False: structures alone bound it, or planes, so it has no ring.
  bool add_shape(const scenario::Shape& shape, MarkKind kind, const std::string& name) {
    using scenario::ShapeKind;
    switch (shape.kind) {
      case ShapeKind::ball:
        mark(kind, shape.a.at, shape.radius, name);
        return true;
      case ShapeKind::capsule:
        mark(kind, shape.a.at, shape.radius, name);
        mark(kind, shape.b.at, shape.radius, name);
        return true;
      case ShapeKind::box:
        mark(kind, shape.a.at, 0.5 * shape.size.minCoeff(), name);
        return true;
      case ShapeKind::tube: {
        const auto last = static_cast<double>(shape.points.size() - 1);
        const auto from = static_cast<std::size_t>(std::lround(shape.from * last)),
                   to = static_cast<std::size_t>(std::lround(shape.to * last));
        for (std::size_t n = from; n <= to; ++n) mark(kind, shape.points[n], shape.radius, name);
        return true;
      }
      case ShapeKind::half_space:
      case ShapeKind::within:
      case ShapeKind::between:
        return false;
    }
    return false;
  }

  bool add_shapes(const std::string& name, MarkKind kind) {
    bool any = false;
    if (const scenario::CaseRegion* region = lesson_.region(name))
      for (const scenario::Shape& shape : region->add) any = add_shape(shape, kind, name) || any;
    return any;
  }

  // Where it lies on the bone, for a region that has no shape of its own.
  void add_target(const std::string& name) {
    const scenario::CaseRegion* region = lesson_.region(name);
    const bool found = target_ != nullptr && target_->found;
    if (region != nullptr && scoring::is_cut(*region)) {
      if (!found) return;
      mark(MarkKind::plane, target_->at, kPlace, name);
      out_.outline = target_->outline;
    } else if (!add_shapes(name, MarkKind::target) && found) {
      mark(MarkKind::target, target_->at, target_->radius, name);
    }
  }

  void add_points(const std::string& name, MarkKind kind) {
    if (const scenario::Landmark* place = lesson_.landmark(name))
      for (const math::Vec3& point : place->points) mark(kind, point, kPlace, name);
  }

  void add_shown(const std::string& name) {
    if (name == step_.region) return;
    if (is_spared(name)) {
      if (!has_name(step_.spare, name)) add_spare(name);  // the others follow
      return;
    }
    if (lesson_.structure(name) != nullptr) light(name, out_.target);
    add_shapes(name, MarkKind::place);
    add_points(name, MarkKind::place);
  }

  void add_spare(const std::string& name) {
    light(name, out_.spare);
    const std::size_t before = out_.marks.size();
    if (lesson_.structure(name) == nullptr) add_shapes(name, MarkKind::spare);
    add_points(name, MarkKind::spare);
    if (out_.marks.size() > before || target_ == nullptr) return;
    for (const scoring::StepTarget::Spared& one : target_->spared)
      if (one.name == name) mark(MarkKind::spare, one.at, kPlace, name);
  }

  void light(const std::string& structure, std::vector<volume::TissueId>& lit) {
    const scenario::Structure* one = lesson_.structure(structure);
    if (one == nullptr) return;
    for (const volume::TissueId id : workshop::tissues_of(*one, tissues_))
      if (std::find(lit.begin(), lit.end(), id) == lit.end()) lit.push_back(id);
  }

  const scenario::Step& step_;
  const scenario::CaseLesson& lesson_;
  const volume::TissueTable& tissues_;
  const scoring::StepTarget* target_;
  StepMarks out_;
};

}  // namespace

const char* word_of(MarkKind kind) {
  switch (kind) {
    case MarkKind::target:
      return "target";
    case MarkKind::plane:
      return "plane";
    case MarkKind::spare:
      return "spare";
    case MarkKind::place:
      return "place";
  }
  return "";
}

bool StepMarks::has(MarkKind kind) const {
  return std::any_of(marks.begin(), marks.end(),
                     [kind](const StepMark& one) { return one.kind == kind; });
}

StepMarks marks_of(const scenario::Step& step, const scenario::CaseLesson& lesson,
                   const volume::TissueTable& tissues, const scoring::StepTarget* target) {
  return Maker(step, lesson, tissues, target).make();
}

// They differ for people who cannot tell red from green, and each kind has a shape of its own.
MarkColour colour_of(MarkKind kind) {
  switch (kind) {
    case MarkKind::target:
      return {0.35F, 0.95F, 0.45F};
    case MarkKind::plane:
      return {0.34F, 0.71F, 0.91F};
    case MarkKind::spare:
      return {1.0F, 0.55F, 0.10F};
    case MarkKind::place:
      break;
  }
  return {0.93F, 0.94F, 0.95F};
}

}  // namespace burr::guidance
