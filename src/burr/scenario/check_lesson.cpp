// Names in a lesson: each given once, and each that is used is there.
#include <fmt/core.h>

#include <cstddef>
#include <map>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/scenario/read_lesson.h"

namespace burr::scenario {
namespace {

class Checker {
 public:
  Checker(Reader& reader, const CaseLesson& lesson)
      : reader_(reader),
        lesson_(lesson),
        structures_(places_of(lesson.structures, &Structure::name)),
        regions_(places_of(lesson.regions, &CaseRegion::name)),
        steps_(places_of(lesson.steps, &Step::id)) {}

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
    for (const std::string& name : lesson_.reference->fill) region(line, "reference.fill", name);
    for (const auto& [name, thick] : lesson_.reference->leave)
      structure(line, "reference.leave", name);
  }

 private:
  using Places = std::map<std::string_view, std::size_t>;  // of names in a list

  template <class Item>
  static Places places_of(const std::vector<Item>& all, std::string Item::*name) {
    Places places;
    for (std::size_t n = 0; n < all.size(); ++n) places.emplace(all[n].*name, n);
    return places;
  }

  template <class Item>
  void once(const std::vector<Item>& all, std::string Item::*name, const char* field) {
    const Places first = places_of(all, name);
    for (std::size_t n = 0; n < all.size(); ++n)
      if (!(all[n].*name).empty() && first.at(all[n].*name) != n)
        reader_.fail_at(
            all[n].line, field,
            fmt::format("\"{}\" is given twice; rename one", base::printable(all[n].*name)));
  }

  void find(const Places& all, std::uint32_t line, const char* place, const std::string& name,
            const char* what) {
    if (all.contains(name) || reader_.failed()) return;  // the first mistake counts
    std::map<std::size_t, std::string_view> by_place;
    for (const auto& [each, at] : all) by_place.emplace(at, each);
    std::vector<std::string_view> names;
    for (const auto& [at, each] : by_place) names.push_back(each);
    reader_.fail_at(line, place,
                    fmt::format("there is no [[{}]] \"{}\"; {}", what, base::printable(name),
                                all.empty() ? "add it" : "use one of " + base::list_of(names)));
  }
  void structure(std::uint32_t line, const char* place, const std::string& name) {
    find(structures_, line, place, name, "structure");
  }
  void region(std::uint32_t line, const char* place, const std::string& name) {
    find(regions_, line, place, name, "region");
  }
  void step(std::uint32_t line, const char* place, const std::string& id) {
    find(steps_, line, place, id, "step");
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
        if (!regions_.contains(name)) structure(one.line, "step.spare", name);
        if (const auto at = structures_.find(name);
            at != structures_.end() && lesson_.structures[at->second].glass)
          reader_.fail_at(one.line, "step.spare",
                          fmt::format("\"{}\" is glass, which is never spared; leave it out",
                                      base::printable(name)));
      }
      if (one.done && !one.done->structure.empty())
        structure(one.done->line, "step.done.structure", one.done->structure);
      if (one.done && !one.done->region.empty())
        region(one.done->line, "step.done.region", one.done->region);
      for (const std::string& id : one.must_precede) step(one.line, "step.must_precede", id);
    }
    if (const Step* one = in_a_circle())
      reader_.fail_at(one->line, "step.must_precede",
                      fmt::format("\"{}\" would have to come before itself; break the circle",
                                  base::printable(one->id)));
  }

  // A step that comes after itself; nullptr: none does. Each step is left once, whoever leads to it.
  [[nodiscard]] const Step* in_a_circle() const {
    enum class Walk { fresh, on_the_way, left };
    std::vector<Walk> walked(lesson_.steps.size(), Walk::fresh);
    std::vector<std::pair<std::size_t, std::size_t>> way;  // a step, and how many were followed
    for (std::size_t start = 0; start < walked.size(); ++start) {
      if (walked[start] == Walk::fresh) way.emplace_back(start, 0);
      while (!way.empty()) {
        auto& [at, followed] = way.back();
        walked[at] = Walk::on_the_way;
        const std::vector<std::string>& after = lesson_.steps[at].must_precede;
        if (followed == after.size()) {
          walked[at] = Walk::left;
          way.pop_back();
          continue;
        }
        const auto next = steps_.find(after[followed++]);
        if (next == steps_.end()) continue;  // steps() has said so
        if (walked[next->second] == Walk::on_the_way) return &lesson_.steps[next->second];
        if (walked[next->second] == Walk::fresh) way.emplace_back(next->second, 0);
      }
    }
    return nullptr;
  }

  Reader& reader_;
  const CaseLesson& lesson_;
  const Places structures_, regions_, steps_;
};

}  // namespace

void check_names(Reader& reader, const CaseLesson& lesson) { Checker(reader, lesson).all(); }

}  // namespace burr::scenario
