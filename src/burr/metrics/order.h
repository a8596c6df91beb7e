// metrics/order.h - were the steps done in the case's order.
//
//     inversions   pairs of done steps of which the later one of the case was done first
//     tau          Kendall's rank correlation: 1 - 4 inversions / (n (n - 1)); 1: in order, -1: reversed
//
// A step counts at the moment when it was first declared done; that it was reopened is counted
// apart. Thread: any.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace burr::metrics {

enum class StepEvent { begun, done, reopened };

struct StepMark {
  double t = 0;  // [s]; in order
  std::string step;
  StepEvent event = StepEvent::done;
};

struct Order {
  std::size_t done = 0;  // steps of the case that were done
  std::size_t reopened = 0;
  std::vector<std::string> skipped;  // never done, in the case's order
  std::vector<std::pair<std::string, std::string>>
      inversions;             // done first, should have waited for
  std::optional<double> tau;  // none: fewer than two done
};

// steps: those of the case in order. Steps that the case does not have are ignored.
[[nodiscard]] Order order_of(std::span<const StepMark> marks, std::span<const std::string> steps);

}  // namespace burr::metrics
