#include "burr/device/haply/inverse.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "burr/device/haply/message.h"

namespace burr::device::haply {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
namespace net = boost::asio;
using math::Quat;
using math::Vec3;
using Tcp = net::ip::tcp;
using std::chrono::milliseconds;

constexpr milliseconds kPatience(500);         // with a service that is to answer once
constexpr milliseconds kOneReading(2);         // that read() waits
constexpr milliseconds kSilent(200);           // then it is gone
constexpr std::size_t kLargest = 1 << 20;      // of a message  [byte]
constexpr int kMostNonsense = 50;              // messages in a row
constexpr int kProbes = 20;                    // exchanges in which a tiny force must come back
constexpr double kTiny = 0.02, kSeen = 0.005;  // that nobody feels; of it, to be believed  [N]
constexpr double kFarthest = 1;                // no arm is longer  [m]
constexpr int kPorts[] = {10001, 10000};

// Cautious choices: no published figures were at hand for stiffness and damping.
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

// Our frame from the service's: a quarter turn about x.
const Quat& turn() {
  static const Quat one(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitX()));
  return one;
}
Vec3 ours(const Vec3& v) BURR_RT { return {v.x(), v.z(), -v.y()}; }
Vec3 theirs(const Vec3& v) BURR_RT { return {v.x(), -v.z(), v.y()}; }

}  // namespace

// The connection, and what is known through it.
struct Inverse::Talk {
  net::io_context io{1};
  websocket::stream<beast::tcp_stream> stream{io};
  beast::flat_buffer buffer;
  bool reading = false, read_done = false, wrote = false, asked = false;
  beast::error_code read_error, write_error;
  std::chrono::steady_clock::time_point heard;
  int nonsense = 0;

  State state;
  Found found;
  std::string id;  // quoted
  const char* key = "vector";
  std::string out;
  double peak = 0;

  // Lets what is under way go on until `done`, or so long; what is not done then stays under way.
  template <class Done>
  bool run(milliseconds longest, Done done) {
    const auto until = std::chrono::steady_clock::now() + longest;
    while (!done()) {
      const auto now = std::chrono::steady_clock::now();
      if (now >= until) return false;
      io.restart();
      if (io.run_one_for(until - now) == 0 && !done()) return false;
    }
    return true;
  }

  bool send(const std::string& text) {
    wrote = false;
    stream.async_write(net::buffer(text), [this](beast::error_code error, std::size_t) {
      write_error = error;
      wrote = true;
    });
    if (!run(kPatience, [this] { return wrote; }) || write_error) return false;
    asked = true;
    return true;
  }

  // A whole message in `buffer`; false: none yet, or read_error.
  bool receive(milliseconds longest) {
    if (!reading) {
      buffer.consume(buffer.size());
      reading = true;
      read_done = false;
      stream.async_read(buffer, [this](beast::error_code error, std::size_t) {
        read_error = error;
        read_done = true;
      });
    }
    if (!run(longest, [this] { return read_done; })) return false;
    reading = false;
    if (read_error) return false;
    heard = std::chrono::steady_clock::now();
    asked = false;
    return true;
  }
  [[nodiscard]] std::string_view text() const {
    return {static_cast<const char*>(buffer.data().data()), buffer.size()};
  }

  // "": connected
  std::string connect(const std::string& host, int port) {
    Tcp::resolver resolver(io);
    beast::error_code trouble;
    const auto where = resolver.resolve(host, std::to_string(port), trouble);
    if (trouble) return trouble.message();
    bool done = false;
    beast::get_lowest_layer(stream).async_connect(where, [&](beast::error_code error, const auto&) {
      trouble = error;
      done = true;
    });
    if (!run(kPatience, [&] { return done; })) {
      beast::get_lowest_layer(stream).cancel();
      run(kPatience, [&] { return done; });
      return "no answer";
    }
    if (trouble) return trouble.message();
    beast::get_lowest_layer(stream).socket().set_option(Tcp::no_delay(true), trouble);
    stream.read_message_max(kLargest);
    done = false;
    stream.async_handshake(fmt::format("{}:{}", host, port), "/", [&](beast::error_code error) {
      trouble = error;
      done = true;
    });
    if (!run(kPatience, [&] { return done; })) {
      beast::get_lowest_layer(stream).close();
      run(kPatience, [&] { return done; });
      return "no WebSocket";
    }
    return trouble ? trouble.message() : "";
  }

