// scenario/case.h - a case: a bone, where to work on it, with which burr, what to reach and what to
// spare.
//
// A TOML file (docs/use/cases.md). Units in the file: mm and revolutions per minute; here SI. The
// built-in cases are part of the library, so they are always available. Thread: any. Errors: one
// sentence with file, field and remedy.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/given.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/scenario/rack.h"
#include "burr/scenario/target.h"
#include "burr/tool/burr_tool.h"
#include "burr/volume/tissue.h"

namespace burr::scenario {

// How a session on the case is set, [session]: settings by their words and in the units of persons
// (docs/use/settings.md), so that one file gives one hash wherever it is run. What is left out is as usual.
// Here they are as the file has them; workshop::take_session() knows which there are and what they may be.
struct CaseSettings {
  struct Field {
    std::string word;
    base::Given value;
    std::uint32_t line = 0;  // of the file; 0: of none
  };
  std::vector<Field> fields;

  // The last one of that word counts.
  void set(std::string word, base::Given value) {
    fields.push_back({std::move(word), std::move(value)});
  }
  // nullptr: it is left out
  [[nodiscard]] const base::Given* get(std::string_view word) const {
    for (auto one = fields.rbegin(); one != fields.rend(); ++one)
      if (one->word == word) return &one->value;
    return nullptr;
  }
};

struct Case {
  std::string name;   // "temporal-bone"; for a file its name without .toml
  std::string title;  // one line
  std::string description;

  // the bone: a phantom's name, or a file (relative to the folder of the case file)
  std::string phantom, volume;
  double voxel = 0;  // edge of a voxel; 0: a value that suits the bone [m]

  // where to begin: a point near the surface and the direction into the bone; none: the topmost
  // bone
  std::optional<math::Vec3> at;    // world, LPS [m]
  std::optional<math::Vec3> into;  // unit

  std::string tool;  // of the rack, in the hand at the start; empty: the round burr
  tool::Burr burr;
  double full_speed = 0;  // of the spindle [rad/s]
  // Tools that the case defines itself, [[own_tool]]; they come before those of the rack.
  std::vector<RackTool> own_tools;
  // None: the case has no [session]. With it, diameter, speed and voxels are those of the file to the
  // last bit (burr_mm() and so on); without it they keep the last bit that they always had.
  std::optional<CaseSettings> session;
  double file_burr_mm = 0, file_rpm = 0, file_voxel_mm = 0;  // as the file has them

  // A .toml file (relative to the folder of the case file): the rubric by which work on this case is
  // judged. Empty: the built-in one of the case's name, if there is one.
  std::string rubric;

  std::vector<std::string> spare;  // tissues that must not be cut, by name
  std::vector<Target> targets;

  // what the simulated hand does where no person mills; seconds: for how long [s]
  std::string motion = "pocket";
  double seconds = 20;

  // The file's text, as a recording keeps it: where it names a volume or a rubric, kOwnFile stands in
  // place of the path. parse_case() reads it again.
  std::string text;
};

inline constexpr const char* kOwnFile = "own file";

// True: nothing in the case names a place on somebody's disk.
[[nodiscard]] bool names_no_file(const Case& work);

// As a person types them: what a session takes.
[[nodiscard]] double burr_mm(const Case& work);
[[nodiscard]] double rpm(const Case& work);
[[nodiscard]] double voxel_mm(const Case& work);  // 0: a value that suits the bone

// FNV-1a of 64 bits, so that other programs can work it out too. Shows a changed text; no secret.
[[nodiscard]] std::uint64_t text_hash(std::string_view text);

// "open", "expose", "remove": as the file says it.
[[nodiscard]] const char* word_of(Goal goal);

// What is to be done, for a terminal: title, description, targets, what must not be cut.
[[nodiscard]] std::string task_text(const Case& work);

[[nodiscard]] std::vector<std::string> built_in_cases();

// A built-in case by name, or the TOML file at a path.
[[nodiscard]] Result<Case> read_case(const std::string& name_or_path);

// The text of a case. `file` appears in errors and gives the case its name.
[[nodiscard]] Result<Case> parse_case(std::string_view text, std::string_view file);

// Checks that the bone has the tissues that the case names.
[[nodiscard]] Status check_tissues(const Case& work, const volume::TissueTable& tissues);

}  // namespace burr::scenario
