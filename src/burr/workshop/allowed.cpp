#include "burr/workshop/allowed.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/scenario/fade.h"

namespace burr::workshop {
namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();
constexpr double kClose = 1e-3;  // [m]

constexpr Allowed kFree = {.steps = Offer::on_demand,
                           .target = true,
                           .distance = true,
                           .tone_below = kEverywhere,
                           .injury = Injury::sound,
                           .technique = false,
                           .back = true,
                           .measure = true,
                           .colours = true,
                           .see_through = true,
                           .marks = true};
constexpr Allowed kLearn = {.steps = Offer::always,
                            .target = true,
                            .distance = true,
                            .tone_below = kEverywhere,
                            .injury = Injury::stop,
                            .technique = true,
                            .back = true,
                            .measure = true,
                            .colours = true,
                            .see_through = true,
                            .marks = true};
constexpr Allowed kPractise = {.steps = Offer::on_demand,
                               .target = true,
                               .distance = false,
                               .tone_below = kClose,
                               .injury = Injury::sound,
                               .technique = false,
                               .back = true,
                               .measure = true,
                               .colours = true,
                               .see_through = true,
                               .marks = true};
constexpr Allowed kExam = {};

bool names(const std::vector<std::string>& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

Allowed narrowed(Allowed all, const std::optional<std::vector<std::string>>& list) {
  if (!list) return all;
  if (!names(*list, "step")) all.steps = Offer::never;
  all.target = all.target && names(*list, "target");
  all.distance = all.distance && names(*list, "distance");
  if (!names(*list, "tone")) all.tone_below = 0;
  all.technique = all.technique && names(*list, "technique");
  all.back = all.back && names(*list, "undo");
  all.colours = all.colours && names(*list, "colours");
  all.see_through = all.see_through && names(*list, "see-through");
  return all;
}

}  // namespace

Allowed allowed_in(record::Mode mode, const scenario::Feedback& feedback, bool is_guided) {
  Allowed all = kFree;
  switch (mode) {
    case record::Mode::free:
      return all;
    case record::Mode::learn:
      all = narrowed(kLearn, feedback.learn);
      break;
    case record::Mode::practise:
      all = narrowed(kPractise, feedback.practise);
      break;
    case record::Mode::exam:
      all = kExam;
      all.colours = feedback.exam && names(*feedback.exam, "colours");
      all.see_through = feedback.exam && names(*feedback.exam, "see-through");
      return all;
  }
  if (is_guided) return all;
  all.target = all.distance = all.technique = false;
  all.tone_below = 0;
  return all;
}

bool guided_in(const record::Identity& identity, const scenario::Feedback& feedback) {
  const auto fade = scenario::fade_of(feedback.fade);
  return !fade || scenario::guided(*fade, identity.attempt);
}

}  // namespace burr::workshop
