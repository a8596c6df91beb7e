#include "devices/trial.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include "burr/haptics/safety/limit.h"
#include "burr/rt/latest.h"
#include "burr/rt/stats.h"
#include "burr/rt/thread.h"

namespace burr::app {
namespace {

using math::Vec3;
using Clock = std::chrono::steady_clock;

constexpr double kStill = 0.02;      // slower than this counts as rest [m/s]
constexpr double kTrialRate = 1000;  // [Hz]

// What the ticks report to the caller.
struct TrialSample {
  device::HandState hand;
  Vec3 force = Vec3::Zero();
  std::uint64_t tick = 0;
};

// What the caller requests of the ticks.
struct Wanted {
  bool wall = false;
  double height = 0;  // of the wall, along y [m]
};

// The ticks: the hand, a wall or none, the safety layer, the force.
class Ticks {
 public:
  Ticks(device::Device& device, const TrialSettings& settings)
      : device_(device), limit_(device.spec(), {.user_force = settings.most_force}) {
    stiffness_ = std::min(settings.stiffness, device.spec().max_stiffness);
    thread_ = std::make_unique<rt::Thread>(rt::ThreadRequest{.name = "servo", .realtime = true},
                                           [this] { run(); });
  }
  ~Ticks() { end(); }
  Ticks(const Ticks&) = delete;
  Ticks& operator=(const Ticks&) = delete;

  void end() {
    stop_ = true;
    thread_->join();
  }
  void want(const Wanted& wanted) { wanted_.publish(wanted); }
  bool now(TrialSample& sample) { return samples_.take(sample); }
  [[nodiscard]] double stiffness() const { return stiffness_; }

  // after end()
  rt::Durations intervals, answers;
  std::uint64_t ticks = 0, missed = 0, invalid = 0;

 private:
  void run() {
    rt::WallClock wall(kTrialRate);
    rt::TickClock* own = device_.clock(kTrialRate);
    rt::TickClock& clock = own != nullptr ? *own : wall;
    Wanted wanted;
    Vec3 force = Vec3::Zero();
    TrialSample sample;
    while (!stop_.load(std::memory_order_relaxed)) {
      const rt::TickTime time = clock.wait();
      static_cast<void>(wanted_.take(wanted));
      sample.hand = device_.state(1 / kTrialRate);
      std::uint32_t flags = 0;
      const bool usable = limit_.accept_reading(sample.hand, flags);
      Vec3 push = Vec3::Zero();
      if (usable && wanted.wall)
        push.y() = stiffness_ * std::max(0.0, wanted.height - sample.hand.world_from_tool.p.y());
      force = limit_.apply(push, 1 / kTrialRate, flags);
      device_.write_force(force);
      if (const std::int64_t arrived = device_.arrived_ns(); arrived > 0 && sample.hand.valid)
        answers.add(rt::monotonic_ns() - arrived);
      if (ticks > 0) intervals.add(time.since_last_ns);
      ++ticks;
      missed += static_cast<std::uint64_t>(time.missed);
      if (!sample.hand.valid) ++invalid;
      sample.force = force;
      sample.tick = ticks;
      samples_.publish(sample);
    }
    for (int n = 4; n >= 0; --n) {  // a fade, not a sudden drop
      static_cast<void>(clock.wait());
      device_.write_force(0.2 * n * force);
    }
  }

