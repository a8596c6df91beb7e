// haptics/six/held_rows.h - the rows in hand of a programme in twelve unknowns, those of two tools (two_tools.h): one is
// taken, and those that no longer press are dropped. As in least_twist.cpp, with twelve unknowns. For use of this room only.
//
// Thread: servo. Units: rows as in two_tools.h, gaps in voxels.
#pragma once

#include <array>

#include "burr/rt/rt.h"

namespace burr::haptics::twelve {

inline constexpr int kMost = 12;            // rows in hand
inline constexpr double kTolerance = 2e-6;  // as in least_twist.cpp [voxel]
inline constexpr double kExact = 1e-11;     // the same for a pair, whose row is in doubles [voxel]

using Twelve = std::array<double, 12>;

// Whose row, and which.
struct Name {
  int whose = -1, index = -1;  // 0 a's bone, 1 b's bone, 2 a pair
  bool operator==(const Name&) const = default;
};

struct Held {  // the rows in hand
  Twelve row[kMost];
  double push[kMost] = {};
  Name name[kMost];
  int count = 0;
};

// Takes the row a . y >= -gap into hand and moves y until it holds. False: it cannot hold with the others.
[[nodiscard]] bool take(Held& held, Twelve& y, const Twelve& a, double gap,
                        const Name& name) BURR_RT;

}  // namespace burr::haptics::twelve
