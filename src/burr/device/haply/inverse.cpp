#include "burr/device/haply/inverse.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <utility>
#include <vector>

#include "burr/device/haply/events.h"
#include "burr/device/haply/message.h"
#include "burr/device/haply/pipeline.h"
#include "burr/device/silence.h"
#include "burr/net/web_socket.h"
#include "burr/rt/clock.h"

namespace burr::device::haply {
namespace {

using math::Quat;
using math::Vec3;
using std::chrono::milliseconds;

constexpr milliseconds kPatience(500);         // for an answer of the service
constexpr milliseconds kOneReading(2);         // wait of read()
constexpr std::size_t kLargest = 1 << 20;      // longest message [byte]
constexpr int kMostNonsense = 50;              // messages in a row
constexpr int kProbes = 20;                    // exchanges in which a tiny test force must come
                                               // back
constexpr double kTiny = 0.02, kSeen = 0.005;  // test force, too small to feel; the part of it that
                                               // must come back [N]
constexpr double kFarthest = 1;                // no arm is longer [m]
constexpr int kPorts[] = {10001, 10000};
constexpr int kEventsPort = 10020;
constexpr int kOldest = 301;            // oldest version of the service, as in read_version()
constexpr int kConfigures = 305;        // ... that takes a configuration with the first message
constexpr int kTellings = 3;            // of its configuration
constexpr milliseconds kLetGo(1000);    // for a session that is just ending: it may be our own
                                        // earlier one
constexpr milliseconds kLookAgain(20);  // ... between two looks

// Cautious choices, because no published figures were at hand for stiffness and damping.
struct Model {
  const char* type;
  double peak, continuous, stiffness, damping, radius;
};
constexpr Model kModels[] = {{"minverse", 3, 1, 500, 2, 60e-3},
                             {"inverse3x", 8, 3, 1000, 4, 120e-3},
                             {"inverse3", 8, 3, 1000, 4, 120e-3}};
constexpr Model kUnknown = {"", 3, 1, 500, 2, 60e-3};

const Model& model_of(const std::string& type) {
  for (const Model& one : kModels)
    if (type == one.type) return one;
  return kUnknown;
}

std::string from_environment(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

// 0: the variable is not set.
Result<int> port_from_environment(const char* name) {
  const std::string given = from_environment(name, "");
  if (given.empty()) return 0;
  int port = 0;
  const auto [end, bad] = std::from_chars(given.data(), given.data() + given.size(), port);
  if (bad != std::errc() || end != given.data() + given.size() || port < 1 || port > 65535)
    return error(Trouble::usage, fmt::format("{} is \"{}\"; give a port, 1 to 65535", name, given));
  return port;
}

// The user sets this if a service reports its arms as used although no program uses them.
bool may_be_shared() { return from_environment("BURR_HAPLY_SHARED", "") == "1"; }

// The user sets this if an arm as it is sold should ever tell of a mount or a filter that burr does not know.
bool may_be_turned() { return from_environment("BURR_HAPLY_AS_IT_IS", "") == "1"; }

// Rotation from the service's frame to ours: a quarter turn about x.
const Quat& turn() {
  static const Quat one(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitX()));
  return one;
}
Vec3 ours(const Vec3& v) BURR_RT { return {v.x(), v.z(), -v.y()}; }
Vec3 theirs(const Vec3& v) BURR_RT { return {v.x(), -v.z(), v.y()}; }

}  // namespace

// The connection and its state.
struct Inverse::Connection {
  net::WebSocket line{kLargest};
  bool asked = false;  // the answer is still to come
  Silence silence;
  int nonsense = 0;

  State state;
  Found found;
  Pipeline pipeline;  // what the service does to places and forces
  std::string id;     // with quotes, as JSON
  std::string wanted_grip;
  int version = 0;  // of the service, as read_version()
  const char* key = "vector";
  std::string out;
  double peak = 0;
  std::unique_ptr<Events> events;
  std::string grip;  // the grip whose events are shown

