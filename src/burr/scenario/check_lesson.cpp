// Names in a lesson: each given once, and each that is used is there.
#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "burr/scenario/read_lesson.h"

namespace burr::scenario {
namespace {

class Checker {
 public:
  Checker(Reader& reader, const Lesson& lesson) : reader_(reader), lesson_(lesson) {}

  void all() {
    once(lesson_.landmarks, &Landmark::name, "landmark.name");
    once(lesson_.regions, &CaseRegion::name, "region.name");
    once(lesson_.structures, &Structure::name, "structure.name");
    once(lesson_.steps, &Step::id, "step.id");
    once(lesson_.complications, &Complication::id, "complication.id");
    regions();
    for (const Structure& one : lesson_.structures) {
      for (const std::string& name : one.touches) structure(one.line, "structure.touches", name);
      for (const std::string& name : one.apart) structure(one.line, "structure.apart", name);
    }
    steps();
    for (const Complication& one : lesson_.complications) {
      if (!one.structure.empty()) structure(one.line, "complication.structure", one.structure);
      if (!one.step.empty()) step(one.line, "complication.step", one.step);
    }
    if (!lesson_.reference) return;
    const std::uint32_t line = reader_.line("reference");
    for (const std::string& name : lesson_.reference->remove)
      region(line, "reference.remove", name);
    for (const auto& [name, thick] : lesson_.reference->leave)
      structure(line, "reference.leave", name);
  }

 private:
  template <class Item>
  void once(const std::vector<Item>& all, std::string Item::*name, const char* field) {
    std::set<std::string> seen;
    for (const Item& one : all)
      if (!(one.*name).empty() && !seen.insert(one.*name).second)
        reader_.fail_at(
            one.line, field,
            fmt::format("\"{}\" is given twice; rename one", base::printable(one.*name)));
  }

  template <class Item>
  void find(const std::vector<Item>& all, std::string Item::*field, std::uint32_t line,
            const char* place, const std::string& name, const char* what) {
    std::string list;
    for (const Item& one : all) {
      if (one.*field == name) return;
      list += (list.empty() ? "" : ", ") + base::printable(one.*field);
    }
    reader_.fail_at(line, place,
                    fmt::format("there is no [[{}]] \"{}\"; {}", what, base::printable(name),
                                list.empty() ? std::string("add it") : "use one of " + list));
  }
  void structure(std::uint32_t line, const char* place, const std::string& name) {
    find(lesson_.structures, &Structure::name, line, place, name, "structure");
  }
  void region(std::uint32_t line, const char* place, const std::string& name) {
    find(lesson_.regions, &CaseRegion::name, line, place, name, "region");
  }
  void step(std::uint32_t line, const char* place, const std::string& id) {
    find(lesson_.steps, &Step::id, line, place, id, "step");
  }

  void regions() {
    for (const CaseRegion& one : lesson_.regions)
      for (const std::vector<Shape>* shapes : {&one.add, &one.take})
        for (const Shape& shape : *shapes) {
          if (!shape.structure.empty()) structure(shape.line, "region.structure", shape.structure);
          if (!shape.other.empty()) structure(shape.line, "region.other", shape.other);
        }
  }

  void steps() {
    for (const Step& one : lesson_.steps) {
      if (!one.structure.empty()) structure(one.line, "step.structure", one.structure);
      if (!one.region.empty()) region(one.line, "step.region", one.region);
      for (const std::string& name : one.spare) {
        structure(one.line, "step.spare", name);
        if (const Structure* spared = lesson_.structure(name); spared != nullptr && spared->glass)
          reader_.fail_at(one.line, "step.spare",
                          fmt::format("\"{}\" is glass, which is never spared; leave it out",
                                      base::printable(name)));
      }
      for (const std::string& id : one.must_precede) step(one.line, "step.must_precede", id);
    }
    for (const Step& one : lesson_.steps) {
      std::set<std::string> seen;
      if (reaches(one.id, one, seen))
        reader_.fail_at(one.line, "step.must_precede",
                        fmt::format("\"{}\" would have to come before itself; break the circle",
                                    base::printable(one.id)));
    }
  }

  // True: `id` comes after `from`, by whatever way.
  [[nodiscard]] bool reaches(const std::string& id, const Step& from,
                             std::set<std::string>& seen) const {
    return std::any_of(
        from.must_precede.begin(), from.must_precede.end(), [&](const std::string& next) {
          if (next == id) return true;
          const Step* step = lesson_.step(next);
          return step != nullptr && seen.insert(next).second && reaches(id, *step, seen);
        });
  }

  Reader& reader_;
  const Lesson& lesson_;
};

}  // namespace

void check_names(Reader& reader, const Lesson& lesson) { Checker(reader, lesson).all(); }

}  // namespace burr::scenario
