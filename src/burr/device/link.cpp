#include "burr/device/link.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <ctime>

#include "burr/base/check.h"

namespace burr::device {
namespace {

using math::Vec3;

constexpr std::uint64_t kTellEvery = 256;       // readings between two accounts
constexpr std::int64_t kMean = 64;              // readings over which their period is averaged
constexpr std::int64_t kLongestNs = 4'000'000;  // longest period that counts: a stall does not

std::int64_t ns(double seconds) { return std::llround(1e9 * seconds); }

}  // namespace

Link::Signal::Signal() { BURR_CHECK(sem_init(&sem_, 0, 0) == 0); }
Link::Signal::~Signal() { sem_destroy(&sem_); }

void Link::Signal::notify() BURR_RT {
  if (!notified_.exchange(true, std::memory_order_acq_rel)) sem_post(&sem_);
}

void Link::Signal::wait_until(std::int64_t until_ns) BURR_RT {
  constexpr std::int64_t kSecond = 1'000'000'000;
  timespec until = {};
  until.tv_sec = until_ns / kSecond;
  until.tv_nsec = until_ns % kSecond;
  while (sem_clockwait(&sem_, CLOCK_MONOTONIC, &until) != 0)
    if (errno != EINTR) return;
  // an exchange, so that the thread sees everything that was written before the ring
  static_cast<void>(notified_.exchange(false, std::memory_order_acq_rel));
}

Link::Link(const LinkSettings& settings, Now clock)
    : now_(clock),
      answer_timeout_ns_(ns(settings.answer_timeout)),
      timeout_ns_(ns(settings.loss_timeout)),
      fade_ns_(ns(settings.fade)) {}

Link::~Link() = default;

// ---- wire

void Link::publish_reading(const HandState& hand, std::int64_t now) BURR_RT {
  readings_.publish({hand, now, ++number_});
  read_.notify();
}

Vec3 Link::exchange(const HandState& hand) BURR_RT {
  const std::int64_t now = now_();
  count_readings(now);
  if (now < begin_ns_.load(std::memory_order_relaxed)) {
    ++stats_.passed_over;
    return push();
  }
  publish_reading(hand, now);
  take_answers(now);
  // no answer comes (not yet, or no longer): waiting would only slow the device down
  if (answered_ns_ == kNever || now - answered_ns_ >= timeout_ns_) return push();
  const std::int64_t answer_timeout = answer_timeout_ns_.load(std::memory_order_relaxed);
  if (answer_timeout <= 0) return push();
  const std::int64_t until = now + answer_timeout;
  while (answer_.number != number_ && now_() < until) {
    answered_.wait_until(until);
    take_answers(now_());
  }
  if (answer_.number != number_) ++stats_.unanswered;
  stats_.answers.add(now_() - now);
  if (++stats_.readings % kTellEvery == 0) newest_stats_.publish(stats_);
  return push();
}

void Link::count_readings(std::int64_t now) BURR_RT {
  if (last_reading_ns_ != kNever) {
    if (now - last_reading_ns_ >= timeout_ns_) release(now);
    const std::int64_t mean = reading_period_ns_.load(std::memory_order_relaxed);
    const std::int64_t since = std::min(now - last_reading_ns_, kLongestNs);
    reading_period_ns_.store(mean + (since - mean) / kMean, std::memory_order_relaxed);
  }
  last_reading_ns_ = now;
}

void Link::take_answers(std::int64_t now) BURR_RT {
  if (answers_.take(answer_)) answered_ns_ = now;
}

void Link::release(std::int64_t now) BURR_RT {
  if (!fading_) {
    fading_ = true;
    faded_since_ns_ = now;
    fading_from_ = pushed_;
  }
  fading_after_ = number_;
  released_.store(true, std::memory_order_release);
}

Vec3 Link::push() BURR_RT {
  const std::int64_t now = now_();
  take_answers(now);
  if (!fading_ && !pushed_.none() && now - answered_ns_ >= timeout_ns_) release(now);
  if (fading_) {
    // finished when the servo has noticed the loss and has released the force as well
    if (answer_.number > fading_after_ && answer_.push.none()) fading_ = false;
    const double left =
        1 - static_cast<double>(now - faded_since_ns_) / static_cast<double>(fade_ns_);
    pushed_ = fading_ ? fading_from_.scaled(std::max(0.0, left)) : Push{};
  } else {
    pushed_ = answer_.push.scaled(scale_.load(std::memory_order_relaxed));
  }
  return pushed_.force;
}

void Link::mark_lost() BURR_RT {
  const std::int64_t now = now_();
  HandState none;
  none.valid = false;
  publish_reading(none, now);
  fading_ = true;  // no force while the hand is gone, and none at once when it comes back
  faded_since_ns_ = now - fade_ns_;
  fading_from_ = pushed_ = {};
  fading_after_ = number_;
  released_.store(true, std::memory_order_release);
}

// ---- servo

bool Link::wait(std::int64_t until_ns) BURR_RT {
  fresh_ = fresh_ || readings_.take(reading_);
  while (!fresh_ && now_() < until_ns) {
    read_.wait_until(until_ns);
    fresh_ = readings_.take(reading_);
  }
  return fresh_;
}

HandState Link::state() BURR_RT {
  if (!fresh_) static_cast<void>(readings_.take(reading_));
  fresh_ = false;
  HandState hand = reading_.hand;
  if (reading_.number == 0 || now_() - reading_.arrived_ns >= timeout_ns_ ||
      released_.exchange(false, std::memory_order_acq_rel))
    hand.valid = false;
  return hand;
}

void Link::write_force(const Vec3& force) BURR_RT {
  scale_.store(1.0, std::memory_order_relaxed);
  answers_.publish({{force, torque_}, reading_.number});
  torque_ = Vec3::Zero();
  answered_.notify();
}

// ---- the pace

// The time from which a reading may begin the next tick. For a device with more readings than
// ticks, the reading nearest to the nominal rate is taken, so that a second of ticks is a second. A
// device with one reading a tick may be uneven, and a little faster than it says. Until the
// device's rate is known, an eighth of a period early suits both kinds.
std::int64_t LinkClock::next_after(std::int64_t began) BURR_RT {
  const std::int64_t reading = link_.reading_period_ns();
  if (reading > period_ns_ - period_ns_ / 8) {
    due_ns_ = began;
    return began + period_ns_ / 2;
  }
  if (reading < period_ns_ / 64) {
    due_ns_ = began;
    return began + period_ns_ - period_ns_ / 8;
  }
  due_ns_ += period_ns_;
  if (std::abs(began - due_ns_) > period_ns_) due_ns_ = began;  // after a stall, do not catch up
  return due_ns_ + period_ns_ - reading / 2;
}

rt::TickTime LinkClock::wait() BURR_RT {
  const bool first = start_ns_ < 0;
  if (first) start_ns_ = last_ns_ = link_.now();
  // first long enough for a late reading, then once a period
  const std::int64_t answer_timeout =
      std::max(period_ns_, link_.arrived_ns() + link_.timeout_ns() - last_ns_);
  const bool fresh = link_.wait(last_ns_ + (first ? link_.timeout_ns() : answer_timeout));
  const std::int64_t now = link_.now();
  link_.begin_at(next_after(fresh ? link_.arrived_ns() : now));

  rt::TickTime time;
  time.now_ns = now - start_ns_;
  time.since_last_ns = first ? period_ns_ : now - last_ns_;
  // due when its reading came; without a reading, when it begins
  time.late_ns = fresh ? std::max<std::int64_t>(0, now - link_.arrived_ns()) : 0;
  time.due_ns = time.now_ns - time.late_ns;
  time.missed = std::max<std::int64_t>(0, (time.since_last_ns + period_ns_ / 2) / period_ns_ - 1);
  last_ns_ = now;
  return time;
}

}  // namespace burr::device
