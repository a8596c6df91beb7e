// tick/recorder_rings.h - where the servo puts what is recorded.
//
// Thread: the servo's pushes; one of the recorder's takes.
#pragma once

#include "burr/rt/ring.h"
#include "burr/tick/rows.h"

namespace burr::tick {

// The recorder's rings (record/recorder.h); nullptr: there is no recorder.
struct RecorderRings {
  rt::Ring<TickRow>* ticks = nullptr;
  rt::Ring<CommandRow>* commands = nullptr;
  rt::Ring<BrickRow>* bricks = nullptr;
  rt::Ring<TickRow>* second = nullptr;  // of the second hand; nullptr: there is none
};

}  // namespace burr::tick
