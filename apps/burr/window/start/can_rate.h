// apps/burr/window/start/can_rate.h - whether the start page offers to mark products. Thread: main.
#pragma once

#include "window/ui/desk.h"

namespace burr::app {

// True: there is a store whose products somebody may mark.
[[nodiscard]] bool can_rate(const Desk& desk);

}  // namespace burr::app
