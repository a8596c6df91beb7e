// apps/burr/window/mill/step_follower.h - view, tool, burr and depth of the press follow the steps of the case.
//
// A step begins: where its work lies is found on a thread of its own (guidance/step_watch.h). Once that is
// known and nothing is pressed, the depth of the press is set; and in a mode that shows the steps, or where the user uses
// them, the tool that suits is taken, and the view looks at the place from the step's direction.
// Thread: main. Units: m.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include "window/mill/mill_case.h"
#include "window/mill/mill_hand.h"
#include "window/mill/mill_site.h"
#include "window/mill/mill_tools.h"
#include "window/mill/mill_view.h"

namespace burr::app {

class StepFollower {
 public:
  StepFollower(const MillSite& site, MillCase& work_case, MillView& view, MillTools& tools,
               MillHand& hand);

  void begin();  // before the session starts
  void look();   // in each picture

 private:
  void ask();
  void follow(const guidance::StepWatch::Seen& seen);

  Desk& desk_;
  const render::Scene& scene_;
  const mouse::Hands& hands_;
  const WindowOptions& options_;
  const tick::TickRow& row_;
  MillCase& case_;
  MillView& view_;
  MillTools& tools_;
  MillHand& hand_;
  int turns_ = 0;  // MillCase::turns() when the target was last asked for
  std::optional<std::pair<std::size_t, bool>>
      set_;  // the step that press and tool were set for, and whether it was followed
  std::optional<guidance::StepWatch::Seen> waiting_;  // until the hand lets go
};

}  // namespace burr::app
