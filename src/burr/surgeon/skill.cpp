#include "burr/surgeon/skill.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "burr/base/printable.h"
#include "burr/people/random_stream.h"

namespace burr::surgeon {
namespace {

constexpr double kSpread = 0.2;            // of a run about its level's value
constexpr std::uint64_t kSkillStream = 1;  // of random numbers

struct Vice {
  const char* name;
  double unit;  // SI per unit of the name
  double least, most;
  double& (*number)(Skill&);
};

constexpr std::array kVices = {
    Vice{"perception_mm", 1e-3, 0, 20, [](Skill& s) -> double& { return s.perception; }},
    Vice{"margin_less_mm", 1e-3, -5, 5, [](Skill& s) -> double& { return s.margin_less; }},
    Vice{"tremor_mm", 1e-3, 0, 5, [](Skill& s) -> double& { return s.tremor; }},
    Vice{"drift_mm", 1e-3, 0, 5, [](Skill& s) -> double& { return s.drift; }},
    Vice{"force_N", 1, 0.05, 10, [](Skill& s) -> double& { return s.force; }},
    Vice{"force_noise", 1, 0, 2, [](Skill& s) -> double& { return s.force_noise; }},
    Vice{"restraint", 1, 0.01, 2, [](Skill& s) -> double& { return s.restraint; }},
    Vice{"stop_s", 1, 0, 1, [](Skill& s) -> double& { return s.stop_delay; }},
    Vice{"stroke_mm", 1e-3, 0.5, 30, [](Skill& s) -> double& { return s.stroke; }},
    Vice{"along", 1, 0, 1, [](Skill& s) -> double& { return s.along; }},
    Vice{"view", 1, 0, 1, [](Skill& s) -> double& { return s.clear_view; }},
    Vice{"unfinished", 1, 0, 1, [](Skill& s) -> double& { return s.unfinished; }},
    Vice{"saucer", 1, -3, 3, [](Skill& s) -> double& { return s.saucer; }},
    Vice{"speed_mm_s", 1e-3, 1, 100, [](Skill& s) -> double& { return s.speed; }},
    Vice{"burr_far", 1, 0.1, 3, [](Skill& s) -> double& { return s.burrs.far; }},
    Vice{"burr_middle", 1, 0.1, 3, [](Skill& s) -> double& { return s.burrs.middle; }},
    Vice{"burr_near", 1, 0.1, 3, [](Skill& s) -> double& { return s.burrs.near; }},
    Vice{"diamond_mm", 1e-3, 0, 20, [](Skill& s) -> double& { return s.burrs.diamond_below; }},
};

}  // namespace

const char* word_of(Level level) {
  switch (level) {
    case Level::expert:
      return "expert";
    case Level::average:
      return "average";
    case Level::careless:
      return "careless";
  }
  return "";
}

std::optional<Level> level_of(std::string_view word) {
  for (const Level one : {Level::expert, Level::average, Level::careless})
    if (word == word_of(one)) return one;
  return std::nullopt;
}

std::vector<std::string> level_words() {
  return {word_of(Level::expert), word_of(Level::average), word_of(Level::careless)};
}

Skill skill_of(Level level) {
  Skill skill;
  if (level == Level::average) {
    skill.perception = 0.45e-3;
    skill.tremor = 0.12e-3;
    skill.drift = 0.25e-3;
    skill.force = 1.0;
    skill.force_noise = 0.3;
    skill.restraint = 0.7;
    skill.stop_delay = 0.2;
    skill.stroke = 5e-3;
    skill.along = 0.6;
    skill.clear_view = 0.8;
    skill.unfinished = 0.1;
    skill.burrs = {1.0, 0.8, 0.8, 0.4, 0.7e-3, true};
  }
  if (level == Level::careless) {
    skill.perception = 1.5e-3;
    skill.margin_less = 0.5e-3;
    skill.tremor = 0.25e-3;
    skill.drift = 0.5e-3;
    skill.force = 1.6;
    skill.force_noise = 0.5;
    skill.restraint = 1.0;
    skill.stop_delay = 0.45;
    skill.stroke = 3e-3;
    skill.along = 0.3;
    skill.clear_view = 0.5;
    skill.unfinished = 0.25;
    skill.burrs = {0.8, 0.8, 0.8, 0.8, 0, false};
  }
  return skill;
}

Skill drawn(Skill mean, std::uint64_t seed) {
  people::RandomStream random(seed, kSkillStream);
  for (double* number :
       {&mean.perception, &mean.margin_less, &mean.tremor, &mean.drift, &mean.force,
        &mean.force_noise, &mean.restraint, &mean.stop_delay, &mean.stroke, &mean.along,
        &mean.clear_view, &mean.unfinished, &mean.speed, &mean.burrs.diamond_below})
    *number *= std::exp(kSpread * random.normal());
  for (double* share : {&mean.along, &mean.clear_view, &mean.unfinished})
    *share = std::min(*share, 1.0);
  mean.stop_delay = std::min(mean.stop_delay, 1.0);
  return mean;
}

std::vector<std::string> vice_names() {
  std::vector<std::string> names;
  for (const Vice& one : kVices) names.emplace_back(one.name);
  return names;
}

Status set_vice(Skill& skill, std::string_view vice, double value) {
  const auto* found = std::find_if(kVices.begin(), kVices.end(),
                                   [vice](const Vice& one) { return one.name == vice; });
  if (found == kVices.end())
    return error(Trouble::usage,
                 fmt::format("`vice` {}: there is no such number; use one of {}",
                             base::printable(std::string(vice)), fmt::join(vice_names(), ", ")));
  if (!(value >= found->least && value <= found->most))
    return error(Trouble::usage, fmt::format("`vice` {}={}: is out of range; use {} to {}", vice,
                                             value, found->least, found->most));
  found->number(skill) = value * found->unit;
  return fine();
}

}  // namespace burr::surgeon
