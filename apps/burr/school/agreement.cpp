#include "school/agreement.h"

namespace burr::app {

Result<std::vector<school::study::Rating>> ratings_of(const school::study::Table& table) {
  std::vector<school::study::Rating> out;
  for (std::size_t n = 0; n < table.rows.size(); ++n) {
    const auto met = table.flag(n, 3);
    if (!met) return met.error();
    out.push_back({table.rows[n][0], table.rows[n][1], table.rows[n][2], *met});
  }
  return out;
}

Result<std::vector<school::study::Mark>> marks_of(const school::study::Table& table) {
  std::vector<school::study::Mark> out;
  for (std::size_t n = 0; n < table.rows.size(); ++n) {
    if (!table.rows[n][3].empty()) {
      const auto guided = table.flag(n, 3);
      if (!guided) return guided.error();
      if (*guided) continue;
    }
    const auto mark = table.number(n, 1);
    if (!mark) return mark.error();
    out.push_back({table.rows[n][0], table.rows[n][2], *mark});
  }
  return out;
}

}  // namespace burr::app
