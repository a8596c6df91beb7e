// tool/limits.h - what a session takes of tools, at the most.
#pragma once

#include <cstddef>

namespace burr::tool {

inline constexpr std::size_t kMostTools = 64;   // in the list of a session
inline constexpr double kFastestRpm = 500'000;  // of a burr; turbines reach this  [1/min]

}  // namespace burr::tool