  device::Device& device_;
  haptics::ForceLimit limit_;
  double stiffness_ = 0;
  rt::Latest<Wanted> wanted_;
  rt::Latest<TrialSample> samples_;
  std::atomic<bool> stop_ = false;
  std::unique_ptr<rt::Thread> thread_;
};

// Reads the reports of the ticks until `done` is true. False: the time was over, or the user
// stopped.
template <class Done>
bool watch(Ticks& ticks, double longest_s, const std::function<bool()>& stop, Done done) {
  const auto until = Clock::now() + std::chrono::duration<double>(longest_s);
  TrialSample sample;
  while (Clock::now() < until && !stop()) {
    if (!ticks.now(sample)) {
      std::this_thread::sleep_for(std::chrono::microseconds(300));
      continue;
    }
    if (sample.hand.valid && done(sample)) return true;
  }
  return false;
}

void at_rest(Ticks& ticks, const TrialSettings& settings, const std::function<bool()>& stop,
             TrialMeasurements& seen) {
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero(), first = Vec3::Zero();
  double speeds = 0;
  double n = 0;
  std::uint64_t begin = 0, end = 0;
  const auto began = Clock::now();
  Clock::time_point last = began;
  static_cast<void>(watch(ticks, settings.rest_s, stop, [&](const TrialSample& sample) {
    if (n == 0) {
      first = sample.hand.world_from_tool.p;
      begin = sample.tick;
    }
    const Vec3 at = sample.hand.world_from_tool.p - first;
    sum += at;
    squares += at.cwiseAbs2();
    speeds += sample.hand.velocity.squaredNorm();
    ++n;
    end = sample.tick;
    last = Clock::now();
    return false;
  }));
  if (n < 2) {
    seen.left_out.emplace_back("at rest: the device sent no position");
    return;
  }
  const Vec3 mean = sum / n;
  seen.noise = (squares / n - mean.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  seen.speed_noise = std::sqrt(speeds / n);
  seen.rate_hz = static_cast<double>(end - begin) /
                 std::max(1e-9, std::chrono::duration<double>(last - began).count());
}

void along(Ticks& ticks, const TrialSettings& settings, const Vec3& way,
           const std::function<bool()>& stop, AxisMeasurement& seen) {
  bool has_start = false;
  Vec3 start = Vec3::Zero();
  seen.done = watch(ticks, settings.longest_s, stop, [&](const TrialSample& sample) {
    if (!has_start) {
      if (sample.hand.velocity.norm() > kStill) return false;
      start = sample.hand.world_from_tool.p;
      has_start = true;
    }
    seen.went = sample.hand.world_from_tool.p - start;
    return seen.went.norm() >= settings.way;
  });
  const double cosine = seen.went.norm() > 0 ? seen.went.normalized().dot(way) : -1;
  seen.off_deg = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / M_PI;
}

void wall(Ticks& ticks, const TrialSettings& settings, const std::function<bool()>& stop,
          TrialMeasurements& seen) {
  double height = 0;
  if (!watch(ticks, settings.longest_s, stop, [&](const TrialSample& sample) {
        height = sample.hand.world_from_tool.p.y() - settings.below;
        return sample.hand.velocity.norm() <= kStill;
      })) {
    seen.left_out.emplace_back("the wall: the hand did not stay still");
    return;
  }
  ticks.want({true, height});
  bool inside = false;
  double depth_force = 0, depth_square = 0;
  Vec3 deepest_at = Vec3::Zero();
  double deepest = 0;
  const bool done = watch(ticks, 3 * settings.longest_s, stop, [&](const TrialSample& sample) {
    const double depth = height - sample.hand.world_from_tool.p.y();
    if (depth > 0 && sample.force.y() > 0) {
      // only slow movement, where the force is that of the spring
      if (sample.hand.velocity.norm() < 0.1 && sample.force.norm() < 0.98 * settings.most_force) {
        depth_force += depth * sample.force.y();
        depth_square += depth * depth;
      }
      if (!inside) deepest = 0;
      inside = true;
      if (depth > deepest) {
        deepest = depth;
        deepest_at = sample.hand.world_from_tool.p;
      }
      seen.deepest = std::max(seen.deepest, depth);
      seen.most_force = std::max(seen.most_force, sample.force.norm());
    } else if (inside && depth < -1e-3) {
      inside = false;
      ++seen.presses;
      const Vec3 back = sample.hand.world_from_tool.p - deepest_at;
      seen.aside_deg = std::max(
          seen.aside_deg, std::acos(std::clamp(back.normalized().y(), -1.0, 1.0)) * 180 / M_PI);
    }
    return seen.presses >= settings.presses;
  });
  // the wall stays until the ticks end: a user who stops inside it gets a fade, not a sudden drop
  if (depth_square > 0) seen.stiffness = depth_force / depth_square;
  if (!done) seen.left_out.emplace_back("the wall: it was not pressed and released often enough");
}

}  // namespace

TrialMeasurements try_device(device::Device& device, const TrialSettings& settings,
                             const std::function<void(const std::string&)>& tell,
                             const std::function<bool()>& stop) {
  TrialMeasurements seen;
  seen.spec = device.spec();
  Ticks ticks(device, settings);
  tell("Hold the handle still, or leave it where it rests. The device applies no force.");
  at_rest(ticks, settings, stop, seen);

  const struct {
    const char* name;
    Vec3 way;
    const char* words;
  } axes[] = {{"right", {1, 0, 0}, "Now move it about 3 cm to the right."},
              {"up", {0, 1, 0}, "Now move it about 3 cm up."},
              {"to you", {0, 0, 1}, "Now move it about 3 cm towards you."}};
  for (std::size_t n = 0; n < 3; ++n) {
    seen.axes[n].asked = axes[n].name;
    tell(axes[n].words);
    along(ticks, settings, axes[n].way, stop, seen.axes[n]);
    if (!seen.axes[n].done)
      seen.left_out.push_back(std::string(axes[n].name) + ": the hand did not go there in time");
  }
  tell(
      "Hold it still: a soft wall appears one centimetre below. Then press into it slowly and come "
      "up "
      "again, three times.");
  wall(ticks, settings, stop, seen);
  seen.stopped = stop();
  ticks.end();
  seen.ticks = ticks.ticks;
  seen.missed = ticks.missed;
  seen.invalid = ticks.invalid;
  seen.interval_p50_us = ticks.intervals.quantile_us(0.5);
  seen.interval_p99_us = ticks.intervals.quantile_us(0.99);
  seen.interval_max_us = ticks.intervals.max_us();
  seen.answer_p50_us = ticks.answers.quantile_us(0.5);
  seen.answer_p99_us = ticks.answers.quantile_us(0.99);
  seen.answer_max_us = ticks.answers.max_us();
  return seen;
}

}  // namespace burr::app
