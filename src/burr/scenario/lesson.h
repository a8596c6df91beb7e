// scenario/lesson.h - what a case of format 2 teaches: landmarks, regions, structures, steps,
// complications, feedback, texts in several languages. Data only: nothing here looks at a bone.
//
//     auto work = scenario::read_case("temporal-bone");
//     auto lesson = scenario::lesson_of(*work);                          // open_lesson.h
//     auto known = scenario::place(*lesson, landmarks_of_the_bone, file);   // names become points
//
// A case of format 1 has an empty lesson. docs/use/cases.md is the table of fields. Frame: world,
// LPS.
// Units: m here, mm in the file. Thread: any. Errors: one sentence with file, line, field, remedy.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/tool/burr_tool.h"

namespace burr::scenario {

// A text in one or more languages, by ISO 639-1 code: "en", "sv", "de".
struct Texts {
  std::map<std::string, std::string, std::less<>> by_language;
  // In that language; without it in English; without that in any. Empty: there is no text.
  [[nodiscard]] const std::string& in(std::string_view language) const;
  [[nodiscard]] bool empty() const { return by_language.empty(); }
};

// A named place: one point, a curve (two points or more), or a plane (a point and a normal).
struct Landmark {
  std::string name;
  Texts title = {};                       // as people read it; empty: `name`
  std::vector<math::Vec3> points;         // [m]; none: only a title for a landmark of the bone
  std::optional<math::Vec3> normal = {};  // unit; of a plane
  std::uint32_t line = 0;                 // in the file; 0: the bone's own
};

// A point as the file gives it: three numbers, or the name of a landmark.
struct Place {
  std::string landmark;                // empty: `at` is given
  math::Vec3 at = math::Vec3::Zero();  // [m]; set by place() where a landmark is named
};

enum class ShapeKind {
  ball,        // a, radius
  capsule,     // from a to b, radius
  box,         // centre a, size; edges along the axes of the world
  half_space,  // all that `normal` points to, seen from a
  tube,        // along a curve, radius; only the part from..to of its length, 0..1
  within,      // at most `radius` from the structure
  between,     // what lies between the structure and `other`, at most `radius` from each
};
[[nodiscard]] const char* word_of(ShapeKind kind);

struct Shape {
  ShapeKind kind = ShapeKind::ball;
  Place a, b;
  math::Vec3 size = math::Vec3::Zero();     // of a box: the whole edges [m]
  math::Vec3 normal = math::Vec3::UnitZ();  // unit
  double radius = 0;                        // or distance [m]
  std::string curve;                        // of a tube: a landmark
  std::vector<math::Vec3> points;           // of that curve, set by place() [m]
  double from = 0, to = 1;                  // of a tube: parts of the curve's length
  std::string structure, other;             // of within and between: names of structures
  std::uint32_t line = 0;
};

// A [[region]]: all that is in one of `add` and in none of `take`. (Region, in recipe.h, is a part of a
// scan.)
struct CaseRegion {
  std::string name;
  Texts title = {};  // as people read it; empty: `name`
  std::vector<Shape> add, take;
  std::uint32_t line = 0;
};

// What "intact" means for a structure.
enum class Intact {
  unsaid,  // the structure may be cut
  solid,   // nothing of it was removed
  soft,    // no turning burr was in it: a burr neither feels nor cuts soft tissue
  plate,   // there is no hole in the bone over it
};
[[nodiscard]] const char* word_of(Intact intact);

using Range = std::pair<double, double>;  // least and most

struct Structure {
  std::string name;
  Texts title;                     // as people read it; empty: `name`
  std::vector<std::string> names;  // in bones: every tissue of one of these names belongs to it
  Intact intact = Intact::unsaid;
  bool glass = false;     // one looks through it, and it is never spared
  bool optional = false;  // a bone without it is still good for the case
  // Expectations of its label, checked by label_check.h; none: not expected.
  std::optional<Range> volume;              // [m^3]
  std::optional<Range> inscribed;           // radius: the largest distance inside it [m]
  std::optional<Range> pieces;              // connected parts
  double length = 0;                        // at least; of its largest extent [m]; 0: not expected
  std::vector<std::string> touches, apart;  // names of structures
  std::uint32_t line = 0;
};

// When a step is done, by a measure of docs/teach/metrics.md. This room does not know the measures;
// scoring/step_done.h does.
struct DoneWhen {
  std::string measure, structure, region, along;  // structure, region: the step's own if not given
  std::map<std::string, double, std::less<>> limits;  // by their names in the file, in its units
  std::uint32_t line = 0;
};

struct Step {
  std::string id;
  Texts title, say;
  std::string structure, region;       // what is worked on, and where; empty: not said
  std::vector<std::string> spare;      // names of structures, or of regions that no burr is to cut
  std::string tool;                    // that suits, of the rack; empty: the round burr
  std::optional<tool::BurrKind> kind;  // of the round burr that suits
  std::optional<Range> diameter;       // [m]
  std::vector<math::Vec3> approach;    // unit, to the surgeon; empty: that of the lesson
  std::vector<std::string> show;       // structures, regions or landmarks to be lit on demand
  std::vector<std::string> must_precede;  // ids of steps
  std::optional<DoneWhen> done;           // none: only the user says so
  bool adds = false;                      // the region is filled with material, not cut away
  std::uint32_t line = 0;
};

struct Complication {
  std::string id;
  std::string step;       // begins with this step; empty: at any time
  std::string structure;  // that it concerns; empty: none
  Texts say;
  std::uint32_t line = 0;
};

// Which help a mode offers, as words of the file, and the rule by which guidance fades. A mode that
// is not given offers what it may (workshop/allowed.h).
struct Feedback {
  std::optional<std::vector<std::string>> learn, practise, exam;
  std::string fade;  // fade.h; empty: guidance does not fade
};

// A result that is known to be good: these regions are gone, these are filled, and this much is left
// over structures.
struct Reference {
  std::vector<std::string> remove;                    // regions
  std::vector<std::string> fill;                      // regions
  std::vector<std::pair<std::string, double>> leave;  // structure, thickness [m]
};

// A [[piece]]: the piece of bone at `near`, once it has come free, is to be moved so: a turn about its
// centre, then a shift.
struct PlannedPiece {
  Texts title = {};                      // as people read it; empty: none
  Place near;                            // a point in the piece
  math::Vec3 by = math::Vec3::Zero();    // [m]
  math::Vec3 turn = math::Vec3::Zero();  // rotation vector [rad]
  std::uint32_t line = 0;
};

struct CaseLesson {
  int format = 1;
  Texts title, description;
  std::vector<math::Vec3> approach;  // unit, from the bone to the surgeon
  std::vector<Landmark> landmarks;
  std::vector<CaseRegion> regions;
  std::vector<Structure> structures;
  std::vector<Step> steps;
  std::vector<Complication> complications;
  std::vector<PlannedPiece> pieces;
  Feedback feedback;
  std::optional<Reference> reference;

  // nullptr: there is none of this name
  [[nodiscard]] const Landmark* landmark(std::string_view name) const;
  [[nodiscard]] const CaseRegion* region(std::string_view name) const;
  [[nodiscard]] const Structure* structure(std::string_view name) const;
  [[nodiscard]] const Step* step(std::string_view id) const;
};

// The lesson with the landmarks of the bone added, and a point wherever a landmark is named. The
// case's own landmarks come first; one with a title alone takes the points of the bone's, and goes if
// the bone has none of its name. Error: a landmark that is named and that neither has.
[[nodiscard]] Result<CaseLesson> place(CaseLesson lesson, std::span<const Landmark> of_the_bone,
                                       const std::string& file);

}  // namespace burr::scenario
