#include "burr/scenario/case.h"

#include <fmt/core.h>

#include <safe_toml.h>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <utility>

#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/scenario/built_in_cases.h"
#include "burr/scenario/lesson.h"
#include "burr/scenario/rack.h"
#include "burr/scenario/read_lesson.h"
#include "burr/scenario/read_texts.h"
#include "burr/scenario/read_tools.h"
#include "burr/scenario/toml_reader.h"
#include "burr/tool/limits.h"

namespace burr::scenario {
namespace {

constexpr std::uintmax_t kLargestFile = 1U << 20;  // a case is about a page of text [byte]

void read_burr(Reader& reader, Case& out) {
  reader.only({"diameter_mm", "kind", "rpm"});
  double diameter_mm = 2e3 * out.burr.radius, rpm = 0;
  reader.setting("diameter_mm", diameter_mm, 1e3 * tool::kSmallestDiameter,
                 1e3 * tool::kLargestDiameter, "mm");
  out.burr.radius = 0.5e-3 * diameter_mm;
  out.file_burr_mm = diameter_mm;
  reader.choice<tool::BurrKind>(
      "kind", out.burr.kind,
      {{"cutting", tool::BurrKind::cutting}, {"diamond", tool::BurrKind::diamond}});
  reader.number("rpm", rpm, 0, tool::kFastestRpm, true);
  out.full_speed = rpm / 60 * 2 * std::numbers::pi;
  out.file_rpm = rpm;
}

// As it stands; workshop/case_session.h checks it by the table of settings, of which this room knows nothing.
void read_session(Reader& reader, CaseSettings& out) {
  reader.each_given([&](std::string_view word, base::Given value, std::uint32_t line) {
    out.fields.push_back({std::string(word), std::move(value), line});
  });
}

// A tool of the case's own has its name before the rack.
void read_tools(Reader& reader, Case& out) {
  Rack own;
  read_tool_list(reader, "own_tool", {}, {}, own);
  out.own_tools = std::move(own.all);
  reader.text("tool", out.tool);
  if (out.tool.empty()) return;
  for (const RackTool& tool : out.own_tools)
    if (tool.name == out.tool) return;
  if (const auto known = built_in_rack().get(out.tool); !known)
    reader.fail("tool", known.error().text);
}

void read_work(Reader& reader, Case& out) {
  reader.only({"at_mm", "into"});
  reader.vector("at_mm", out.at);
  reader.vector("into", out.into);
  if (out.at) *out.at *= 1e-3;
  if (!out.into) return;
  if (out.into->norm() < 1e-6) return reader.fail("into", "must be a direction, not [0, 0, 0]");
  out.into->normalize();
}

void read_all(Reader& reader, Case& out) {
  reader.only({"format", "title",    "description", "phantom",   "volume",  "voxel_mm",
               "rubric", "approach", "work",        "burr",      "demo",    "spare",
               "target", "landmark", "region",      "structure", "step",    "complication",
               "piece",  "feedback", "reference",   "tool",      "session", "own_tool"});
  Texts title, description;
  read_texts(reader, "title", title, true);
  read_texts(reader, "description", description);
  out.title = title.in("en");
  out.description = description.in("en");
  reader.text("phantom", out.phantom);
  reader.text("volume", out.volume);
  if (out.phantom.empty() == out.volume.empty())
    reader.fail("phantom", "give either phantom = \"NAME\" or volume = \"FILE\"");
  reader.text("rubric", out.rubric);
  read_tools(reader, out);
  reader.table("session", [&](Reader& inner) { read_session(inner, out.session.emplace()); });
  double voxel_mm = 0;
  reader.number("voxel_mm", voxel_mm, 0, 10);
  out.voxel = 1e-3 * voxel_mm;
  out.file_voxel_mm = voxel_mm;
  reader.table("work", [&](Reader& inner) { read_work(inner, out); });
  bool has_burr = false;
  reader.table("burr", [&](Reader& inner) {
    has_burr = true;
    read_burr(inner, out);
  });
  if (!has_burr) reader.fail("burr", "is missing; give [burr] with diameter_mm and rpm");
  reader.table("demo", [&](Reader& inner) {
    inner.only({"motion", "seconds"});
    inner.text("motion", out.motion);
    inner.number("seconds", out.seconds, 0, 3600);
  });
  reader.each("spare", [&](Reader& inner) {
    inner.only({"tissue"});
    inner.text("tissue", out.spare.emplace_back(), true);
  });
  reader.each("target", [&](Reader& inner) {
    Target& target = out.targets.emplace_back();
    inner.only({"tissue", "goal", "share"});
    inner.text("tissue", target.tissue, true);
    inner.choice<Goal>("goal", target.goal,
                       {{"open", Goal::open}, {"expose", Goal::expose}, {"remove", Goal::remove}});
    inner.number("share", target.share, 0, 1);
  });
}

// The text with the lines of `volume` and `rubric` replaced: where a file lies on somebody's disk, and
// what it is called, must not be recorded.
std::string without_paths(std::string_view text, const toml::table& table) {
  std::string out;
  for (std::uint32_t line = 1; !text.empty(); ++line) {
    const std::size_t end = text.find('\n');
    const std::string_view piece = text.substr(0, end == std::string_view::npos ? end : end + 1);
    std::string instead(piece);
    for (const char* const field : {"volume", "rubric"}) {
      const toml::node* node = table.get(field);
      if (node == nullptr) continue;
      const toml::source_region& at = node->source();
      if (line < at.begin.line || line > at.end.line) continue;
      instead = line == at.begin.line ? fmt::format("{} = \"{}\"\n", field, kOwnFile) : "";
    }
    out += instead;
    text.remove_prefix(piece.size());
  }
  return out;
}

}  // namespace

std::vector<std::string> built_in_cases() {
  std::vector<std::string> names;
  for (const BuiltIn& one : built_in_texts()) names.emplace_back(one.name);
  return names;
}

Result<Case> read_case(const std::string& name_or_path) {
  for (const BuiltIn& one : built_in_texts())
    if (name_or_path == one.name) return parse_case(one.toml, std::string(one.name) + ".toml");

  // errors name the file, not its folder
  const std::filesystem::path path(name_or_path);
  const std::string file = path.filename().string();
  if (path.extension() != ".toml")
    return error(
        Trouble::usage,
        fmt::format("there is no built-in case \"{}\"; use one of {}, or give a .toml file", file,
                    base::list_of(built_in_cases())));
  const auto text =
      base::text_of_file(path.string(), kLargestFile, "a case; check that this is the right file");
  if (!text) return text.error();

  Result<Case> read = parse_case(*text, file);
  // their paths are relative to the folder of the case
  if (read)
    for (std::string* const other : {&read->volume, &read->rubric})
      if (!other->empty() && std::filesystem::path(*other).is_relative())
        *other = (path.parent_path() / *other).string();
  return read;
}

Result<Case> parse_case(std::string_view text, std::string_view file) {
  if (text.size() > kLargestFile)
    return error(
        fmt::format("{}: has {} bytes, and a case at most {}; check that this is the right "
                    "file",
                    file, text.size(), kLargestFile));
  Case out;
  out.name = std::filesystem::path(file).stem().string();
  const auto table = parse_toml(text, file);
  if (!table) return table.error();
  std::optional<Error> wrong;
  Reader reader(*table, std::string(file), "", wrong);
  read_all(reader, out);
  CaseLesson lesson;  // only to find its mistakes now: lesson_of() reads it again from the text
  read_lesson(reader, lesson);
  if (wrong) return *wrong;
  out.text = without_paths(text, *table);
  return out;
}

bool names_no_file(const Case& work) {
  const auto fine = [](const std::string& file) { return file.empty() || file == kOwnFile; };
  return fine(work.volume) && fine(work.rubric);
}

std::string task_text(const Case& work) {
  std::string text = base::printable(work.title) + "\n";
  // line by line: base::printable() keeps a text of the file from moving the cursor
  for (std::string_view rest = work.description; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    text += base::printable(std::string(rest.substr(0, end)), 400) + "\n";
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  for (const Target& target : work.targets)
    text +=
        target.goal == Goal::remove && target.share < 1
            ? fmt::format("to do: remove {:.0f} % of {}\n", 100 * target.share,
                          base::printable(target.tissue))
            : fmt::format("to do: {} {}\n", word_of(target.goal), base::printable(target.tissue));
  if (!work.spare.empty()) text += fmt::format("do not cut: {}\n", base::list_of(work.spare));
  return text;
}

Status check_tissues(const Case& work, const volume::TissueTable& tissues) {
  std::vector<std::string> names;
  for (const volume::Tissue& tissue : tissues.tissues)
    if (&tissue != &tissues.tissues.front()) names.push_back(tissue.name);
  const auto missing = [&](const std::string& name) {
    for (const std::string& have : names)
      if (have == name) return false;
    return true;
  };
  const auto problem = [&](const char* field, const std::string& name) {
    return error(fmt::format("{}.toml: {}: the bone has no tissue \"{}\"; it has {}", work.name,
                             field, base::printable(name), base::list_of(names)));
  };
  for (const std::string& name : work.spare)
    if (missing(name)) return problem("spare", name);
  for (const Target& target : work.targets)
    if (missing(target.tissue)) return problem("target", target.tissue);
  return fine();
}

}  // namespace burr::scenario
