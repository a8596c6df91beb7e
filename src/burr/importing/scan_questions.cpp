#include "burr/importing/scan_questions.h"

namespace burr::importing {

bool answered(const io::Question& question, const scenario::BoneRecipe& recipe) {
  switch (question.ask) {
    case io::Ask::missing:
    case io::Ask::absent:
      return recipe.allow_missing;
    case io::Ask::spacing:
      return (recipe.spacing_mm.array() > 0).all();
    case io::Ask::doubt:
      return recipe.as_it_is;
    case io::Ask::volume:
      return !recipe.series.empty();
  }
  return false;
}

}  // namespace burr::importing
