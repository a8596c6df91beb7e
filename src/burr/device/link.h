// device/link.h - carries readings and forces between a device's own thread (the wire) and the
// tick.
//
//     wire: force = exchange(reading)        servo: wait() - state() - tick - write_force()
//
// A reading begins a tick, and the wire waits for that tick's force, but no longer than its
// answer timeout; then the previous force stays, for a few milliseconds. If no answer comes for
// loss_timeout, the force fades linearly to zero. It stays at zero until the servo has seen the
// loss (an invalid reading) and has itself come down to zero, so that force returns only through
// the start ramp. The same happens when no reading comes for that long, even if the servo slept over
// the gap. An old force is never repeated for longer than the timeout.
//
// Thread: exchange(), push(), torque(), mark_lost() on the wire; wait(), state(), write_torque(),
// write_force(), begin_at() on the servo; scale_force() any. Wait-free but for the two bounded
// waits.
// Memory: none. Units: SI, ns.
#pragma once

#include <semaphore.h>

#include <atomic>
#include <cstdint>

#include "burr/device/device.h"
#include "burr/rt/clock.h"
#include "burr/rt/latest.h"
#include "burr/rt/rt.h"

namespace burr::device {

struct LinkSettings {
  double answer_timeout = 0.5e-3;  // how long the wire waits for the force of its reading [s]
  double loss_timeout = 5e-3;      // without an answer, or without a reading [s]
  double fade = 5e-3;              // time from then to zero force [s]
};

class Link {
 public:
  using Now = std::int64_t (*)();  // [ns], never decreasing

  explicit Link(const LinkSettings& settings = {}, Now clock = &rt::monotonic_ns);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  // ---- wire
  // A reading of the hand has just arrived; returns the force to push it with [N]. A reading that
  // comes before the next tick may begin (begin_at()) is passed over: the previous force stays.
  [[nodiscard]] math::Vec3 exchange(const HandState& hand) BURR_RT;
  // The present force, without a new reading [N].
  [[nodiscard]] math::Vec3 push() BURR_RT;
  // The torque that goes with the force that was returned last, held and faded with it [N m].
  [[nodiscard]] const math::Vec3& torque() const BURR_RT { return pushed_.torque; }
  // The device is gone, or sends impossible values: the force is zero, and the next tick knows it.
  void mark_lost() BURR_RT;

  // ---- servo
  // Waits for a reading that has not been taken yet, or until the time. True: there is one.
  [[nodiscard]] bool wait(std::int64_t until_ns) BURR_RT;
  // The newest reading. Invalid when it is older than the timeout, or after the wire let go.
  [[nodiscard]] HandState state() BURR_RT;
  // The torque of the next force; afterwards it is zero again [N m].
  void write_torque(const math::Vec3& torque) BURR_RT { torque_ = torque; }
  void write_force(const math::Vec3& force) BURR_RT;
  // Readings before this time do not begin a tick.
  void begin_at(std::int64_t ns) BURR_RT { begin_ns_.store(ns, std::memory_order_relaxed); }
  // When the newest reading arrived that was taken [ns]. After wait(): of the reading that state()
  // will return.
  [[nodiscard]] std::int64_t arrived_ns() const BURR_RT { return reading_.arrived_ns; }

  // ---- one thread, any
  // The account so far, every 256 readings. False: nothing new.
  [[nodiscard]] bool take_stats(LinkStats& newest) { return newest_stats_.take(newest); }

  // Time between two readings, a mean over some hundred; 0 at first [ns]. Thread: any.
  [[nodiscard]] std::int64_t reading_period_ns() const BURR_RT {
    return reading_period_ns_.load(std::memory_order_relaxed);
  }

  // ---- any
  // Another device's readings begin the ticks. This link stops waiting for them, because it would
  // only slow its own device down.
  void never_wait() BURR_RT { answer_timeout_ns_.store(0, std::memory_order_relaxed); }
  // Multiplies the force by scale until the next write_force().
  void scale_force(double scale) BURR_RT { scale_.store(scale, std::memory_order_relaxed); }

  [[nodiscard]] std::int64_t now() const BURR_RT { return now_(); }
  [[nodiscard]] std::int64_t timeout_ns() const BURR_RT { return timeout_ns_; }

 private:
  struct Reading {
    HandState hand;
    std::int64_t arrived_ns = 0;
    std::uint64_t number = 0;  // 0: there has been no reading
  };
  struct Push {
    math::Vec3 force = math::Vec3::Zero(), torque = math::Vec3::Zero();
    [[nodiscard]] bool none() const BURR_RT {
      return force == math::Vec3::Zero() && torque == math::Vec3::Zero();
    }
    [[nodiscard]] Push scaled(double by) const BURR_RT { return {by * force, by * torque}; }
  };
  struct Answer {
    Push push;
    std::uint64_t number = 0;  // of the reading it is for
  };

  // A signal from one thread to another. Several notifications before the wait count as one.
  class Signal {
   public:
    Signal();
    ~Signal();
    Signal(const Signal&) = delete;
    Signal& operator=(const Signal&) = delete;
    void notify() BURR_RT;
    void wait_until(std::int64_t until_ns) BURR_RT;  // returns when notified, or at this time

   private:
    sem_t sem_{};
    std::atomic<bool> notified_ = false;
  };

  void count_readings(std::int64_t now) BURR_RT;
  void publish_reading(const HandState& hand, std::int64_t now) BURR_RT;
  void take_answers(std::int64_t now) BURR_RT;
  void release(std::int64_t now) BURR_RT;

  Now now_;
  std::atomic<std::int64_t> answer_timeout_ns_;
  std::int64_t timeout_ns_, fade_ns_;

  rt::Latest<Reading> readings_;
  rt::Latest<Answer> answers_;
  Signal read_, answered_;
  std::atomic<std::int64_t> begin_ns_ = INT64_MIN;
  std::atomic<std::int64_t> reading_period_ns_ = 0;
  std::atomic<double> scale_ = 1.0;
  std::atomic<bool> released_ = false;  // set by the wire: the servo must come down to zero

  rt::Latest<LinkStats> newest_stats_;

  // used only on the wire
  LinkStats stats_;
  std::uint64_t number_ = 0;
  Answer answer_;
  static constexpr std::int64_t kNever = INT64_MIN;
  std::int64_t last_reading_ns_ = kNever;
  std::int64_t answered_ns_ = kNever;
  bool fading_ = false;
  std::int64_t faded_since_ns_ = 0;
  Push fading_from_, pushed_;
  std::uint64_t fading_after_ = 0;  // readings after this one were answered by a servo that knew of
                                    // the loss

  // used only on the servo
  Reading reading_;
  bool fresh_ = false;
  math::Vec3 torque_ = math::Vec3::Zero();
};

// The pace of a link: a tick begins when its reading comes; lateness counts from there. Where there
// are more readings than ticks, it takes those nearest to the nominal rate. Where no reading comes
// in time, ticks continue once a period, so that the force can fade.
class LinkClock final : public rt::TickClock {
 public:
  LinkClock(Link& link, double rate_hz) : link_(link), period_ns_(rt::period_from_rate(rate_hz)) {}

  [[nodiscard]] std::int64_t period_ns() const BURR_RT override { return period_ns_; }
  [[nodiscard]] rt::TickTime wait() BURR_RT override;

 private:
  Link& link_;
  [[nodiscard]] std::int64_t next_after(std::int64_t began) BURR_RT;
  std::int64_t period_ns_, start_ns_ = -1, last_ns_ = 0;
  std::int64_t due_ns_ = 0;  // when the last tick was due at the nominal rate
};

}  // namespace burr::device