  // One exchange; false: the service is gone, or speaks nonsense.
  bool exchange(const Vec3& force) {
    write_force(id, key, force, out);
    return send(out) && receive(kPatience) &&
           read_state(text(), found.id, state) == haply::Read::state;
  }

  // Whether the service gives back a force that is written with this key.
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

// What the service says of its version over HTTP; 0: nothing.
int version_of(const std::string& host, int port) {
  namespace http = beast::http;
  net::io_context io{1};
  beast::tcp_stream stream(io);
  Tcp::resolver resolver(io);
  beast::error_code trouble;
  const auto where = resolver.resolve(host, std::to_string(port), trouble);
  if (trouble) return 0;
  int version = 0;
  beast::flat_buffer buffer;
  http::request<http::empty_body> ask(http::verb::get, "/version", 11);
  ask.set(http::field::host, host);
  http::response<http::string_body> answer;
  stream.expires_after(kPatience);
  stream.async_connect(where, [&](beast::error_code error, const auto&) {
    if (error) return;
    http::async_write(stream, ask, [&](beast::error_code failed, std::size_t) {
      if (failed) return;
      http::async_read(stream, buffer, answer, [&](beast::error_code bad, std::size_t) {
        if (!bad) version = read_version(answer.body());
      });
    });
  });
  io.run_for(2 * kPatience);
  return version;
}

}  // namespace

Inverse::Inverse(InverseSettings settings) : settings_(std::move(settings)) {}
Inverse::~Inverse() { disconnect(); }

Result<DeviceSpec> Inverse::connect() {
  disconnect();
  const std::string host =
      settings_.host.empty() ? from_environment("HAPLY_WS_HOST", "127.0.0.1") : settings_.host;
  std::vector<int> ports(std::begin(kPorts), std::end(kPorts));
  if (settings_.port > 0) ports = {settings_.port};
  if (const std::string given = from_environment("HAPLY_WS_PORT", "");
      settings_.port == 0 && !given.empty()) {
    int port = 0;
    const auto [end, bad] = std::from_chars(given.data(), given.data() + given.size(), port);
    if (bad != std::errc() || end != given.data() + given.size() || port < 1 || port > 65535)
      return error(Trouble::usage,
                   fmt::format("HAPLY_WS_PORT is \"{}\"; give a port, 1 to 65535", given));
    ports = {port};
  }

  std::string trouble;
  int port = 0;
  for (const int one : ports) {
    talk_ = std::make_unique<Talk>();
    const std::string why = talk_->connect(host, one);
    if (why.empty()) {
      port = one;
      break;
    }
    trouble += fmt::format("{}{}:{}: {}", trouble.empty() ? "" : ", ", host, one, why);
    talk_.reset();
  }
  if (!talk_)
    return error(
        Trouble::io,
        fmt::format("Haply's Inverse Service does not answer ({}); install and start it, or "
                    "say where it is by HAPLY_WS_HOST and HAPLY_WS_PORT",
                    trouble));
  const auto fail = [this](std::string why) {
    talk_.reset();
    return error(Trouble::io, std::move(why));
  };
  std::vector<Found> all;
  if (!talk_->receive(kPatience) || !read_found(talk_->text(), all))
    return fail(
        fmt::format("{}:{} is no Inverse Service of version 3; see HAPLY_WS_PORT", host, port));
  const auto wanted = std::find_if(all.begin(), all.end(), [this](const Found& one) {
    return settings_.id.empty() || one.id == settings_.id;
  });
  if (wanted == all.end()) {
    std::string known;
    for (const Found& one : all) known += (known.empty() ? "" : ", ") + one.id;
    return fail(all.empty() ? "Haply's Inverse Service knows no arm; plug it in, switch it on, and "
                              "wait for its light"
                            : fmt::format("Haply's Inverse Service knows no arm {}; it knows {}",
                                          settings_.id, known));
  }
  talk_->found = *wanted;
  talk_->id = as_json(wanted->id);
  const Model& model = model_of(wanted->type);
  talk_->peak = model.peak;
  name_ = wanted->type + " " + wanted->id;
  static_cast<void>(read_state(talk_->text(), wanted->id, talk_->state));

  const char* likely = key_of_force(version_of(host, port));
  const char* other = likely == key_of_force(305) ? key_of_force(301) : key_of_force(305);
  if (!talk_->send(greeting(talk_->id, likely)) || !talk_->receive(kPatience))
    return fail(fmt::format("{} does not answer; restart Haply's Inverse Service", name_));
  if (!talk_->obeys(likely) && !talk_->obeys(other))
    talk_->key = likely;  // an arm that rests gives nothing back
  if (!talk_->exchange(Vec3::Zero()))
    return fail(fmt::format("{} does not answer; restart Haply's Inverse Service", name_));
  if (!talk_->send(greeting(talk_->id, talk_->key)))  // so that the first read() has its answer
    return fail(fmt::format("{} does not answer; restart Haply's Inverse Service", name_));

  trouble_ = nullptr;
  DeviceSpec spec;
  spec.name = wanted->type + (wanted->left_handed ? " (left hand)" : "");
  spec.serial = wanted->id;
  spec.simulated = false;
  spec.sensed = talk_->state.grip_there ? 6 : 3;
  spec.actuated = 3;
  spec.peak_force = model.peak;
  spec.continuous_force = model.continuous;
  spec.thermal_budget = 5 * model.peak * model.peak;
  spec.max_stiffness = model.stiffness;
  spec.max_damping = model.damping;
  spec.workspace_radius = model.radius;
  spec.native_rate = 1000;
  return spec;
}

