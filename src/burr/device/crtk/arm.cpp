#include "burr/device/crtk/arm.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string_view>
#include <thread>
#include <utility>

#include "burr/device/crtk/bus.h"
#include "burr/rt/latest.h"

namespace burr::device::crtk {
namespace {

using math::Pose;
using math::Quat;
using math::Vec3;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kHeard(300);             // wait for another arm of the same name
constexpr std::int64_t kListenNs = 20'000'000;  // between two checks of whether to stop
constexpr milliseconds kStateAgain(1000);       // publish operating_state again, even if unchanged
constexpr double kFarthest = 1;                 // distance of a goal from the middle [m]
constexpr std::array<const char*, 3> kStates = {"ENABLED", "PAUSED", "DISABLED"};

constexpr double kThere = 1e-9;  // closer than this counts as arrived [m]

bool sound(const PoseStamped& goal, const Vec3& middle) {
  const Pose pose = pose_of(goal.pose_);
  const double size = pose.q.norm();
  return !is_zero(goal.header_.stamp_) && pose.finite() && size > 0.9 && size < 1.1 &&
         (pose.p - middle).norm() <= kFarthest;
}

}  // namespace

struct Arm::Connection {
  std::unique_ptr<Bus> bus;
  Vec3 middle;
  Writer<PoseStamped> measured, setpoint;
  Writer<TwistStamped> velocity;
  Writer<WrenchStamped> body, spatial;
  Writer<OperatingState> states;
  Reader<PoseStamped> servo, move;
  Reader<StringStamped> commands;
  Reader<Joy> spindle;
  dds_entity_t waits;

  rt::Latest<ArmGoal> goals;
  std::atomic<std::uint64_t> ignored_goals = 0;
  std::atomic<ArmState> state = ArmState::enabled;
  std::atomic<bool> homed = true, stop = false;
  std::thread listener;

  // used only by the listener
  ArmGoal goal;

  // used only by publish()
  int stated = -1;
  steady_clock::time_point stated_at;

