// apps/burr/verify/law_trial.h - tries a compiled custom law (tick/law_v1.h): with numbers that are none, with random
// inputs, twice with the same, by the clock, and in closed loops with a simulated hand.
//
// The law runs in the process of the caller: call it in one of its own (doctor/run_in_process.h).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>

#include "burr/base/result.h"

namespace burr::app {

struct LawTrial {
  std::string file, settings;  // of the law
  std::uint64_t seed = 0;
};

// What it is doing, for the case that it does not come back.
inline constexpr std::array<const char*, 6> kLawStages = {
    "it was loaded",         "it got numbers that are none",
    "it got random inputs",  "it got the same inputs twice",
    "its time was measured", "a simulated hand pressed with it"};
using LawStage = std::atomic<int>;

// A JSON object (verify_law.cpp reads it), or {"error": sentence}.
[[nodiscard]] std::string try_law(const LawTrial& trial, LawStage& stage);

}  // namespace burr::app