void Inverse::note(const char* words) BURR_RT {
  if (trouble_ != words) ++told_;
  trouble_ = words;
}

Wire::Read Inverse::read(HandState& hand) BURR_RT {
  Talk& talk = *talk_;
  hand.valid = false;
  if (!talk.receive(kOneReading)) {
    if (!talk.read_done && std::chrono::steady_clock::now() - talk.heard < kSilent)
      return Read::nothing;
    note("has gone silent; see that Haply's Inverse Service runs.");
    return Read::lost;
  }
  switch (read_state(talk.text(), talk.found.id, talk.state)) {
    case haply::Read::gone:
      note("was unplugged; plug it in again.");
      return Read::lost;
    case haply::Read::nonsense:
      note("says what cannot be read; update burr or Haply's Inverse Service.");
      return ++talk.nonsense > kMostNonsense ? Read::lost : Read::hand;
    case haply::Read::state:
      talk.nonsense = 0;
      break;
  }
  const State& state = talk.state;
  hand.world_from_tool.p = ours(state.place);
  hand.velocity = ours(state.velocity);
  static const Quat upright = turn(), handle = turn().conjugate();
  hand.world_from_tool.q =
      state.grip_there ? Quat((turn() * state.grip * handle).normalized()) : upright;
  hand.buttons = state.grip_there ? state.buttons : 0;
  const bool ready = state.calibrated && state.powered && state.ready;
  note(!state.calibrated                       ? "is not calibrated; move it as its lights ask."
       : !state.powered                        ? "has no power; connect its supply."
       : !state.ready                          ? "is not ready yet; wait for its light."
       : state.grip_there && !state.grip_awake ? "has a grip that sleeps; press one of its buttons."
       : state.grip_there && state.battery < 0.1 ? "has a grip with an empty battery; charge it."
                                                 : nullptr);
  hand.valid = ready && hand.world_from_tool.p.norm() < kFarthest;
  return Read::hand;
}

bool Inverse::write(const Vec3& force) BURR_RT {
  Talk& talk = *talk_;
  if (talk.asked) return true;  // its answer is still to come; never two under way
  write_force(talk.id, talk.key, theirs(bounded(force, talk.peak)), talk.out);
  if (talk.send(talk.out)) return true;
  note("cannot be reached any more; see that Haply's Inverse Service runs.");
  return false;
}

void Inverse::disconnect() {
  if (!talk_) return;
  Talk& talk = *talk_;
  if (!talk.read_error && !talk.write_error) {
    write_force(talk.id, talk.key, Vec3::Zero(), talk.out);
    static_cast<void>(talk.send(talk.out));
  }
  beast::get_lowest_layer(talk.stream).close();
  talk.run(kPatience, [&talk] { return !talk.reading || talk.read_done; });
  talk_.reset();
}

std::string Inverse::why() const {
  return trouble_ != nullptr ? name_ + " " + trouble_ : std::string();
}

}  // namespace burr::device::haply
