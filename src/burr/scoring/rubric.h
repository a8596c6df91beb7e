// scoring/rubric.h - a rubric, read from a file: the items by which work on a case is judged.
//
//     auto rubric = scoring::read_rubric("temporal-bone");       // built in, or a .toml file
//     Status fits = scoring::check(*rubric, lesson);             // the lesson with its landmarks placed
//
// docs/teach/scoring.md is the table of fields. Units in the file: mm; here SI. Thread: any.
// Errors: one sentence with file, line, field and remedy.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/result.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/measure_list.h"

namespace burr::scoring {

struct Item {
  std::string id;
  Part part = Part::product;
  double weight = 1;
  bool gate = false;                            // unmet: not safe, whatever the total
  const Measure* how = nullptr;                 // never nullptr after reading
  std::string structure, region, along, plane;  // names of the case; empty: none
  std::string within;  // of a cavity: a region; what was cut outside of it is another cavity
  std::map<std::string, double, std::less<>> limits;  // every threshold of the measure, SI
  // The values that earn nothing and everything, linear between; SI, in the quantity of the measure.
  // None: met earns everything, unmet nothing. The verdict is by the threshold alone.
  std::optional<std::pair<double, double>> grade;
  std::string needs;  // `requires` in the file: an item that must be met too; empty: none
  // The region whose work earns the item: below metrics::kLeastWork of it the item is not met, and it is too
  // early to say more. Empty: what the case says to remove in whole decides, where the measure asks for it.
  std::string earned_by;
  std::string source;       // where the item and its thresholds come from
  bool calibrated = false;  // somebody compared the thresholds with people
  scenario::Texts say;
  std::map<std::string, std::uint32_t, std::less<>> lines;  // of its fields; "" is the item itself

  [[nodiscard]] double limit(std::string_view field) const;
};

struct Rubric {
  std::string file;  // for errors, without its folder
  std::string name;
  std::string case_name;  // of the case that it judges: scenario::Case::name
  // what scenario::read_case() reads: a built-in case, or a .toml file. The rubric's file says where
  // it is from its own folder.
  std::string case_source;
  int version = 1;
  std::string text;             // the file
  std::uint64_t text_hash = 0;  // scenario::text_hash() of it
  std::vector<Item> items;

  [[nodiscard]] const Item* item(std::string_view id) const;  // nullptr: there is none
};

[[nodiscard]] std::vector<std::string> built_in_rubrics();

// A built-in rubric by name, or the TOML file at a path.
[[nodiscard]] Result<Rubric> read_rubric(const std::string& name_or_path);

// file: its name for errors.
[[nodiscard]] Result<Rubric> parse_rubric(std::string_view text, std::string_view file);

// The case must have every structure, region and curve that the rubric names.
[[nodiscard]] Status check(const Rubric& rubric, const scenario::CaseLesson& lesson);

}  // namespace burr::scoring
