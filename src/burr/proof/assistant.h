// proof/assistant.h - what a scripted surgeon does beside the hand's movements: takes other burrs, turns
// the coolant on, looks, and says which step begins, into the session and its recording.
//
//     Assistant assistant(*surgeon, session, &diary);
//     session.set_between_ticks([&] { assistant.work(); }, surgeon::kConsultTicks);
//
// Thread: that of the ticks.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/record/diary.h"
#include "burr/record/view.h"
#include "burr/sim/session.h"
#include "burr/surgeon/surgeon.h"

namespace burr::proof {

struct StepDone {
  std::string step;  // its id
  double from_s = 0;
  std::optional<double> to_s;  // none: it was not done
  double left = 0;             // share of its plan
};

class Assistant {
 public:
  // All are kept by reference. diary: nullptr where nothing is recorded.
  Assistant(surgeon::Surgeon& surgeon, sim::Session& session, record::Diary* diary)
      : surgeon_(surgeon), session_(session), diary_(diary) {}

  // Before a tick.
  void work();

  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] const std::vector<StepDone>& steps() const { return steps_; }

 private:
  void tell(const surgeon::SurgeonNote& note, std::uint64_t tick);

  surgeon::Surgeon& surgeon_;
  sim::Session& session_;
  record::Diary* diary_;
  bool done_ = false;
  std::vector<StepDone> steps_;
};

}  // namespace burr::proof
