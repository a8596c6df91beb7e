// sim/path_check.h - what is probably wrong with the path of a hand, for the tool that this session gave
// it: a ball, a tool of any shape, in the first hand or in the second. Where the tool stands is asked of
// the touch itself, and whether anything was touched, of the outcome.
//
// Frame: world (LPS). Units: SI. Thread: any, while the session stands still.
#pragma once

#include <string>
#include <vector>

#include "burr/device/hand_path.h"
#include "burr/sim/session.h"

namespace burr::sim {

struct FollowedPath {
  device::HandPath path;
  std::string name;     // of its file, as it is to be shown
  bool second = false;  // the second hand follows it
};

// Sentences for the user, each with its remedy; empty: nothing is doubted.
// Before the first tick: the path stays so far away that it must be in other units; or the tool is inside
// bone at the first point: then nothing is felt or cut until it has been in free air, by the rule of
// tick/hand.h.
[[nodiscard]] std::vector<std::string> doubts_before(Session& session,
                                                     const FollowedPath& followed);
// After the last: nothing was touched, and how far from the bone the path stays.
[[nodiscard]] std::vector<std::string> doubts_after(Session& session, const FollowedPath& followed);

}  // namespace burr::sim
