#include "burr/scoring/rubric.h"

#include <fmt/core.h>
#include <safe_toml.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include "burr/base/check.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/scenario/case.h"
#include "burr/scenario/read_texts.h"
#include "burr/scenario/toml_reader.h"
#include "burr/scoring/built_in_rubrics.h"

namespace burr::scoring {
namespace {

using scenario::Reader;

constexpr std::size_t kLargestFile = 1 << 20;  // bytes
constexpr std::size_t kMostItems = 500;

template <class List, class Name>
std::string list_of(const List& list, const Name& name) {
  std::vector<std::string> names;
  for (const auto& one : list) names.emplace_back(name(one));
  return names.empty() ? "none" : base::list_of(names);
}

// The measure; nullptr after an error.
const Measure* read_measure(Reader& reader) {
  std::string name;
  reader.text("measure", name, true);
  if (name.empty()) return nullptr;
  const Measure* how = measure_named(name);
  if (how == nullptr)
    reader.fail(
        "measure",
        fmt::format("\"{}\" is not a known measure; use one of {}", base::printable(name),
                    list_of(measures(), [](const auto& m) { return std::string(m.name); })));
  return how;
}

bool is_of_cavity(const Measure& how) { return std::string_view(how.name).starts_with("cavity_"); }

std::vector<std::string_view> fields_of(const Measure& how) {
  std::vector<std::string_view> fields = {"id",      "part",     "weight",   "gate",
                                          "measure", "requires", "source",   "calibrated",
                                          "say",     "grade",    "earned_by"};
  if (how.structure) fields.emplace_back("structure");
  if (how.region || how.anywhere) fields.emplace_back("region");
  if (how.along || how.on_curve) fields.emplace_back("along");
  if (how.on_plane) fields.emplace_back("plane");
  if (is_of_cavity(how)) fields.emplace_back("within");
  for (const Limit& limit : how.limits) fields.emplace_back(limit.field);
  return fields;
}

void read_limits(Reader& reader, Item& out) {
  for (const Limit& limit : out.how->limits) {
    double value = limit.preset;
    // along a tube the share is one of slices, and each slice has a near side
    if (out.how->along && !out.along.empty() && std::string_view(limit.field) == "share")
      value = kShareAlong;
    reader.number(limit.field, value, limit.above, limit.most);
    out.limits[limit.field] = value * limit.unit;
  }
  for (const auto& [low, high] : {std::pair{"lo_mm", "hi_mm"}, std::pair{"from_mm", "to_mm"}})
    if (out.limits.contains(low) && out.limits.contains(high) && out.limit(low) >= out.limit(high))
      reader.fail(high, fmt::format("must be above {} ({:g} mm)", low, 1e3 * out.limit(low)));
}

void read_grade(Reader& reader, Item& out) {
  reader.pair("grade", out.grade);
  if (!out.grade) return;
  if (!may_be_graded(*out.how)) {
    reader.fail("grade", fmt::format("\"{}\" is decided by two numbers, so it cannot be graded; "
                                     "leave \"grade\" out",
                                     out.how->name));
  } else if (out.grade->first == out.grade->second) {
    reader.fail("grade",
                "the value that earns nothing and the one that earns everything must differ");
  }
  for (double* value : {&out.grade->first, &out.grade->second})
    *value *= unit_of(out.how->quantity);
}

void read_item(Reader& reader, Item& out) {
  reader.text("id", out.id, true);
  out.how = read_measure(reader);
  if (out.how == nullptr) return;
  reader.only(fields_of(*out.how));
  reader.choice<Part>("part", out.part, {{"product", Part::product}, {"process", Part::process}},
                      true);
  if (out.part != out.how->part)
    reader.fail("part", fmt::format("\"{}\" measures the {}; use part = \"{}\"", out.how->name,
                                    word_of(out.how->part), word_of(out.how->part)));
  reader.number("weight", out.weight, 0, 1000);
  reader.flag("gate", out.gate);
  reader.text("structure", out.structure, out.how->structure);
  reader.text("region", out.region, out.how->region);
  reader.text("along", out.along, out.how->on_curve);
  reader.text("plane", out.plane, out.how->on_plane);
  reader.text("within", out.within);
  reader.text("requires", out.needs);
  reader.text("earned_by", out.earned_by);
  reader.text("source", out.source);
  reader.flag("calibrated", out.calibrated);
  scenario::read_texts(reader, "say", out.say, true);
  read_limits(reader, out);
  read_grade(reader, out);
  out.lines[""] = reader.line();
  for (const char* field :
       {"structure", "region", "along", "plane", "within", "requires", "earned_by"})
    out.lines[field] = reader.line(field);
}

void check_ids(Reader& reader, const Rubric& rubric) {
  std::map<std::string, std::uint32_t> seen;
  for (const Item& item : rubric.items) {
    const auto [first, fresh] = seen.emplace(item.id, item.lines.at(""));
    if (!fresh)
      reader.fail_at(item.lines.at(""), "id",
                     fmt::format("\"{}\" is also the item of line {}; give it another id",
                                 base::printable(item.id), first->second));
  }
}

// `requires` names an item of the same part, and whoever follows it does not come back.
void check_needs(Reader& reader, const Rubric& rubric) {
  std::map<std::string_view, const Item*> by_id;
  for (const Item& item : rubric.items) by_id.emplace(item.id, &item);
  std::set<std::string_view> good;  // nobody goes a way twice
  for (const Item& item : rubric.items) {
    std::set<std::string_view> way = {item.id};
    for (const Item* at = &item; at != nullptr && !at->needs.empty() && !good.contains(at->id);) {
      const auto found = by_id.find(at->needs);
      const Item* next = found == by_id.end() ? nullptr : found->second;
      if (next == nullptr) {
        reader.fail_at(at->lines.at("requires"), "requires",
                       fmt::format("there is no item \"{}\"; use the id of one of these: {}",
                                   base::printable(at->needs),
                                   list_of(rubric.items, [](const Item& i) { return i.id; })));
      } else if (!way.insert(next->id).second) {
        reader.fail_at(at->lines.at("requires"), "requires",
                       fmt::format("\"{}\" leads back to itself; take one \"requires\" out of the "
                                   "circle",
                                   base::printable(next->id)));
        next = nullptr;
      } else if (next->part != at->part) {
        reader.fail_at(
            at->lines.at("requires"), "requires",
            fmt::format("\"{}\" is an item of the {}, and this one of the {}; the two "
                        "parts are never mixed, so require an item of the same part",
                        base::printable(next->id), word_of(next->part), word_of(at->part)));
        next = nullptr;
      }
      at = next;
    }
    good.merge(way);
  }
}

bool has_direction(const scenario::Landmark& curve) {
  return (curve.points.back() - curve.points.front()).norm() > 1e-6;
}

Error missing(const Rubric& rubric, const Item& item, const char* field, const std::string& name,
              const std::string& known) {
  const std::string_view named = field;
  const std::string_view kind = named == "along" ? "curve among its landmarks"
                                : named == "within" || named == "earned_by" ? "region"
                                                                            : named;
  return error(fmt::format("{}: line {}: {}: the case \"{}\" has no {} \"{}\"; use one of {}",
                           rubric.file, item.lines.at(field), field,
                           base::printable(rubric.case_name), kind, base::printable(name), known));
}

}  // namespace

double Item::limit(std::string_view field) const {
  const auto found = limits.find(field);
  BURR_CHECK(found != limits.end());
  return found->second;
}

const Item* Rubric::item(std::string_view id) const {
  for (const Item& one : items)
    if (one.id == id) return &one;
  return nullptr;
}

std::vector<std::string> built_in_rubrics() {
  std::vector<std::string> names;
  for (const BuiltIn& one : built_in_texts()) names.emplace_back(one.name);
  return names;
}

Result<Rubric> read_rubric(const std::string& name_or_path) {
  for (const BuiltIn& one : built_in_texts())
    if (name_or_path == one.name) return parse_rubric(one.toml, std::string(one.name) + ".toml");
  const std::filesystem::path path(name_or_path);
  const std::string file = path.filename().string();
  if (path.extension() != ".toml")
    return error(Trouble::usage,
                 fmt::format("there is no built-in rubric \"{}\"; use one of {}, or give a .toml "
                             "file",
                             base::printable(file),
                             list_of(built_in_rubrics(), [](const auto& n) { return n; })));
  const auto text = base::text_of_file(path.string(), kLargestFile,
                                       "a rubric; check that this is the right file");
  if (!text) return text.error();
  auto rubric = parse_rubric(*text, file);
  if (rubric && rubric->case_source != rubric->case_name &&
      std::filesystem::path(rubric->case_source).is_relative())
    rubric->case_source = (path.parent_path() / rubric->case_source).string();
  return rubric;
}

Result<Rubric> parse_rubric(std::string_view text, std::string_view file) {
  const auto table = parse_toml(text, file);
  if (!table) return table.error();
  std::optional<Error> wrong;
  Reader reader(*table, std::string(file), "", wrong);
  Rubric out;
  out.file = file;
  out.text = text;
  out.text_hash = scenario::text_hash(text);
  reader.only({"rubric", "item"});
  if (!reader.has("rubric")) reader.fail("rubric", "is missing; begin with [rubric]");
  reader.table("rubric", [&](Reader& inner) {
    inner.only({"name", "version", "case"});
    double version = 1;
    inner.text("name", out.name, true);
    inner.number("version", version, 0, 1e6, true);
    out.version = static_cast<int>(version);
    if (out.version != version) inner.fail("version", "must be a whole number, 1 or more");
    inner.text("case", out.case_source, true);
    const std::filesystem::path source = out.case_source;
    out.case_name = source.extension() == ".toml" ? source.stem().string() : out.case_source;
  });
  if (!reader.has("item")) reader.fail("item", "is missing; give at least one [[item]]");
  reader.each(
      "item",
      [&](Reader& inner) {
        if (!wrong) read_item(inner, out.items.emplace_back());
      },
      kMostItems);
  if (wrong) return *wrong;
  check_ids(reader, out);
  check_needs(reader, out);
  if (wrong) return *wrong;
  return out;
}

Status check(const Rubric& rubric, const scenario::CaseLesson& lesson) {
  const auto name = [](const auto& one) { return one.name; };
  for (const Item& item : rubric.items) {
    if (!item.structure.empty() && lesson.structure(item.structure) == nullptr)
      return missing(rubric, item, "structure", item.structure, list_of(lesson.structures, name));
    if (!item.region.empty() && lesson.region(item.region) == nullptr)
      return missing(rubric, item, "region", item.region, list_of(lesson.regions, name));
    if (!item.within.empty() && lesson.region(item.within) == nullptr)
      return missing(rubric, item, "within", item.within, list_of(lesson.regions, name));
    if (!item.earned_by.empty() && lesson.region(item.earned_by) == nullptr)
      return missing(rubric, item, "earned_by", item.earned_by, list_of(lesson.regions, name));
    const auto landmark = [&](const char* field, const std::string& wanted, auto is) {
      std::vector<scenario::Landmark> of_kind;
      for (const scenario::Landmark& one : lesson.landmarks)
        if (is(one)) of_kind.push_back(one);
      const bool found =
          wanted.empty() || std::any_of(of_kind.begin(), of_kind.end(),
                                        [&](const auto& l) { return l.name == wanted; });
      return found ? fine() : Status(missing(rubric, item, field, wanted, list_of(of_kind, name)));
    };
    if (const Status there =
            landmark("along", item.along, [](const auto& l) { return l.points.size() > 1; });
        !there)
      return there;
    if (item.how->on_curve && item.how->region && !has_direction(*lesson.landmark(item.along)))
      return error(
          fmt::format("{}: line {}: along: the curve \"{}\" begins and ends at the same point, so "
                      "it is no axis; "
                      "use another one",
                      rubric.file, item.lines.at("along"), base::printable(item.along)));
    if (const Status there =
            landmark("plane", item.plane, [](const auto& l) { return l.normal.has_value(); });
        !there)
      return there;
  }
  return fine();
}

}  // namespace burr::scoring
