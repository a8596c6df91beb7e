// scoring/step_order.h - were the steps done in an order that the case allows. For use of this room only.
//
// A step that must precede another must also precede what that one must precede. A step counts at the
// moment when it was first declared done. Thread: any.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "burr/metrics/order.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/shown.h"

namespace burr::scoring {

struct StepOrder {
  std::size_t done = 0;   // steps of the case that were declared done
  std::size_t wrong = 0;  // pairs of them, the later one done first
  std::vector<DoneStep> steps;
};

// marks: in the order of time; steps that the case does not have are ignored.
[[nodiscard]] StepOrder step_order(const scenario::CaseLesson& lesson,
                                   std::span<const metrics::StepMark> marks);

}  // namespace burr::scoring
