#include "device/fake/fake_haply_35.h"

#include <sys/socket.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <thread>
#include <utility>
#include <vector>

namespace burr::test {

using Json = nlohmann::json;
using math::Mat3;
using math::Quat;
using math::Vec3;

namespace {

Json xyz(const Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }
Json turn(const Quat& q) { return {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}; }
Vec3 vector_in(const Json& v) {
  return {v.at("x").get<double>(), v.at("y").get<double>(), v.at("z").get<double>()};
}

// "X-YZ": our axes, each as one of the arm's, perhaps turned round.
Mat3 axes_of(const std::string& basis) {
  Mat3 out = Mat3::Zero();
  int row = 0;
  double sign = 1;
  for (const char c : basis) {
    if (c == '-') sign = -1;
    if (c < 'X' || c > 'Z') continue;
    out(row++, c - 'X') = sign;
    sign = 1;
  }
  return out;
}

}  // namespace

struct FakeHaply35::Server {
  using Tcp = boost::asio::ip::tcp;

  explicit Server(FakeHaply35& of)
      : fake(of), acceptor_(io_, {boost::asio::ip::address_v4::loopback(), 0}) {
    fake.port = acceptor_.local_endpoint().port();
    thread_ = std::thread([this] { serve(); });
  }
  ~Server() {
    stop_ = true;
    ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
    {
      const std::lock_guard lock(fake.mutex_);
      for (const int one : open_) ::shutdown(one, SHUT_RDWR);
    }
    thread_.join();
    for (std::thread& one : talks_) one.join();
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void serve() {
    while (!stop_) {
      boost::system::error_code trouble;
      Tcp::socket socket(io_);
      acceptor_.accept(socket, trouble);
      if (trouble) continue;
      const std::lock_guard lock(fake.mutex_);
      if (stop_) return;
      open_.push_back(socket.native_handle());
      talks_.emplace_back([this, taken = std::make_shared<Tcp::socket>(std::move(socket))] {
        const int handle = taken->native_handle();
        talk(std::move(*taken));
        const std::lock_guard done(fake.mutex_);
        std::erase(open_, handle);
      });
    }
  }

  void talk(Tcp::socket socket) {
    namespace beast = boost::beast;
    namespace http = beast::http;
    beast::flat_buffer buffer;
    http::request<http::string_body> ask;
    boost::system::error_code trouble;
    http::read(socket, buffer, ask, trouble);
    if (trouble) return;
    if (!beast::websocket::is_upgrade(ask)) {
      http::response<http::string_body> answer;
      answer.body() = Json{{"git_tag", "3.5.0"}, {"project_version", "3.5.0.0"}}.dump();
      answer.prepare_payload();
      http::write(socket, answer, trouble);
      return;
    }
    beast::websocket::stream<Tcp::socket> stream(std::move(socket));
    stream.accept(ask, trouble);
    if (trouble) return;
    stream.text(true);
    fake.with([](Commands& w) { w.now = w.begins; });
    std::string answer = tell(true);
    while (!stop_) {
      stream.write(boost::asio::buffer(answer), trouble);
      if (trouble) return;
      beast::flat_buffer message;
      stream.read(message, trouble);
      if (trouble) return;
      answer = obey(beast::buffers_to_string(message.data()));
    }
  }

  // The state as the session sees it.
  std::string tell(bool whole) {
    return fake.with([&](Commands& w) {
      const Pipeline& p = w.now;
      const Mat3 axes = axes_of(p.basis);
      const Vec3 mounted = p.mount.p + p.mount.q * Vec3(w.arm.place.cwiseProduct(p.scale));
      const Vec3 place = p.workspace.p + p.workspace.q * Vec3(axes * mounted);
      Json arm = {{"device_id", "049D"},
                  {"state",
                   {{"cursor_position", xyz(place)},
                    {"cursor_velocity", xyz(Vec3::Zero())},
                    {"current_cursor_force", xyz(axes * w.arm.force)},
                    {"control_domain", "cartesian"},
                    {"transform",
                     {{"position", xyz(p.workspace.p)},
                      {"rotation", turn(p.workspace.q)},
                      {"scale", xyz(Vec3::Ones())}}}}},
                  {"status",
                   {{"calibrated", true},
                    {"power_supply", true},
                    {"ready", true},
                    {"started", true},
                    {"in_use", false}}}};
      if (whole)
        arm["config"] = {
            {"type", "inverse3"},
            {"port", "/dev/ttyACM0"},
            {"device_info", {{"major_version", 7}, {"minor_version", 4}}},
            {"gravity_compensation", {{"enabled", true}, {"scaling_factor", 1.0}}},
            {"handedness", "right"},
            {"torque_scaling", {{"enabled", true}}},
            {"preset", p.preset},
            {"basis", {{"permutation", p.basis}}},
            {"mount",
             {{"position", xyz(p.mount.p)},
              {"rotation", turn(p.mount.q)},
              {"scale", xyz(p.scale)}}},
            {"filters",
             {{"force_gate", {{"gain", p.force_gate}}},
              {"damping", {{"scalar", p.damping}, {"vector", xyz(p.damping_along)}}}}}};
      return Json{{"session_id", 7}, {"inverse3", {arm}}}.dump();
    });
  }

  std::string obey(const std::string& text) {
    const Json all = Json::parse(text, nullptr, false);
    bool whole = false;
    std::string before;
    if (fake.with([](Commands& w) { return w.late; })) before = tell(true);
    fake.with([&](Commands& w) {
      if (w.first.empty()) w.first = text;
      if (const Json session = all.value("session", Json::object()); session.is_object()) {
        whole = session.contains("force_render_full_state");
        const auto basis = "/configure/basis/permutation"_json_pointer;
        if (session.contains(basis) && !w.stubborn) w.now.basis = session.at(basis);
      }
      for (const Json& arm : all.value("inverse3", Json::array())) {
        if (arm.value("device_id", "") != "049D") continue;
        if (const auto found = arm.find("configure"); found != arm.end() && !w.stubborn)
          configure(*found, w);
        const auto force = "/commands/set_cursor_force/vector"_json_pointer;
        if (!arm.contains(force)) continue;
        // from the session's axes to the arm's; the gate weakens what swings, which nothing here does
        w.arm.force = axes_of(w.now.basis).transpose() * vector_in(arm.at(force));
      }
    });
    return whole && !before.empty() ? before : tell(whole);
  }

  static void configure(const Json& asked, Commands& w) {
    if (asked.contains("preset") && asked.contains("mount")) {
      ++w.refused;
      return;
    }
    Pipeline& p = w.now;
    if (asked.contains("preset")) {  // mount, basis and origin in one
      p.preset = asked["preset"].at("preset");
      p.mount = {};
      p.scale = Vec3::Ones();
      p.workspace = {};
      p.basis = "XYZ";
    }
    if (asked.contains("damping")) {
      p.damping = asked["damping"].value("scalar", p.damping);
      if (asked["damping"].contains("vector"))
        p.damping_along = vector_in(asked["damping"]["vector"]);
    }
    if (asked.contains("force_gate")) p.force_gate = asked["force_gate"].at("gain");
  }

  FakeHaply35& fake;
  boost::asio::io_context io_;
  Tcp::acceptor acceptor_;
  std::vector<int> open_;
  std::vector<std::thread> talks_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

FakeHaply35::FakeHaply35() : server_(std::make_unique<Server>(*this)) {}
FakeHaply35::~FakeHaply35() = default;

}  // namespace burr::test