  Connection(std::unique_ptr<Bus> on, const std::string& name, const Vec3& about)
      : bus(std::move(on)),
        middle(about),
        measured(bus->participant(), name + "/measured_cp"),
        setpoint(bus->participant(), name + "/setpoint_cp"),
        velocity(bus->participant(), name + "/measured_cv"),
        body(bus->participant(), name + "/body/measured_cf"),
        spatial(bus->participant(), name + "/spatial/measured_cf"),
        states(bus->participant(), name + "/operating_state", Keep::last),
        servo(bus->participant(), name + "/servo_cp", Keep::newest),
        move(bus->participant(), name + "/move_cp", Keep::all),
        commands(bus->participant(), name + "/state_command", Keep::all),
        spindle(bus->participant(), name + "/spindle", Keep::all),
        waits(dds_create_waitset(bus->participant())) {
    for (const dds_entity_t reader :
         {servo.entity(), move.entity(), commands.entity(), spindle.entity()})
      dds_waitset_attach(waits, dds_create_readcondition(reader, DDS_ANY_STATE), 0);
    listener = std::thread([this] { listen(); });
  }
  ~Connection() {
    stop = true;
    listener.join();
    dds_delete(waits);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void begin(ArmGoal::Kind kind) {
    goal.kind = kind;
    ++goal.number;
  }
  void obey(std::string_view word) {
    ArmState next = goal.state;
    if (word == "enable")
      next = ArmState::enabled;
    else if (word == "disable")
      next = ArmState::disabled;
    else if (word == "pause" && goal.state == ArmState::enabled)
      next = ArmState::paused;
    else if (word == "resume" && goal.state == ArmState::paused)
      next = ArmState::enabled;
    else if (word == "unhome")
      homed = false;
    else if (word == "home" && goal.state == ArmState::enabled) {
      homed = true;
      begin(ArmGoal::Kind::home);
    } else {
      ++ignored_goals;
    }
    if (next != goal.state && next != ArmState::enabled) begin(ArmGoal::Kind::stay);
    if (next != ArmState::enabled) goal.spindle = 0;
    goal.state = next;
    state = next;
  }
  void follow(const PoseStamped& wanted, ArmGoal::Kind kind) {
    if (goal.state != ArmState::enabled || !homed || !sound(wanted, middle)) {
      ++ignored_goals;
      return;
    }
    goal.goal = pose_of(wanted.pose_);
    goal.goal.q.normalize();
    begin(kind);
  }
  void listen() {
    dds_attach_t found = 0;
    while (!stop) {
      if (dds_waitset_wait(waits, &found, 1, kListenNs) <= 0) continue;
      while (const StringStamped* command = commands.take())
        obey(command->string_ != nullptr ? command->string_ : "");
      while (const PoseStamped* wanted = move.take()) follow(*wanted, ArmGoal::Kind::move);
      while (const PoseStamped* wanted = servo.take()) follow(*wanted, ArmGoal::Kind::servo);
      while (const Joy* joy = spindle.take()) {
        const double pedal = joy->axes_._length > 0 ? joy->axes_._buffer[0] : NAN;
        if (std::isfinite(pedal) && goal.state == ArmState::enabled)
          goal.spindle = std::clamp(pedal, 0.0, 1.0);
        else
          ++ignored_goals;
      }
      goals.publish(goal);
    }
  }
};

Arm::Arm(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
Arm::~Arm() = default;

Result<std::unique_ptr<Arm>> Arm::open(const ArmSettings& settings) {
  const std::string name = arm_name(settings.name);
  if (name.empty())
    return error(
        Trouble::usage,
        fmt::format("{}: is not a valid name of an arm; write it as in ROS, for example /burr",
                    settings.name));
  auto bus = Bus::open(settings.domain, settings.network);
  if (!bus) return bus.error();
  for (const auto until = steady_clock::now() + kHeard; steady_clock::now() < until;
       std::this_thread::sleep_for(milliseconds(10)))
    for (const Topic& topic : (*bus)->written())
      if (topic.name == name + "/measured_cp")
        return error(Trouble::usage,
                     fmt::format("there is already an arm {} on DDS domain {}; give this one "
                                 "another name, or set another ROS_DOMAIN_ID",
                                 name, (*bus)->domain()));
  return std::unique_ptr<Arm>(
      new Arm(std::make_unique<Connection>(std::move(*bus), name, settings.middle)));
}

void Arm::publish(const ArmReport& report) {
  const std_msgs_msg_dds__Header_ header{now_stamp(), as_sample_text("world")};
  connection_->measured.write(PoseStamped{header, message_of(report.measured)});
  connection_->setpoint.write(PoseStamped{header, message_of(report.setpoint)});
  connection_->velocity.write(TwistStamped{header, {message_of(report.velocity), {}}});
  const Quat& q = report.measured.q;
  connection_->body.write(
      WrenchStamped{header, {message_of(Vec3(q.conjugate() * report.force)), {}}});
  connection_->spatial.write(WrenchStamped{
      header, {message_of(report.force), message_of(Vec3(report.measured.p.cross(report.force)))}});
  const auto state = connection_->state.load();
  const bool homed = connection_->homed;
  const bool fault = report.released && state == ArmState::enabled;
  const int stated =
      8 * static_cast<int>(state) + (fault ? 4 : 0) + (homed ? 2 : 0) + (report.busy ? 1 : 0);
  const auto now = steady_clock::now();
  if (stated == connection_->stated && now - connection_->stated_at < kStateAgain) return;
  const char* word = fault ? "FAULT" : kStates[static_cast<std::size_t>(state)];
  connection_->states.write(OperatingState{header, as_sample_text(word), homed, report.busy});
  connection_->stated = stated;
  connection_->stated_at = now;
}

bool Arm::take(ArmGoal& newest) BURR_RT { return connection_->goals.take(newest); }
int Arm::domain() const { return connection_->bus->domain(); }
bool Arm::on_network() const { return connection_->bus->reach() == Reach::network; }
std::uint64_t Arm::ignored_goals() const { return connection_->ignored_goals; }

// ---- the hand

DrivenHand::DrivenHand(Arm& arm, const Pose& start)
    : arm_(arm), home_(start), at_(start), goal_(start) {
  spec_.name = "driven arm";
}

void DrivenHand::step(double dt) BURR_RT {
  const Vec3 before = at_.p;
  const Vec3 way = goal_.p - at_.p;
  const double left = way.norm();
  const bool servo = command_.kind == ArmGoal::Kind::servo;
  const double half = 0.5 * kMoveAcceleration * dt;
  if (servo)
    speed_ = kServoSpeed;
  else  // no faster than the speed from which it can still stop
    speed_ = std::min({kMoveSpeed, speed_ + kMoveAcceleration * dt,
                       std::sqrt(2 * kMoveAcceleration * left + half * half) - half});
  const double reach = speed_ * dt;
  if (left <= reach + kThere) {
    at_.p = goal_.p;
    speed_ = 0;
  } else {
    at_.p += way * (reach / left);
  }
  const double angle = at_.q.angularDistance(goal_.q);
  if (angle <= kTurnSpeed * dt)
    at_.q = goal_.q;
  else
    at_.q = Quat(at_.q.slerp(kTurnSpeed * dt / angle, goal_.q));
  velocity_ = (at_.p - before) / dt;
  busy_.store(!servo && (at_.p != goal_.p || at_.q.coeffs() != goal_.q.coeffs()),
              std::memory_order_relaxed);
}

HandState DrivenHand::state(double dt) BURR_RT {
  const std::uint64_t number = command_.number;
  if (arm_.take(command_) && command_.number != number) {
    if (command_.kind == ArmGoal::Kind::stay) goal_ = at_;
    if (command_.kind == ArmGoal::Kind::home) goal_ = home_;
    if (command_.kind == ArmGoal::Kind::servo || command_.kind == ArmGoal::Kind::move)
      goal_ = command_.goal;
  }
  if (dt > 0) step(dt);
  HandState hand;
  hand.world_from_tool = at_;
  hand.velocity = velocity_;
  hand.pedal = command_.spindle;
  hand.buttons = command_.state == ArmState::disabled ? kLifted : 0;
  return hand;
}

std::string DrivenHand::trouble() const {
  const std::uint64_t count = arm_.ignored_goals();
  return count == 0
             ? std::string()
             : fmt::format(
                   "{} goals or commands were ignored: the arm was disabled, paused or not homed, "
                   "or the goal had a stamp of 0, was not a number, or was too far away.",
                   count);
}

}  // namespace burr::device::crtk
