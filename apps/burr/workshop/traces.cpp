#include "workshop/traces.h"

#include <algorithm>
#include <cmath>

#include "workshop/still.h"

namespace burr::app {
namespace {

constexpr double kAgo = 60;           // what is older hardly shows                         [s]
constexpr double kFar = 3;            // ahead: so much at once is told in larger steps     [s]
constexpr std::uint64_t kEvery = 16;  // ticks: about as often as a window looks
constexpr std::uint64_t kEveryOfMany = 128;  // ... and still within what a Wound follows

}  // namespace

Traces::Traces(record::Player& player, const tick::ServoSettings& settings)
    : player_(player),
      settings_(settings),
      steps_(player.steps()),
      radius_(settings.burr.radius),
      irrigated_(settings.irrigated) {}

double Traces::time_of(const tick::TickRow& row) const {
  return static_cast<double>(row.tick - player_.first_tick()) / player_.info().rate_hz;
}

void Traces::begin(double t, const record::Timeline& timeline) {
  const auto ticks = static_cast<std::uint64_t>(std::max(0.0, t) * player_.info().rate_hz);
  steps_ = player_.steps(player_.first_tick() + ticks);
  ahead_ = false;
  radius_ = timeline.wished(tick::WishKind::burr_radius, t).value_or(settings_.burr.radius);
  if (!(radius_ > 0)) radius_ = settings_.burr.radius;
  irrigated_ = timeline.wished(tick::WishKind::irrigation, t).value_or(settings_.irrigated) > 0;
}

Traces::Told Traces::until(double t) {
  Told told;
  tell(t, kEvery, told);
  return told;
}

Traces::Told Traces::until(double t, const record::Timeline& timeline) {
  Told told;
  told.anew = t < asked_ || t > asked_ + kFar;
  if (told.anew) begin(t - kAgo, timeline);
  tell(t, told.anew ? kEveryOfMany : kEvery, told);
  return told;
}

void Traces::tell(double t, std::uint64_t every, Told& told) {
  asked_ = t;
  for (;;) {
    if (!ahead_ && !steps_.next(step_)) return;
    ahead_ = time_of(step_.row) > t;
    if (ahead_) return;
    for (const tick::Wish& wish : step_.wishes)
      if (wish.kind == tick::WishKind::irrigation)
        irrigated_ = wish.value > 0;
      else if (wish.kind == tick::WishKind::burr_radius && wish.value > 0)
        radius_ = wish.value;
    if (step_.row.tick % every == 0)
      told.ticks.push_back(wound_tick(step_.row, player_.info().rate_hz, radius_, irrigated_));
  }
}

void Traces::Told::show(render::Wound& wound) const {
  if (anew) wound.forget();
  for (const render::Wound::Tick& tick : ticks) wound.see(tick);
}

}  // namespace burr::app
