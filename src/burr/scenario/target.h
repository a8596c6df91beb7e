// scenario/target.h - what a case wants done to a tissue.
//
// Thread: any.
#pragma once

#include <string>

namespace burr::scenario {

// The task for a tissue.
enum class Goal {
  open,    // reach it: remove the bone in front of it
  expose,  // uncover it without touching it
  remove,  // remove it
};

struct Target {
  std::string tissue;
  Goal goal = Goal::open;
  double share = 1;  // required share, 0..1
};

}  // namespace burr::scenario
