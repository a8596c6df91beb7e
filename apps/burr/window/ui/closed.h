// apps/burr/window/ui/closed.h - how the user left a page.
#pragma once

namespace burr::app {

enum class Closed {
  page,    // the user left this bone
  done,    // the user declared the work done, and this ended it
  again,   // the user wants to do the case again
  window,  // the user left burr, or the time is over
};

}  // namespace burr::app
