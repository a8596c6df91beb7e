#include "score_items.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstddef>

#include "burr/report/score_words.h"

namespace burr::app {

void print_items(const scoring::Rubric& rubric, const scoring::Score& score) {
  for (const scoring::Part part : {scoring::Part::product, scoring::Part::process}) {
    if (std::none_of(rubric.items.begin(), rubric.items.end(),
                     [&](const auto& item) { return item.part == part; }))
      continue;
    fmt::print("{}\n", scoring::word_of(part));
    for (const std::size_t n : scoring::in_order(rubric, score.outcomes, part))
      fmt::print("{}\n", report::item_line(rubric.items[n], score.outcomes[n]));
  }
}

}  // namespace burr::app
