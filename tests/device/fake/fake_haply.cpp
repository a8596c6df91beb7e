#include "device/fake/fake_haply.h"

#include <sys/socket.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <utility>

namespace burr::test {

using Json = nlohmann::json;

// Both servers, with a thread for each and one for every client.
struct FakeHaply::Servers {
  using Tcp = boost::asio::ip::tcp;

  explicit Servers(FakeHaply& of)
      : fake(of),
        acceptor_(io_, {boost::asio::ip::address_v4::loopback(), 0}),
        events_acceptor_(io_, {boost::asio::ip::address_v4::loopback(), 0}) {
    fake.port = acceptor_.local_endpoint().port();
    fake.events_port = events_acceptor_.local_endpoint().port();
    thread_ = std::thread([this] { serve(acceptor_, &Servers::talk); });
    events_thread_ = std::thread([this] { serve(events_acceptor_, &Servers::tell_all); });
  }
  ~Servers() {
    stop_ = true;
    ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
    ::shutdown(events_acceptor_.native_handle(), SHUT_RDWR);
    drop();
    thread_.join();
    events_thread_.join();
    for (std::thread& one : talks_) one.join();
  }
  Servers(const Servers&) = delete;
  Servers& operator=(const Servers&) = delete;

  void drop() {
    const std::lock_guard lock(fake.mutex_);
    for (const int one : open_) ::shutdown(one, SHUT_RDWR);
  }

  template <class F>
  auto with(F change) {
    return fake.with(change);
  }

