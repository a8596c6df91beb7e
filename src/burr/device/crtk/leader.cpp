#include "burr/device/crtk/leader.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "burr/device/crtk/bus.h"
#include "burr/device/crtk/reading.h"
#include "burr/device/guardian.h"
#include "burr/device/silence.h"
#include "burr/rt/clock.h"

namespace burr::device::crtk {
namespace {

using math::Vec3;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kHeard(1500);    // to discover the arms
constexpr milliseconds kMatched(2000);  // for the arm to join a topic
constexpr milliseconds kStated(600);    // for an arm to report its state
constexpr milliseconds kHomes(60'000);  // for an arm to home
constexpr double kCounted = 0.4;        // time over which its rate is measured [s]
constexpr int kCountedPlaces = 100;     // ... but not more poses than this
constexpr int kCountings = 5;           // a low rate is measured again: a busy computer loses poses
constexpr milliseconds kLeft(1000);     // for another writer to disappear: it may be our own
                                        // earlier one
constexpr milliseconds kLook(2);
constexpr std::int64_t kOneReadingNs = 2'000'000;  // wait of read()
constexpr std::int64_t kLastNs = 100'000'000;      // for the last force to arrive
constexpr double kSlowest = 400;  // lowest rate of readings: after 5 ms without one the tick
                                  // releases the force [Hz]
constexpr int kLookAtBus = 64;    // forces between two checks of who reads or writes them

constexpr const char *kBody = "/body/servo_cf", *kSpatial = "/spatial/servo_cf";
constexpr const char* kPlace = "/measured_cp";
constexpr const char* kPoseType = "geometry_msgs::msg::dds_::PoseStamped_";

// CRTK has no way to report limits. These are cautious ones for an arm of the size of dVRK's
// leaders: every such arm and every hand can bear them; the strongest arm could do more.
constexpr double kPeak = 3, kContinuous = 1;      // [N]
constexpr double kMostTorque = 0.5;               // that a user may name [N m]
constexpr double kStiffness = 400, kDamping = 3;  // [N/m], [N s/m]
constexpr double kRadius = 100e-3;                // [m]

template <class Done>
bool until(milliseconds longest, Done done) {
  for (const auto end = steady_clock::now() + longest; !done();) {
    if (steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kLook);
  }
  return true;
}

bool is_pressed(const Joy& joy) { return joy.buttons_._length > 0 && joy.buttons_._buffer[0] != 0; }

}  // namespace

// The connection and its state.
struct Leader::Connection {
  std::unique_ptr<Bus> bus;
  std::string arm;
  Reader<PoseStamped> place;
  Reader<TwistStamped> speed;
  Reader<OperatingState> happens, happened;
  Reader<Bool> gripper;
  Reader<Joy> clutch, coag, present;
  Writer<WrenchStamped> body, spatial;
  Writer<StringStamped> command;
  Writer<Bool> absolute, weightless;
  dds_entity_t waits, comes;
  std::unique_ptr<Guardian> guardian;

  bool to_body = true;
  WrenchStamped wrench{};
  int until_look = kLookAtBus;
  bool taken = true, alone = true;
  bool sound_speed = true;
  HandState hand;
  Silence silence;

  bool stated = false;
  std::string state;
  bool homed = false, busy = false;
  bool is_present = true;
  std::uint32_t buttons = 0;
  double pedal = 0;

