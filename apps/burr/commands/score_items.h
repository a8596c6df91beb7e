// apps/burr/commands/score_items.h - the items of a score, as `burr score` and `burr rubric check` print them.
#pragma once

#include "burr/scoring/rubric.h"
#include "burr/scoring/score.h"

namespace burr::app {

// Each part that the rubric has, what did harm first.
void print_items(const scoring::Rubric& rubric, const scoring::Score& score);

}  // namespace burr::app
