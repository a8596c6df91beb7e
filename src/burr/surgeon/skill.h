// surgeon/skill.h - how well a scripted surgeon works: perception, hand, judgement.
//
// Three levels differ in what they believe about the structures, in their hands and in when they
// stop. Speed and the longest time are the same for all, so time alone does not tell them apart.
// Where each number is from: docs/understand/surgeon.md. None was fitted to a score.
// Units: SI. Thread: any; plain structs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace burr::surgeon {

enum class Level { expert, average, careless };
[[nodiscard]] const char* word_of(Level level);
[[nodiscard]] std::optional<Level> level_of(std::string_view word);
[[nodiscard]] std::vector<std::string> level_words();

// Diameters are shares of the case's own burr, so that one table serves a tooth and a mastoid.
struct BurrPolicy {
  double far = 1.2, middle = 1.0, near = 0.6;  // beyond 6, 3.5 and below 3.5 mm of what is spared
  double smallest = 0.2;                       // taken where a larger one does not fit
  double diamond_below = 1.5e-3;               // this near a diamond burr is taken; 0: never [m]
  bool heeds_step = true;                      // takes the tool that the step of the case names
};

// The preset values are those of an expert.
struct Skill {
  double perception = 0.25e-3;  // rms error of where a structure is believed to be, per axis [m]
  double margin_less = 0;       // less bone left over a structure than planned              [m]
  double tremor = 0.05e-3;      // rms per axis                                              [m]
  double drift = 0.1e-3;        // rms per axis                                              [m]
  double force = 1.2;           // far from what is spared                                   [N]
  double force_noise = 0.15;    // rms of the force over its mean                            [-]
  double restraint = 0.35;      // force beside what is spared over that far from it         [-]
  double stop_delay = 0.1;      // from the end of the plan to lifting the burr              [s]
  double stroke = 7e-3;         // median length                                             [m]
  double along = 0.9;           // probability of a stroke along the structure               [-]
  double clear_view = 0.95;     // probability of turning to a clear line of sight           [-]
  double unfinished = 0.03;     // stops at this share of the plan                           [-]
  double saucer = 1;            // 1: widest first, -1: deepest first ("keyhole")            [-]
  double speed = 15e-3;         // along a stroke                                            [m/s]
  BurrPolicy burrs;
};

[[nodiscard]] Skill skill_of(Level level);

// Each number of the table times a lognormal factor of 20 %; shares stay below 1, the order of work
// and the burrs as they are. The same seed gives the same factors for every level.
[[nodiscard]] Skill drawn(Skill mean, std::uint64_t seed);

// Names for set_vice(), with the unit in the name: "perception_mm".
[[nodiscard]] std::vector<std::string> vice_names();
// Sets one number, given in the unit of its name. Error: unknown name or impossible value.
[[nodiscard]] Status set_vice(Skill& skill, std::string_view vice, double value);

}  // namespace burr::surgeon
