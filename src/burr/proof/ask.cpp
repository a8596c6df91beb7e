#include "burr/proof/ask.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace burr::proof {
namespace {

// How many of the unit that people read one SI unit is.
double read_in(scoring::Quantity quantity) {
  switch (quantity) {
    case scoring::Quantity::length:
      return 1e3;
    case scoring::Quantity::area:
      return 1e6;
    case scoring::Quantity::volume:
      return 1e9;
    case scoring::Quantity::angle:
      return 180 / std::numbers::pi;
    default:
      return 1;
  }
}
const char* word_for(scoring::Quantity quantity) {
  switch (quantity) {
    case scoring::Quantity::length:
      return "mm";
    case scoring::Quantity::area:
      return "mm2";
    case scoring::Quantity::volume:
      return "mm3";
    case scoring::Quantity::angle:
      return "deg";
    default:
      return "";
  }
}

Answer answer_of(const KnownScene& scene, const Right& right, const scoring::Outcome& outcome) {
  const double unit = read_in(outcome.quantity);
  Answer answer;
  answer.item = right.item;
  answer.unit = word_for(outcome.quantity);
  answer.must = right.verdict;
  answer.verdict = outcome.verdict;
  answer.reason = outcome.reason;
  if (outcome.value) answer.is = *outcome.value * unit;
  if (!right.value) return answer;
  answer.right = right.value(scene);
  answer.tolerance = right.tolerance.fixed + right.tolerance.voxels * scene.voxel_mm();
  if (right.tolerance.stated) answer.tolerance = std::max(answer.tolerance, outcome.error * unit);
  const double beyond = *answer.right - outcome.threshold * unit;
  if (outcome.value && std::abs(beyond) > answer.tolerance)
    answer.must = (beyond > 0) == outcome.at_least ? kMet : kUnmet;
  return answer;
}

}  // namespace

bool Answer::value_holds() const {
  if (!right) return true;
  return is && std::abs(*is - *right) <= tolerance;
}

Result<std::vector<Answer>> ask(KnownBone& bone, const KnownLine& line, Progress& progress) {
  const auto work = read_work(line.shapes, bone.places());
  if (!work) return error(fmt::format("the known bone \"{}\": {}", line.name, work.error().text));
  std::vector<std::string> items;
  for (const Right& right : line.right) items.push_back(right.item);
  if (Status cut = bone.cut(*work, progress, items); !cut) return cut.error();
  const KnownScene scene{bone.before(), bone.places(), *work};
  std::vector<Answer> answers;
  for (const Right& right : line.right) {
    const scoring::Outcome* outcome = bone.outcome(right.item);
    if (outcome == nullptr)
      return error(fmt::format(
          "the known bone \"{}\" asks for \"{}\", which is no item that a bone decides; name one",
          line.name, right.item));
    // at the larger voxel size an item may say that it cannot be judged, and why
    if (outcome->reason.find("too coarse") != std::string::npos) continue;
    answers.push_back(answer_of(scene, right, *outcome));
  }
  return answers;
}

std::vector<std::string> one_sided(const scoring::Rubric& rubric, const KnownTable& table,
                                   const std::vector<Answer>& answers) {
  std::vector<std::string> found;
  for (const scoring::Item& item : rubric.items) {
    if (std::any_of(table.left_out.begin(), table.left_out.end(),
                    [&](const LeftOut& one) { return one.item == item.id; }))
      continue;
    const auto seen = [&](scoring::Verdict as) {
      return std::any_of(answers.begin(), answers.end(),
                         [&](const Answer& one) { return one.item == item.id && one.must == as; });
    };
    if (!seen(kMet) || !seen(kUnmet)) found.push_back(item.id);
  }
  return found;
}

}  // namespace burr::proof
