#include "burr/scenario/open_lesson.h"

#include <safe_toml.h>
#include <optional>
#include <string>

#include "burr/scenario/read_lesson.h"
#include "burr/scenario/toml_reader.h"

namespace burr::scenario {

Result<CaseLesson> lesson_of(const Case& work) {
  return parse_lesson(work.text, work.name + ".toml");
}

Result<CaseLesson> parse_lesson(std::string_view text, std::string_view file) {
  const auto table = parse_toml(text, file);
  if (!table) return table.error();
  std::optional<Error> wrong;
  Reader reader(*table, std::string(file), "", wrong);
  CaseLesson lesson;
  read_lesson(reader, lesson);
  if (wrong) return *wrong;
  return lesson;
}

}  // namespace burr::scenario
