#include "burr/workshop/traces.h"

#include <algorithm>
#include <cmath>

#include "burr/workshop/second_tool.h"
#include "burr/workshop/work_view.h"

namespace burr::workshop {
namespace {

constexpr double kAgo = 60;           // older traces are hardly visible                    [s]
constexpr double kFar = 3;            // a longer jump ahead is shown in larger steps       [s]
constexpr std::uint64_t kEvery = 16;  // ticks: about once per picture of a window
constexpr std::uint64_t kEveryOfMany = 128;  // ... and still fine enough for a Wound

}  // namespace

Traces::Traces(record::Player& player) : player_(player), steps_(player.steps()) {}

double Traces::time_of(const tick::TickRow& row) const {
  return static_cast<double>(row.tick - player_.first_tick()) / player_.info().rate_hz;
}

void Traces::begin(double t) {
  const auto ticks = static_cast<std::uint64_t>(std::max(0.0, t) * player_.info().rate_hz);
  steps_ = player_.steps(player_.first_tick() + ticks);
  ahead_ = false;
}

Traces::Changes Traces::until(double t) {
  Changes changes;
  collect(t, kEvery, changes);
  return changes;
}

Traces::Changes Traces::seek(double t) {
  Changes changes;
  changes.anew = t < asked_ || t > asked_ + kFar;
  if (changes.anew) begin(t - kAgo);
  collect(t, changes.anew ? kEveryOfMany : kEvery, changes);
  return changes;
}

void Traces::collect(double t, std::uint64_t every, Changes& changes) {
  asked_ = t;
  for (;;) {
    if (!ahead_ && !steps_.next(step_)) return;
    ahead_ = time_of(step_.row) > t;
    if (ahead_) return;
    if (step_.row.tick % every != 0) continue;
    const record::SessionInfo& info = player_.info();
    const bool cuts = step_.second && info.second && !info.second->tools.empty();
    changes.ticks.push_back(
        wound_tick(step_.row, info.rate_hz, info.tools, cuts ? &*step_.second : nullptr));
    if (cuts)
      changes.beside.push_back(
          {changes.ticks.size(), wound_tick(*step_.second, info.rate_hz, info.second->tools)});
    if (step_.second && sucks(*step_.second))
      changes.sucked.push_back({changes.ticks.size(), step_.second->contact.proxy,
                                step_.second->tool.radius,
                                static_cast<double>(every) / player_.info().rate_hz});
  }
}

void Traces::Changes::show(render::Wound& wound) const {
  if (anew) wound.forget();
  std::size_t next = 0, cuts = 0;
  for (std::size_t n = 0; n < ticks.size(); ++n) {
    wound.see(ticks[n]);
    for (; cuts < beside.size() && beside[cuts].after == n + 1; ++cuts)
      wound.see_beside(beside[cuts].tick);
    for (; next < sucked.size() && sucked[next].after == n + 1; ++next)
      wound.suck(sucked[next].mouth, sucked[next].radius, sucked[next].seconds);
  }
}

void Traces::Changes::append(const Changes& later) {
  const std::size_t before = ticks.size();
  ticks.insert(ticks.end(), later.ticks.begin(), later.ticks.end());
  for (Beside one : later.beside) {
    one.after += before;
    beside.push_back(std::move(one));
  }
  for (Suction one : later.sucked) {
    one.after += before;
    sucked.push_back(one);
  }
}

}  // namespace burr::workshop
