#include "burr/report/self_marks.h"

#include <fmt/core.h>
#include <safe_toml.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/record/course.h"

namespace burr::report {
namespace {

constexpr std::size_t kLargestMarks = 1 << 20;  // bytes

std::optional<SelfMark> self_mark_of(std::string_view word) {
  if (word == "met") return SelfMark::met;
  if (word == "not met" || word == "unmet") return SelfMark::unmet;  // "unmet": in recordings
  if (word == "unknown") return SelfMark::unknown;
  return std::nullopt;
}

}  // namespace

Result<SelfMarks> read_self_marks(const std::string& path, const scoring::Rubric& rubric) {
  const std::string file = std::filesystem::path(path).filename().string();
  const auto text = base::text_of_file(path, kLargestMarks,
                                       "a learner's marks; check that this is the right file");
  if (!text) return text.error();
  return parse_self_marks(*text, file, rubric);
}

Result<SelfMarks> parse_self_marks(std::string_view text, std::string_view file,
                                   const scoring::Rubric& rubric) {
  const auto table = parse_toml(text, file);
  if (!table) return table.error();
  const auto wrong = [&](const toml::node& at, std::string_view field, const std::string& what) {
    return error(fmt::format("{}: line {}: {}: {}", file, at.source().begin.line,
                             base::printable(field), what));
  };
  for (const auto& [key, node] : *table)
    if (key.str() != "marks" || !node.is_table())
      return wrong(node, key.str(), "is not a known field; write a table [marks]");
  const toml::table* marks = (*table)["marks"].as_table();
  if (marks == nullptr)
    return error(fmt::format("{}: marks: is missing; begin with [marks]", file));
  SelfMarks out;
  for (const auto& [key, node] : *marks) {
    const std::string id(key.str());
    if (rubric.item(id) == nullptr) {
      std::vector<std::string> items;
      for (const scoring::Item& item : rubric.items) items.push_back(item.id);
      return wrong(
          node, id,
          fmt::format("{} has no such item; use one of {}", rubric.file, base::list_of(items)));
    }
    const auto word = node.value_exact<std::string>();
    const auto mark = word ? self_mark_of(*word) : std::nullopt;
    if (!mark) return wrong(node, id, R"(must be "met", "not met" or "unknown")");
    out[id] = *mark;
  }
  return out;
}

SelfMarks recorded_self_marks(const record::Player& player, const scoring::Rubric& rubric) {
  SelfMarks out;
  for (const record::CourseEvent& event : player.course())
    if (event.kind == record::CourseKind::self_mark && rubric.item(event.what) != nullptr)
      if (const auto mark = self_mark_of(event.value)) out[event.what] = *mark;
  return out;
}

}  // namespace burr::report
