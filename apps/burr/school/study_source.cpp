#include "school/study_source.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/school/ratings.h"
#include "burr/school/study_tables.h"
#include "burr/scoring/rubric.h"
#include "school/store_command.h"

namespace burr::app {
namespace {

struct Opened {
  std::unique_ptr<school::Store> store;
  school::RubricRow rubric;
};

Result<Opened> open(const StudySource& source) {
  auto store = store_that_is_there(source.store);
  if (!store) return store.error();
  auto rubric = school::rubric_in(**store, source.rubric);
  if (!rubric) return rubric.error();
  return Opened{std::move(*store), std::move(*rubric)};
}

Result<school::study::Table> from_store(const StudySource& source, Asked asked) {
  const auto opened = open(source);
  if (!opened) return opened.error();
  const std::string& hash = opened->rubric.hash;
  switch (asked) {
    case Asked::marks:
      return school::marks_table(*opened->store, hash, source.part);
    case Asked::ratings:
      return school::ratings_table(*opened->store, hash);
    case Asked::groups:
      break;
  }
  if (source.low.empty() || source.high.empty())
    return error(Trouble::usage,
                 "give the levels of both groups, such as --low PGY1,PGY2 --high surgeon");
  return school::groups_table(*opened->store, hash, source.part, source.low, source.high);
}

Status write(const std::string& path, const std::string& text) {
  auto file = base::NewFile::create(path);
  if (!file) return file.error();
  file->write(text);
  return file->put_in_place();
}

}  // namespace

Result<school::study::Table> table_for(const StudySource& source, Asked asked,
                                       const std::vector<std::string>& needed,
                                       const std::vector<std::string>& optional) {
  if (source.from_store == !source.path.empty())
    return error(Trouble::usage, "give a table (F.csv) or a store (--store), one of them");
  if (!source.from_store) return school::study::read_table(source.path, needed, optional);
  const auto made = from_store(source, asked);
  if (!made) return made.error();
  const std::string text = school::csv_of(*made);
  if (!source.out.empty())
    if (const Status written = write(source.out, text); !written) return written.error();
  // through the same door as a file
  return school::study::parse_table(text, made->file, needed, optional);
}

Result<std::vector<double>> last_marks(const StudySource& source) {
  const auto opened = open(source);
  if (!opened) return opened.error();
  const auto table =
      school::marks_table(*opened->store, opened->rubric.hash, source.part, school::Which::sealed);
  if (!table) return table.error();
  std::map<std::string, double> last;
  for (std::size_t n = 0; n < table->rows.size(); ++n) {
    if (table->rows[n][4] != "0") continue;
    const auto value = table->number(n, 1);
    if (!value) return value.error();
    last[table->rows[n][0]] = *value;
  }
  std::vector<double> out;
  for (const auto& [unused, value] : last) out.push_back(value);
  return out;
}

Result<std::vector<double>> points_of_items(const StudySource& source,
                                            const std::vector<std::string>& judged) {
  const auto opened = open(source);
  if (!opened) return opened.error();
  const auto rubric = scoring::parse_rubric(opened->rubric.text, opened->rubric.name);
  if (!rubric) return rubric.error();
  std::map<std::string, double> weights;
  double all = 0;
  for (const scoring::Item& item : rubric->items) {
    if ((source.part == "product") != (item.part == scoring::Part::product)) continue;
    weights[item.id] = item.weight;
    all += item.weight;
  }
  std::vector<std::string> known;
  for (const auto& [id, unused] : weights) known.push_back(id);
  std::vector<std::string> sorted = judged;
  std::sort(sorted.begin(), sorted.end());
  if (sorted != known)
    return error(fmt::format("the judges' items are not those of the {} in rubric {}, which are {}",
                             source.part, base::printable(opened->rubric.name),
                             base::list_of(known)));
  std::vector<double> out;
  for (const std::string& id : judged) out.push_back(100 * weights[id] / all);
  return out;
}

Result<std::string> keep_standard(const StudySource& source, school::Standard standard) {
  const auto opened = open(source);
  if (!opened) return opened.error();
  standard.rubric_hash = opened->rubric.hash;
  standard.part = source.part;
  return school::set_standard(*opened->store, standard);
}

}  // namespace burr::app
