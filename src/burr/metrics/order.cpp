#include "burr/metrics/order.h"

#include <algorithm>

namespace burr::metrics {

Order order_of(std::span<const StepMark> marks, std::span<const std::string> steps) {
  Order out;
  std::vector<std::size_t> done;  // places in `steps`, in the order in which they were done
  for (const StepMark& mark : marks) {
    const auto found = std::find(steps.begin(), steps.end(), mark.step);
    if (found == steps.end()) continue;
    const auto place = static_cast<std::size_t>(found - steps.begin());
    if (mark.event == StepEvent::reopened) ++out.reopened;
    if (mark.event == StepEvent::done && std::find(done.begin(), done.end(), place) == done.end())
      done.push_back(place);
  }
  out.done = done.size();
  for (std::size_t n = 0; n < steps.size(); ++n)
    if (std::find(done.begin(), done.end(), n) == done.end()) out.skipped.push_back(steps[n]);
  for (std::size_t a = 0; a < done.size(); ++a)
    for (std::size_t b = a + 1; b < done.size(); ++b)
      if (done[a] > done[b]) out.inversions.emplace_back(steps[done[a]], steps[done[b]]);
  const auto n = static_cast<double>(done.size());
  if (done.size() >= 2)
    out.tau = 1 - 4 * static_cast<double>(out.inversions.size()) / (n * (n - 1));
  return out;
}

}  // namespace burr::metrics