  bool send(const std::string& text) {
    if (!line.send(text)) return false;
    asked = true;
    return true;
  }
  net::WebSocket::Received receive(milliseconds longest) {
    const net::WebSocket::Received what = line.receive(longest);
    if (what != net::WebSocket::Received::message) return what;
    silence.ended(rt::monotonic_ns());
    asked = false;
    return what;
  }
  bool hears() { return receive(kPatience) == net::WebSocket::Received::message; }

  // One exchange. False: the service is gone, or its answer is not valid.
  bool exchange(const Vec3& force) {
    write_force(id, key, force, out);
    return send(out) && hears() && take_state() == haply::Read::state;
  }
  haply::Read take_state() {
    const haply::Read read = read_state(line.text(), found.id, wanted_grip, state);
    if (events && state.grip_id != grip) {
      grip = state.grip_id;
      events->follow_grip(grip);
    }
    return read;
  }

  // True: the service reports back a force that is written with this key.
  bool obeys(const char* with) {
    key = with;
    for (int n = 0; n < kProbes; ++n) {
      if (!exchange({0, 0, kTiny})) return false;
      if (state.force.norm() > kSeen) return true;
    }
    return false;
  }
};

namespace {

// The service's version as it reports it over HTTP; 0: none.
int version_of(const std::string& host, int port) {
  return read_version(net::http_body(host, port, "/version"));
}

}  // namespace

Inverse::Inverse(InverseSettings settings) : settings_(std::move(settings)) {}
Inverse::~Inverse() { disconnect(); }

// Connects and puts the service's first message into connection_.
Status Inverse::reach() {
  connection_.reset();
  host_ = settings_.host.empty() ? from_environment("HAPLY_WS_HOST", "127.0.0.1") : settings_.host;
  std::vector<int> ports(std::begin(kPorts), std::end(kPorts));
  const auto told = port_from_environment("HAPLY_WS_PORT");
  if (!told && settings_.port == 0) return told.error();
  if (settings_.port > 0 || *told > 0) ports = {settings_.port > 0 ? settings_.port : *told};

  std::string trouble;
  int answers = 0;  // the port at which another program answers
  for (const int one : ports) {
    connection_ = std::make_unique<Connection>();
    const std::string why = connection_->line.connect(host_, one);
    port_ = one;
    if (why.empty()) break;
    if (connection_->line.answered()) answers = one;
    trouble += fmt::format("{}{}:{}: {}", trouble.empty() ? "" : ", ", host_, one, why);
    connection_.reset();
  }
  std::vector<Found> nobody_asks;
  if (connection_ && connection_->hears() && read_found(connection_->line.text(), nobody_asks))
    return fine();
  if (connection_) answers = port_;
  connection_.reset();
  if (answers == 0)
    return error(Trouble::io,
                 fmt::format("Haply's Inverse Service does not answer ({}); install and start it, "
                             "or give its address in HAPLY_WS_HOST and HAPLY_WS_PORT",
                             trouble));
  const int version = version_of(host_, answers);
  if (version > 0 && version < kOldest)
    return error(Trouble::io,
                 fmt::format("Haply's Inverse Service at {}:{} is version {}.{}, which uses "
                             "another protocol; install version 3.1 or later",
                             host_, answers, version / 100, version % 100));
  return error(Trouble::io,
               fmt::format("{}:{} is not an Inverse Service of version 3.1 or later; update "
                           "Haply's Inverse Service, or give its port in HAPLY_WS_PORT",
                           host_, answers));
}

// Finds the wanted arm and grip in the first message.
Status Inverse::read_first_state() {
  const Status reached = reach();
  if (!reached) return reached;
  std::vector<Found> all;
  static_cast<void>(read_found(connection_->line.text(), all));
  const auto wanted = std::find_if(all.begin(), all.end(), [this](const Found& one) {
    return settings_.id.empty() || one.id == settings_.id;
  });
  if (wanted == all.end()) {
    std::vector<std::string> known;
    for (const Found& one : all) known.push_back(one.id);
    return error(Trouble::io,
                 all.empty() ? "Haply's Inverse Service finds no arm; plug it in, switch it on, "
                               "and wait for its light"
                             : fmt::format("Haply's Inverse Service finds no arm {}; it finds {}",
                                           settings_.id, fmt::join(known, ", ")));
  }
  const std::vector<std::string> grips = grips_in(connection_->line.text());
  if (!settings_.grip.empty() &&
      std::find(grips.begin(), grips.end(), settings_.grip) == grips.end())
    return error(Trouble::io,
                 fmt::format("Haply's Inverse Service finds no grip {}; {}", settings_.grip,
                             grips.empty() ? std::string("press a button of a grip to wake it")
                                           : fmt::format("it finds {}", fmt::join(grips, ", "))));
  connection_->found = *wanted;
  connection_->id = as_json(wanted->id);
  connection_->wanted_grip = settings_.grip;
  connection_->peak = model_of(wanted->type).peak;
  name_ = wanted->type + " " + wanted->id;
  static_cast<void>(connection_->take_state());
  return fine();
}

// Names this program and finds out which spelling of a force the service takes.
Status Inverse::find_force_key() {
  const auto silent = [this] {
    return error(Trouble::io,
                 fmt::format("{} does not answer; restart Haply's Inverse Service", name_));
  };
  connection_->version = version_of(host_, port_);
  const char* likely = key_of_force(connection_->version);
  const char* other = likely == key_of_force(305) ? key_of_force(301) : key_of_force(305);
  // a service may tell its configuration as it was before the message that changed it
  const bool configures = connection_->version >= kConfigures;
  for (int n = 0; n < kTellings; ++n) {
    if (!connection_->send(greeting(connection_->id, likely, configures)) || !connection_->hears())
      return silent();
    const bool told =
        read_pipeline(connection_->line.text(), connection_->found.id, connection_->pipeline);
    if (!told || in_the_way(connection_->pipeline).empty()) break;
  }
  const std::string what = in_the_way(connection_->pipeline);
  if (!what.empty() && !may_be_turned())
    return error(Trouble::io,
                 fmt::format("Haply's Inverse Service {} between burr and {}, and does not stop "
                             "when asked; reset it in Haply's window, or restart the service "
                             "(docs/use/devices/haply.md)",
                             what, name_));
  if (!connection_->obeys(likely) && !connection_->obeys(other))
    connection_->key = likely;  // an arm at rest reports nothing back
  if (!connection_->exchange(Vec3::Zero())) return silent();
  // so that the first read() has an answer to take
  write_force(connection_->id, connection_->key, Vec3::Zero(), connection_->out);
  if (!connection_->send(connection_->out)) return silent();
  return fine();
}

Result<DeviceSpec> Inverse::connect() {
  disconnect();
  const auto told = port_from_environment("HAPLY_EVENTS_PORT");
  if (!told && settings_.events_port == 0) return told.error();
  const int events_port = settings_.events_port > 0 ? settings_.events_port
                          : *told > 0               ? *told
                                                    : kEventsPort;
  Status met = read_first_state();
  const auto anothers = [&] { return met.ok() && connection_->state.in_use && !may_be_shared(); };
  for (const auto until = std::chrono::steady_clock::now() + kLetGo;
       anothers() && std::chrono::steady_clock::now() < until; met = read_first_state()) {
    connection_.reset();
    std::this_thread::sleep_for(kLookAgain);
  }
  if (anothers())
    met = error(Trouble::io,
                fmt::format("{} is in use by another program; close that program, and look at the "
                            "sessions in Haply's window (docs/use/devices/haply.md)",
                            name_));
  if (met) {
    connection_->events = std::make_unique<Events>(connection_->line.peer(), events_port,
                                                   connection_->found.id, braked_);
    met = find_force_key();
  }
  if (!met) {
    connection_.reset();
    return met.error();
  }

  trouble_ = nullptr;
  const Found& arm = connection_->found;
  const Model& model = model_of(arm.type);
  DeviceSpec spec;
  spec.name = arm.type + (arm.left_handed ? " (left hand)" : "");
  spec.serial = arm.id;
  spec.simulated = false;
  spec.sensed = connection_->state.grip_there ? 6 : 3;
  spec.actuated = 3;
  spec.peak_force = model.peak;
  spec.continuous_force = model.continuous;
  spec.thermal_budget = 5 * model.peak * model.peak;
  spec.max_stiffness = model.stiffness;
  spec.max_damping = model.damping;
  spec.workspace_radius = model.radius;
  spec.native_rate = 1000;
  spec.software = connection_->version > 0
                      ? fmt::format("Inverse Service {}.{}", connection_->version / 100,
                                    connection_->version % 100)
                      : "Inverse Service";
  if (!arm.firmware.empty()) spec.software += ", firmware " + arm.firmware;
  if (connection_->pipeline.force_gate)
    spec.software += fmt::format(", force gate {:g}", *connection_->pipeline.force_gate);
  return spec;
}

Result<DeviceList> list_devices(const InverseSettings& settings) {
  Inverse wire(settings);
  const Status reached = wire.reach();
  if (!reached) return reached.error();
  std::vector<Found> found;
  static_cast<void>(read_found(wire.connection_->line.text(), found));
  DeviceList all;
  for (const Found& one : found) all.arms.push_back({one.id, one.type});
  all.grips = grips_in(wire.connection_->line.text());
  wire.connection_.reset();
  return all;
}

void Inverse::note(const char* words) BURR_RT {
  if (trouble_ != words) ++why_revision_;
  trouble_ = words;
}

Wire::Read Inverse::read(HandState& hand) BURR_RT {
  Connection& connection = *connection_;
  hand.valid = false;
  const net::WebSocket::Received heard = connection.receive(kOneReading);
  if (heard != net::WebSocket::Received::message) {
    if (heard == net::WebSocket::Received::nothing && !connection.silence.lasts(rt::monotonic_ns()))
      return Read::nothing;
    note("has gone silent; check that Haply's Inverse Service runs.");
    return Read::lost;
  }
  switch (connection.take_state()) {
    case haply::Read::gone:
      note("was unplugged; plug it in again.");
      return Read::lost;
    case haply::Read::nonsense:
      note("sends data that burr cannot read; update burr or Haply's Inverse Service.");
      return ++connection.nonsense > kMostNonsense ? Read::lost : Read::hand;
    case haply::Read::state:
      connection.nonsense = 0;
      break;
  }
  const State& state = connection.state;
  hand.world_from_tool.p = ours(state.place);
  hand.velocity = ours(state.velocity);
  static const Quat upright = turn(), handle = turn().conjugate();
  hand.world_from_tool.q =
      state.grip_there ? Quat((turn() * state.grip * handle).normalized()) : upright;
  hand.buttons = state.grip_there ? state.buttons : 0;
  const bool braked = connection.events->braked();
  const char* told = connection.events->words();
  note(braked              ? told
       : !state.calibrated ? "is not calibrated; move it as its lights show."
       : !state.powered    ? "has no power; connect its power supply."
       : !state.ready      ? "is not ready yet; wait for its light."
       : told != nullptr   ? told
       : state.grip_there && !state.grip_awake
           ? "has a grip that is asleep; press one of its buttons."
       : state.grip_there && state.battery < 0.1 ? "has a grip with an empty battery; charge it."
                                                 : nullptr);
  hand.valid = !braked && state.calibrated && state.powered && state.ready &&
               hand.world_from_tool.p.norm() < kFarthest;
  return Read::hand;
}

bool Inverse::write(const Vec3& force) BURR_RT {
  Connection& connection = *connection_;
  if (connection.asked) return true;  // answer still to come; never two messages under way
  write_force(connection.id, connection.key, theirs(bounded(force, connection.peak)),
              connection.out);
  if (connection.send(connection.out)) return true;
  note("can no longer be reached; check that Haply's Inverse Service runs.");
  return false;
}

void Inverse::disconnect() {
  if (!connection_) return;
  Connection& connection = *connection_;
  if (connection.events) braked_ = connection.events->braked();
  if (connection.line.whole()) {
    write_force(connection.id, connection.key, Vec3::Zero(), connection.out);
    static_cast<void>(connection.send(connection.out));
  }
  connection_.reset();
}

std::string Inverse::why() const {
  return trouble_ != nullptr ? name_ + " " + trouble_ : std::string();
}

}  // namespace burr::device::haply