  void serve(Tcp::acceptor& acceptor, void (Servers::*speak)(Tcp::socket)) {
    while (!stop_) {
      boost::system::error_code trouble;
      Tcp::socket socket(io_);
      acceptor.accept(socket, trouble);
      if (trouble) continue;
      socket.set_option(Tcp::no_delay(true), trouble);
      const std::lock_guard lock(fake.mutex_);
      if (stop_) return;
      open_.push_back(socket.native_handle());
      talks_.emplace_back([this, speak, taken = std::make_shared<Tcp::socket>(std::move(socket))] {
        const int handle = taken->native_handle();
        (this->*speak)(std::move(*taken));
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
    if (!beast::websocket::is_upgrade(ask) || !with([](Commands& w) { return w.web_socket; }))
      return answer_http(socket, std::string(ask.target()));
    beast::websocket::stream<Tcp::socket> stream(std::move(socket));
    stream.accept(ask, trouble);
    if (trouble) return;
    ++fake.sessions;
    std::set<std::string> held;
    converse(stream, held);
    const std::lock_guard lock(fake.mutex_);
    for (const std::string& arm : held) --holders_[arm];
  }

  template <class Stream>
  void converse(Stream& stream, std::set<std::string>& held) {
    namespace beast = boost::beast;
    boost::system::error_code trouble;
    const std::string greets = with([](Commands& w) { return w.greets; });
    if (!send(stream, greets.empty() ? state(true) : greets)) return;
    while (!stop_) {
      beast::flat_buffer message;
      stream.read(message, trouble);
      if (trouble) return;
      ++fake.messages;
      obey(beast::buffers_to_string(message.data()), held);
      int stall = 0;
      bool silent = false, pings = false, hang_up = false;
      std::string answer;
      with([&](Commands& w) {
        std::swap(stall, w.stall_ms);
        stall += w.pace_ms;
        silent = w.silent;
        pings = w.pings;
        std::swap(hang_up, w.hang_up);
        if (!w.instead.empty()) {
          answer = w.instead.front();
          w.instead.pop_front();
        }
      });
      if (hang_up) return;
      if (silent) continue;
      if (stall > 0) std::this_thread::sleep_for(std::chrono::milliseconds(stall));
      if (pings) stream.ping({}, trouble);
      if (!send(stream, answer.empty() ? state(false) : answer)) return;
    }
  }

  // Sends the events from now on, until the client or the test ends.
  void tell_all(Tcp::socket socket) {
    boost::beast::websocket::stream<Tcp::socket> stream(std::move(socket));
    boost::system::error_code trouble;
    stream.accept(trouble);
    if (trouble) return;
    std::size_t next = with([](Commands& w) { return w.events.size(); });
    ++fake.listeners;
    ++fake.listened;
    while (!stop_) {
      std::shared_ptr<const std::string> text;
      bool hang_up = false;
      with([&](Commands& w) {
        std::swap(hang_up, w.events_hang_up);
        if (next < w.events.size()) text = w.events[next++];
      });
      char seen = 0;
      const bool gone =
          ::recv(stream.next_layer().native_handle(), &seen, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
      if (hang_up || gone || (text != nullptr && !send(stream, *text))) break;
      if (text == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    --fake.listeners;
  }

  void answer_http(Tcp::socket& socket, const std::string& target) {
    namespace http = boost::beast::http;
    const std::string version = with([](Commands& w) { return w.version; });
    http::response<http::string_body> answer;
    if (target == "/version" && !version.empty()) {
      answer.body() = Json{{"ok", true}, {"data", {{"project_version", version}}}}.dump();
    } else {
      answer.result(http::status::not_found);
    }
    answer.prepare_payload();
    boost::system::error_code trouble;
    http::write(socket, answer, trouble);
  }

  template <class Stream>
  bool send(Stream& stream, const std::string& text) {
    boost::system::error_code trouble;
    const bool fragments = with([](Commands& w) { return w.fragments; });
    stream.auto_fragment(fragments);
    stream.write_buffer_bytes(fragments ? 16 : 4096);
    stream.text(true);
    stream.write(boost::asio::buffer(text), trouble);
    return !trouble;
  }

  static Json xyz(const math::Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

  std::string state(bool first) {
    return with([&](Commands& w) {
      Json all = {{"session_id", 7}, {"inverse3", Json::array()}};
      for (Arm& arm : w.arms) {
        arm.answers.tell(arm.place.data());
        Json one = {{"device_id", arm.id},
                    {"status",
                     {{"calibrated", arm.calibrated},
                      {"power_supply", arm.powered},
                      {"ready", true},
                      {"in_use", arm.in_use || holders_[arm.id] > 0}}}};
        one["state"] = {{"cursor_position", xyz(arm.place)},
                        {"cursor_velocity", xyz(arm.velocity)}};
        if (!w.leaves_out || arm.force != math::Vec3::Zero())
          one["state"]["current_cursor_force"] = xyz(arm.force);
        if (w.leaves_out && arm.place == math::Vec3::Zero()) one["state"].erase("cursor_position");
        if (first)
          one["config"] = {{"type", arm.type},
                           {"handedness", arm.left ? "left" : "right"},
                           {"device_info", {{"major_version", 7}, {"minor_version", 4}}}};
        all["inverse3"].push_back(one);
      }
      if (w.grip)
        all["wireless_verse_grip"].push_back(
            grip_state(w, {"GRIP", w.orientation, w.buttons, true}, w.grip_awake));
      for (const Grip& grip : w.more_grips)
        all["wireless_verse_grip"].push_back(grip_state(w, grip, true));
      return all.dump();
    });
  }

  static Json grip_state(const Commands& w, const Grip& grip, bool awake) {
    Json buttons;
    for (unsigned n = 0; n < 3; ++n)
      buttons[w.names_of_buttons == "abc" ? std::string(1, static_cast<char>('a' + n))
                                          : "button_" + std::to_string(n)] =
          (grip.buttons >> n & 1U) != 0;
    const math::Quat& q = grip.orientation;
    return {{"device_id", grip.id},
            {"state",
             {{"orientation", {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}},
              {"buttons", buttons},
              {"battery_level", 0.8}}},
            {"status", {{"connected", grip.connected}, {"awake", awake}}}};
  }

  void obey(const std::string& text, std::set<std::string>& held) {
    const Json all = Json::parse(text, nullptr, false);
    if (!all.is_object() || !all.contains("inverse3")) {
      ++fake.unreadable;
      return;
    }
    with([&](Commands& w) {
      for (const Json& asked : all["inverse3"])
        for (Arm& arm : w.arms) {
          if (asked.value("device_id", "") != arm.id) continue;
          if (held.insert(arm.id).second) ++holders_[arm.id];
          const Json force = asked.value("/commands/set_cursor_force"_json_pointer, Json());
          if (!force.is_object() || !force.contains(w.key)) continue;  // has no effect
          const Json& v = force[w.key];
          arm.force = {v.at("x").get<double>(), v.at("y").get<double>(), v.at("z").get<double>()};
          arm.answers.take(arm.force.data());
          const double size = arm.force.norm();
          if (!(size <= arm.largest)) arm.largest = size;
        }
    });
  }

  FakeHaply& fake;
  boost::asio::io_context io_;
  Tcp::acceptor acceptor_, events_acceptor_;
  std::map<std::string, int> holders_;  // number of sessions that command an arm
  std::vector<int> open_;
  std::vector<std::thread> talks_;
  std::atomic<bool> stop_ = false;
  std::thread thread_, events_thread_;
};

FakeHaply::FakeHaply() : servers_(std::make_unique<Servers>(*this)) {}
FakeHaply::~FakeHaply() = default;

void FakeHaply::drop() { servers_->drop(); }

namespace {

std::string told(const std::string& name, const std::string& device, const std::string& level,
                 Json data) {
  if (!device.empty()) data["device_id"] = device;
  return Json{{"name", name},
              {"category", "device"},
              {"level", level},
              {"data", data},
              {"message", "as it is told"}}
      .dump();
}

}  // namespace

void FakeHaply::tell(const std::string& name, const std::string& device, const std::string& level) {
  tell_text(told(name, device, level, Json::object()));
}
void FakeHaply::tell_safety(const std::string& type, const std::string& device) {
  tell_text(told("device-safety-triggered", device, "critical", {{"safety_type", type}}));
}
void FakeHaply::tell_text(std::string text) {
  auto shared = std::make_shared<const std::string>(std::move(text));
  const std::lock_guard lock(mutex_);
  commands_.events.push_back(std::move(shared));
}

}  // namespace burr::test
