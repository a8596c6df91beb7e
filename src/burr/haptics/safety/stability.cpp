#include "burr/haptics/safety/stability.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "burr/math/elementary.h"

namespace burr::haptics {
namespace {

struct Motion {
  double place = 0, velocity = 0;
};

// Exact motion of a mass with viscous drag under a constant force.
Motion glide(const Motion& from, double force, double mass, double drag, double time) {
  if (drag * time < 1e-9 * mass) {
    const double a = force / mass;
    return {from.place + from.velocity * time + 0.5 * a * time * time, from.velocity + a * time};
  }
  const double final_speed = force / drag;
  const double faded = -math::exponential_minus_one(-drag * time / mass);
  const double excess = from.velocity - final_speed;
  return {from.place + final_speed * time + excess * faded * mass / drag,
          from.velocity - excess * faded};
}

class Axis {
 public:
  Axis(const AxisSettings& settings, const Motion& start)
      : settings_(settings),
        mass_(settings.mass + settings.arm_mass),
        drag_(settings.damping + settings.arm_damping),
        now_(start) {}

  [[nodiscard]] double place() const { return now_.place; }

  void advance(double motor, double time) {
    // the arm's spring at the middle of the step, which keeps second-order accuracy
    const double middle = now_.place + 0.5 * time * now_.velocity;
    const double force = motor - settings_.push - settings_.arm_stiffness * middle;
    const double dry = settings_.dry_friction;
    if (dry <= 0) {
      now_ = glide(now_, force, mass_, drag_, time);
    } else if (now_.velocity == 0) {
      if (std::abs(force) <= dry) return;  // it sticks
      now_ = glide(now_, force - std::copysign(dry, force), mass_, drag_, time);
    } else {
      const Motion next =
          glide(now_, force - std::copysign(dry, now_.velocity), mass_, drag_, time);
      if (next.velocity * now_.velocity > 0) {
        now_ = next;
      } else {  // friction stops a motion, it never reverses it
        const double share = now_.velocity / (now_.velocity - next.velocity);
        now_ = {now_.place + 0.5 * now_.velocity * share * time, 0};
      }
    }
  }

 private:
  AxisSettings settings_;
  double mass_, drag_;
  Motion now_;
};

class Sensor {
 public:
  Sensor(const AxisSettings& axis, double place)
      : step_(axis.encoder_step),
        dt_(1 / axis.rate_hz),
        blend_(axis.velocity_filter_hz > 0
                   ? 1 - math::exponential(-2 * std::numbers::pi * axis.velocity_filter_hz * dt_)
                   : 1.0),
        last_(counted(place)) {}

  Sensed read(double place) {
    const double now = counted(place);
    velocity_ += blend_ * ((now - last_) / dt_ - velocity_);
    last_ = now;
    return {now, velocity_, dt_};
  }

 private:
  [[nodiscard]] double counted(double place) const {
    return step_ > 0 ? step_ * std::floor(place / step_) : place;
  }
  double step_, dt_, blend_, last_, velocity_ = 0;
};

// Highest minus lowest.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double width() const { return high > low ? high - low : 0; }
};

double wall_force(const WallSettings& wall, const Sensed& hand) {
  if (!wall.one_sided) return -wall.stiffness * hand.place - wall.damping * hand.velocity;
  if (hand.place >= 0) return 0;
  const double spring = -wall.stiffness * hand.place;
  return spring + std::min(spring, wall.damping * std::max(0.0, -hand.velocity));
}

}  // namespace

Controller wall(const WallSettings& settings) {
  return [settings](const Sensed& hand) { return wall_force(settings, hand); };
}

Controller guarded_wall(const WallSettings& settings, const EnergyGuardSettings& guard,
                        std::function<void(const EnergyGuard&)> watched) {
  const auto kept = std::make_shared<EnergyGuard>(guard);
  return [settings, kept, watched = std::move(watched)](const Sensed& hand) {
    SpringState now;
    now.hand.x() = hand.place;
    now.stretch.x() = settings.one_sided && hand.place >= 0 ? 0 : -hand.place;
    now.stiffness = settings.stiffness;
    now.force.x() = wall_force(settings, hand);
    const math::Vec3 force = kept->step(now, hand.dt);
    kept->sent(force);
    if (watched) watched(*kept);
    return force.x();
  };
}

Swung swing(const AxisSettings& axis, const Controller& controller, const Swing& how) {
  const double dt = 1 / axis.rate_hz;
  const double time = dt / axis.substeps;
  const long ticks = std::lround(how.duration * axis.rate_hz);
  Axis hand(axis, {how.start, how.speed});
  Sensor sensor(axis, how.start);
  std::deque<double> on_the_way(static_cast<std::size_t>(std::lround(axis.delay / time)), 0.0);

  Swung found;
  Range early, late;
  for (long tick = 0; tick < ticks; ++tick) {
    const double force = controller(sensor.read(hand.place()));
    found.largest_force = std::max(found.largest_force, std::abs(force));
    for (int i = 0; i < axis.substeps; ++i) {
      on_the_way.push_back(force);
      const double motor = on_the_way.front();
      on_the_way.pop_front();
      const double before = hand.place();
      hand.advance(motor, time);
      found.top_speed = std::max(found.top_speed, std::abs(hand.place() - before) / time);
      found.work_in -= motor * (hand.place() - before);
      found.least_work_in = std::min(found.least_work_in, found.work_in);
      found.lowest = std::min(found.lowest, hand.place());
      if (4 * tick >= 3 * ticks) {
        late.add(hand.place());
      } else if (4 * tick >= ticks && 2 * tick < ticks) {
        early.add(hand.place());
      }
    }
    if (!(std::abs(hand.place()) < how.too_far)) {
      found.ran_away = true;
      break;
    }
  }
  found.early = early.width();
  found.late = late.width();
  return found;
}

double stiffness_border(const AxisSettings& axis, const std::function<Controller(double)>& make,
                        double low, double high, const Swing& how) {
  const double quiet = std::max(1e-9, 2 * axis.encoder_step);
  const auto stable = [&](double stiffness) {
    return swing(axis, make(stiffness), how).stable(quiet);
  };
  if (!stable(low)) return low;
  if (stable(high)) return high;
  while (high - low > 1e-3 * low) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace burr::haptics
