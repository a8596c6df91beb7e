#include "burr/sim/trial_interval.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "burr/haptics/vibration.h"
#include "burr/sim/session.h"
#include "burr/tick/servo.h"
#include "burr/tick/setting_table.h"

namespace burr::sim {
namespace {

using math::Vec3;

constexpr auto kLook = std::chrono::milliseconds(10);
constexpr std::size_t kMostSeconds = 120;  // longest interval

// Lends a hand to one interval: keeps what it feels, and runs or stops the drill as the interval
// needs.
class LentHand final : public device::Device {
 public:
  LentHand(device::Device& hand, people::Felt& felt, bool spindle)
      : hand_(hand), felt_(felt), spindle_(spindle) {}
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return hand_.spec(); }
  [[nodiscard]] device::HandState state(double dt) BURR_RT override {
    device::HandState now = hand_.state(dt);
    now.pedal = spindle_ ? 1 : 0;
    at_ = now.world_from_tool.p;
    read_ = true;
    return now;
  }
  void write_torque(const Vec3& torque) BURR_RT override { hand_.write_torque(torque); }
  void write_force(const Vec3& force) BURR_RT override {
    hand_.write_force(force);
    // not the fade at the end, which has no reading; the memory was reserved before the start
    if (!read_ || felt_.at.size() == felt_.at.capacity()) return;
    read_ = false;
    felt_.at.push_back(at_);
    felt_.force.push_back(force);
  }
  void scale_force(double scale) BURR_RT override { hand_.scale_force(scale); }
  [[nodiscard]] rt::TickClock* clock(double rate_hz) override { return hand_.clock(rate_hz); }
  [[nodiscard]] std::int64_t arrived_ns() const BURR_RT override { return hand_.arrived_ns(); }
  [[nodiscard]] bool take_stats(device::LinkStats& newest) override {
    return hand_.take_stats(newest);
  }
  [[nodiscard]] std::string trouble() const override { return hand_.trouble(); }
  [[nodiscard]] bool finished() const BURR_RT override { return hand_.finished(); }

 private:
  device::Device& hand_;
  people::Felt& felt_;
  bool spindle_, read_ = false;
  Vec3 at_ = Vec3::Zero();
};

tick::ServoSettings servo_of(const WallSettings& wall, const WallProperties& shown) {
  tick::ServoSettings servo;
  servo.rate_hz = wall.rate_hz;
  servo.burr.radius = wall.burr_radius;
  servo.mode = tick::ToolMode::touch;
  servo.force = {shown.stiffness, 0};  // a damper would be felt as more stiffness
  servo.friction_scale = shown.friction;
  servo.friction_turning = 0;
  servo.kinetic_share = 1;
  servo.spindle_rad_s = wall.vibration_hz * 2 * std::numbers::pi;
  // in touch alone nothing cuts; its base part is the only vibration
  servo.torque_gain = 0;
  servo.vibration_gain = shown.vibration / haptics::VibrationSettings{}.base;
  servo.limit.user_force = wall.user_force;
  servo.undo_bricks = 64;
  return servo;
}

}  // namespace

Wall::Wall(Bone bone, const WallSettings& settings) : make_(std::move(bone)), settings_(settings) {}
Wall::~Wall() = default;

WallProperties Wall::of(people::Stimulus stimulus, double value) const {
  WallProperties shown;
  shown.stiffness = settings_.other_stiffness;
  if (stimulus == people::Stimulus::stiffness) shown.stiffness = value;
  if (stimulus == people::Stimulus::friction) shown.friction = value;
  if (stimulus == people::Stimulus::vibration) shown.vibration = value;
  return shown;
}

Status Wall::check_device(const device::DeviceSpec& spec, const WallProperties& shown) const {
  if (shown.stiffness > spec.max_stiffness)
    return error(
        Trouble::usage,
        fmt::format(
            "{} can render at most {:g} N/m, but this needs {:g}; lower `standard` or `largest`",
            spec.name, spec.max_stiffness, shown.stiffness));
  if (shown.friction > 4)
    return error(
        Trouble::usage,
        fmt::format(
            "a coefficient of friction of {:g} is more than 4; lower `standard` or `largest`",
            shown.friction));
  if (shown.vibration > kMostVibration * (1 + 1e-9))
    return error(
        Trouble::usage,
        fmt::format(
            "a vibration of {:g} N is more than the limit of {:g} N; lower `standard` or `largest`",
            shown.vibration, kMostVibration));
  return fine();
}

Result<people::Felt> Wall::show(device::Device& hand, const WallProperties& shown, double seconds,
                                const std::function<bool()>& enough) {
  if (Status can = check_device(hand.spec(), shown); !can) return can.error();
  if (Status good = tick::check_settings(servo_of(settings_, shown)); !good) return good.error();
  const auto ticks = static_cast<std::size_t>(
      std::ceil(std::min<double>(seconds, kMostSeconds) * settings_.rate_hz));
  people::Felt felt;
  felt.dt = 1 / settings_.rate_hz;
  felt.at.reserve(ticks);
  felt.force.reserve(ticks);
  const bool spindle = shown.vibration > 0;
  NoProgress quiet;

  if (hand.spec().simulated) {
    if (bone_ == nullptr) {  // it is never cut, so one bone serves all intervals
      bone_ = make_();
      surface_ = std::make_unique<volume::IsoVertices>(*bone_, volume::IsoSettings{}, 1, quiet);
    }
    LentHand lent(hand, felt, spindle);
    tick::Servo servo(*bone_, *surface_, lent, servo_of(settings_, shown));
    Vec3 last = Vec3::Zero();
    for (std::size_t n = 0; n < ticks && !(n % 100 == 0 && enough && enough()); ++n) {
      last = servo.tick(false).contact.force;
      servo.publish();
    }
    const auto fade = static_cast<int>(std::ceil(5e-3 * settings_.rate_hz));
    for (int n = 1; n <= fade; ++n) hand.write_force(last * (1 - static_cast<double>(n) / fade));
    return felt;
  }

  SessionSettings settings;
  settings.servo = servo_of(settings_, shown);
  settings.realtime = true;
  auto made =
      Session::make(make_(), std::make_unique<LentHand>(hand, felt, spindle), settings, quiet);
  if (!made) return made.error();
  const auto began = std::chrono::steady_clock::now();
  (*made)->start();
  while ((*made)->running() && !(enough && enough()) &&
         std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count() < seconds)
    std::this_thread::sleep_for(kLook);
  (*made)->stop();
  return felt;
}

}  // namespace burr::sim