  Connection(std::unique_ptr<Bus> on, const std::string& name)
      : bus(std::move(on)),
        arm(name),
        place(bus->participant(), name + kPlace, Keep::newest),
        speed(bus->participant(), name + "/measured_cv", Keep::newest),
        happens(bus->participant(), name + "/operating_state", Keep::all),
        happened(bus->participant(), name + "/operating_state", Keep::last),
        gripper(bus->participant(), name + "/gripper/closed", Keep::all),
        clutch(bus->participant(), "/footpedals/clutch", Keep::all),
        coag(bus->participant(), "/footpedals/coag", Keep::all),
        present(bus->participant(), "/console/operator_present", Keep::all),
        body(bus->participant(), name + kBody),
        spatial(bus->participant(), name + kSpatial),
        command(bus->participant(), name + "/state_command", Keep::all),
        absolute(bus->participant(), name + "/body/set_cf_orientation_absolute"),
        weightless(bus->participant(), name + "/use_gravity_compensation"),
        waits(dds_create_waitset(bus->participant())),
        comes(dds_create_readcondition(place.entity(), DDS_ANY_STATE)) {
    dds_waitset_attach(waits, comes, 0);
    wrench.header_.frame_id_ = as_sample_text("");
  }
  ~Connection() {
    guardian.reset();
    dds_delete(waits);
    dds_delete(comes);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  Writer<WrenchStamped>& force() { return to_body ? body : spatial; }

  void take_state(const OperatingState& told) {
    stated = true;
    state.assign(told.state_ != nullptr ? told.state_ : "");
    homed = told.is_homed_;
    busy = told.is_busy_;
  }

  // Takes all messages except the pose.
  void listen() {
    if (!stated)
      while (const OperatingState* told = happened.take()) take_state(*told);
    while (const OperatingState* told = happens.take()) take_state(*told);
    while (const Bool* closed = gripper.take()) press(0, closed->data_);
    while (const Joy* joy = clutch.take()) press(1, is_pressed(*joy));
    while (const Joy* joy = coag.take()) pedal = is_pressed(*joy) ? 1 : 0;
    while (const Joy* joy = present.take()) is_present = is_pressed(*joy);
  }
  void press(int button, bool down) {
    const std::uint32_t bit = 1U << button;
    buttons = down ? buttons | bit : buttons & ~bit;
  }

  // Waits for a pose, for a few milliseconds at most.
  const PoseStamped* next_place() {
    dds_attach_t found = 0;
    static_cast<void>(dds_waitset_wait(waits, &found, 1, kOneReadingNs));
    return place.take();
  }
  // The rate of the poses [Hz].
  double rate() {
    int places = 0;
    double seconds = 0;
    ListeningTime listened;
    listened.begin(rt::monotonic_ns());
    const auto good = [&] { return places >= kCountedPlaces && places >= kSlowest * seconds; };
    while (!good() && seconds < kCounted) {
      if (next_place() != nullptr) ++places;
      seconds = 1e-9 * static_cast<double>(listened.until(rt::monotonic_ns()));
    }
    return places / seconds;
  }

  // Number of other writers of the arm's forces.
  int others(bool guardians) {
    return bus->others_writing(arm + kBody, guardians) +
           bus->others_writing(arm + kSpatial, guardians);
  }

  [[nodiscard]] bool enabled() const { return !stated || state == "ENABLED"; }
  [[nodiscard]] bool ready() const { return !stated || (enabled() && homed && !busy); }

  void ask(const char* words) {
    StringStamped message{};
    message.header_ = {now_stamp(), as_sample_text("")};
    message.string_ = as_sample_text(words);
    command.write(message);
  }

  // Publishes a force at the arm's end and a torque about it. p, q: the pose of that end in the frame
  // of both.
  bool push(const Vec3& wanted, const Vec3& turn) {
    const math::Pose& end = hand.world_from_tool;
    wrench.header_.stamp_ = now_stamp();
    wrench.wrench_.force_ = message_of(to_body ? Vec3(end.q.conjugate() * wanted) : wanted);
    wrench.wrench_.torque_ =
        message_of(to_body ? Vec3(end.q.conjugate() * turn) : Vec3(end.p.cross(wanted) + turn));
    return force().write(wrench);
  }
};

Leader::Leader(LeaderSettings settings) : settings_(std::move(settings)) {}
Leader::~Leader() { disconnect(); }

namespace {

struct ArmsOnBus {
  std::vector<std::string> arms;
  std::string old;  // an arm whose pose has a message type from before 2022, and that type
};
ArmsOnBus arms_on(Bus& bus) {
  ArmsOnBus heard;
  for (const Topic& topic : bus.written()) {
    if (!topic.name.ends_with(kPlace) || topic.name.find("/local/") != std::string::npos) continue;
    const std::string arm = topic.name.substr(0, topic.name.size() - std::string(kPlace).size());
    if (topic.type != kPoseType)
      heard.old = arm + " " + topic.type;
    else if (std::find(heard.arms.begin(), heard.arms.end(), arm) == heard.arms.end())
      heard.arms.push_back(arm);
  }
  return heard;
}

// Chooses the arm to use. Error: lists the arms that are there.
Result<std::string> choose(Bus& bus, const std::string& given) {
  std::string wanted;
  if (!given.empty()) {
    wanted = arm_name(given);
    if (wanted.empty())
      return error(
          Trouble::usage,
          fmt::format("{}: is not a valid name of an arm; write it as in ROS, for example /MTMR",
                      given));
  }
  ArmsOnBus heard;
  const std::vector<std::string>& arms = heard.arms;
  const std::string& old = heard.old;
  const auto look = [&] {
    heard = arms_on(bus);
    return !wanted.empty() && std::find(arms.begin(), arms.end(), wanted) != arms.end();
  };
  if (until(kHeard, look)) return wanted;
  if (wanted.empty() && arms.size() == 1) return arms.front();
  if (!old.empty() && (wanted.empty() || old.starts_with(wanted + " ")))
    return error(
        Trouble::io,
        fmt::format(
            "{} is not a PoseStamped, which CRTK has required since 2022; update the arm's node",
            old));
  const bool alone = bus.reach() == Reach::this_computer;
  const std::string where =
      fmt::format("on DDS domain {}{}", bus.domain(), alone ? " of this computer" : "");
  if (arms.empty())
    return error(Trouble::io, fmt::format("no CRTK arm{}{} was found {}; start its node, and check "
                                          "that ROS_DOMAIN_ID is the same for both{}",
                                          wanted.empty() ? "" : " ", wanted, where,
                                          alone ? "; for an arm on another computer, set "
                                                  "ROS_AUTOMATIC_DISCOVERY_RANGE=SUBNET"
                                                : ""));
  return error(
      Trouble::io,
      wanted.empty()
          ? fmt::format("several CRTK arms were found {}: {}; choose one, for example crtk:{}",
                        where, fmt::join(arms, ", "), arms.front())
          : fmt::format("no CRTK arm {} was found {}; there are {}", wanted, where,
                        fmt::join(arms, ", ")));
}

}  // namespace

Result<std::vector<std::string>> list_arms(const LeaderSettings& settings) {
  auto bus = Bus::open(settings.domain);
  if (!bus) return bus.error();
  std::this_thread::sleep_for(kHeard);
  return arms_on(**bus).arms;
}

// Makes sure that the arm is enabled and homed; does it where that is allowed.
Status Leader::prepare(Connection& connection) {
  const auto stated = [&connection] {
    connection.listen();
    return connection.stated;
  };
  static_cast<void>(until(kStated, stated));
  if (connection.ready()) return fine();
  const auto trouble = [&connection](const char* todo) {
    return error(Trouble::io, fmt::format("{} is {}{}; {}", connection.arm, connection.state,
                                          connection.busy    ? " and busy"
                                          : connection.homed ? ""
                                                             : " and not homed",
                                          todo));
  };
  if (connection.state == "FAULT") return trouble("clear the fault at its console");
  if (!settings_.home_allowed)
    return trouble(
        "enable and home it at its console, or let burr do it with `home_allowed`: the arm then "
        "moves");
  connection.ask(connection.state == "PAUSED" ? "resume" : "enable");
  static_cast<void>(until(kMatched, [&connection] {
    connection.listen();
    return connection.enabled();
  }));
  if (!connection.homed) connection.ask("home");
  const bool came = until(kHomes, [&connection] {
    connection.listen();
    return connection.ready() || connection.state == "FAULT";
  });
  if (!came || !connection.ready()) return trouble("homing failed; see its console");
  return fine();
}

Result<DeviceSpec> Leader::connect() {
  disconnect();
  auto bus = Bus::open(settings_.domain);
  if (!bus) return bus.error();
  const auto arm = choose(**bus, settings_.arm);
  if (!arm) return arm.error();
  const int domain = (*bus)->domain();
  auto connection = std::make_unique<Connection>(std::move(*bus), *arm);
  name_ = *arm;

  const auto taken = [&connection] {
    connection->to_body = connection->body.readers() > 0;
    return connection->to_body || connection->spatial.readers() > 0;
  };
  if (!until(kMatched, taken))
    return error(Trouble::io, fmt::format("{0} takes no force: nothing subscribes to {0}{1} or "
                                          "{0}{2}; burr needs an arm that can exert a force",
                                          *arm, kBody, kSpatial));
  if (!connection->to_body)  // it may only be that the topic has not been discovered yet
    static_cast<void>(until(kStated, [&connection] { return connection->body.readers() > 0; }));
  static_cast<void>(taken());
  const Status prepared = prepare(*connection);
  if (!prepared) return prepared.error();

  double rate = 0;
  for (int n = 0; n < kCountings && rate < kSlowest; ++n) rate = std::max(rate, connection->rate());
  if (!until(kLeft, [&connection] { return connection->others(true) == 0; }))
    return error(Trouble::io,
                 fmt::format("another program sends forces to {0}: it writes {0}{1} or {0}{2}; end "
                             "that program, because two forces on one arm are dangerous",
                             *arm, kBody, kSpatial));
  if (rate < kSlowest)
    return error(Trouble::io,
                 fmt::format("{} reports its position {:.0f} times a second, but burr needs {:.0f} "
                             "or more; set a shorter period where its node is started",
                             *arm, rate, kSlowest));

  // For arms that know these: carry their own weight, and take forces in the frame of their end.
  const Bool yes{true}, no{false};
  connection->weightless.write(yes);
  if (connection->to_body) connection->absolute.write(no);
  auto guardian = Guardian::start(
      {"crtk", std::to_string(domain), *arm, connection->to_body ? kBody : kSpatial});
  if (!guardian) return guardian.error();
  connection->guardian = std::move(*guardian);
  connection->silence.ended(rt::monotonic_ns());
  connection_ = std::move(connection);

  trouble_ = nullptr;
  torque_ = Vec3::Zero();
  const double torque = settings_.takes_torque ? settings_.takes_torque(*arm) : 0;
  peak_torque_ = torque > 0 ? std::min(torque, kMostTorque) : 0;
  DeviceSpec spec;
  spec.name = kArmName;
  spec.serial = *arm;
  spec.simulated = false;
  spec.sensed = 6;
  spec.peak_torque = peak_torque_;
  spec.actuated = peak_torque_ > 0 ? 6 : 3;
  spec.peak_force = kPeak;
  spec.continuous_force = kContinuous;
  spec.thermal_budget = 5 * kPeak * kPeak;
  spec.max_stiffness = kStiffness;
  spec.max_damping = kDamping;
  spec.workspace_radius = kRadius;
  spec.native_rate = 1000;
  return spec;
}

void Leader::note(const char* words) BURR_RT {
  if (trouble_ != words) ++why_revision_;
  trouble_ = words;
}

Wire::Read Leader::read(HandState& hand) BURR_RT {
  Connection& connection = *connection_;
  hand.valid = false;
  const PoseStamped* newest = connection.next_place();
  connection.guardian->beat();
  if (newest == nullptr) {
    if (!connection.silence.lasts(rt::monotonic_ns())) return Read::nothing;
    note("has gone silent; check that its node runs.");
    return Read::lost;
  }
  connection.silence.ended(rt::monotonic_ns());
  connection.listen();
  while (const TwistStamped* speed = connection.speed.take())
    connection.sound_speed = take_speed(*speed, connection.hand);
  const bool sound = take_place(*newest, connection.hand) && connection.sound_speed;
  note(!connection.enabled()    ? "was disabled; enable it at its console."
       : !connection.ready()    ? "is homing or moving by itself; wait until it has finished."
       : !sound                 ? "reports that its position is not valid; see its console."
       : !connection.alone      ? "also gets forces from another program; end that program."
       : !connection.taken      ? "no longer takes forces; check that its node runs."
       : !connection.is_present ? "sends no force until somebody is at its console."
                                : nullptr);
  hand = connection.hand;
  hand.buttons = connection.buttons | (connection.is_present ? 0 : kLifted);
  hand.pedal = connection.pedal;
  hand.valid = sound && connection.alone && connection.taken && connection.ready();
  return Read::hand;
}

bool Leader::write(const Vec3& force) BURR_RT {
  Connection& connection = *connection_;
  // a force that was not sent is followed by the next
  static_cast<void>(connection.push(bounded(force, kPeak), bounded(torque_, peak_torque_)));
  if (--connection.until_look <= 0) {
    connection.until_look = kLookAtBus;
    connection.taken = connection.force().readers() > 0;
    connection.alone = connection.others(false) == 0;
  }
  return true;
}

void Leader::disconnect() {
  if (!connection_) return;
  static_cast<void>(connection_->push(Vec3::Zero(), Vec3::Zero()));
  connection_->force().flush(kLastNs);
  connection_.reset();
}

std::string Leader::why() const {
  return trouble_ != nullptr ? name_ + " " + trouble_ : std::string();
}

}  // namespace burr::device::crtk
