// An Inverse Service without a device: a WebSocket server that answers each message with one state,
// as the maker's pages say, and misbehaves as a test wishes.
#pragma once

#include <sys/socket.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <deque>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "burr/math/vec3.h"
#include "device/fake/answers.h"

namespace burr::test {

class FakeHaply {
 public:
  struct Arm {
    std::string id = "049D", type = "inverse3";
    math::Vec3 place = math::Vec3::Zero(), velocity = math::Vec3::Zero();
    bool calibrated = true, powered = true;
    math::Vec3 force = math::Vec3::Zero();  // as asked for last
    double largest = 0;                     // of all
    Answers answers;
  };
  struct Wishes {
    std::vector<Arm> arms = {{}};
    bool grip = true;
    bool grip_awake = true;
    math::Quat orientation = math::Quat::Identity();
    std::string names_of_buttons = "abc";  // or "button_"
    unsigned buttons = 0;
    std::string version = "3.5.0";  // empty: /version is not known
    std::string key = "vector";     // of a force; another is not obeyed
    bool silent = false;            // takes messages and does not answer
    int stall_ms = 0;               // the next answer comes so much later, once
    bool fragments = false, pings = false;
    std::deque<std::string> instead;  // the next answers, whatever they are
    bool hang_up = false;
    bool leaves_out = false;  // what is as it was
  };

  FakeHaply() : acceptor_(io_, {boost::asio::ip::address_v4::loopback(), 0}) {
    port = acceptor_.local_endpoint().port();
    thread_ = std::thread([this] { serve(); });
  }
  ~FakeHaply() {
    stop_ = true;
    ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
    drop();
    thread_.join();
    for (std::thread& one : talks_) one.join();
  }
  FakeHaply(const FakeHaply&) = delete;
  FakeHaply& operator=(const FakeHaply&) = delete;

  // Changes what it does, or looks.
  template <class F>
  auto with(F change) {
    const std::lock_guard lock(mutex_);
    return change(wishes_);
  }
  // Cuts every connection.
  void drop() {
    const std::lock_guard lock(mutex_);
    for (const int one : open_) ::shutdown(one, SHUT_RDWR);
  }

  int port = 0;
  std::atomic<int> messages = 0, sessions = 0, unreadable = 0;

 private:
  using Tcp = boost::asio::ip::tcp;
  using Json = nlohmann::json;

  void serve() {
    while (!stop_) {
      boost::system::error_code trouble;
      Tcp::socket socket(io_);
      acceptor_.accept(socket, trouble);
      if (trouble) continue;
      const std::lock_guard lock(mutex_);
      if (stop_) return;
      open_.push_back(socket.native_handle());
      talks_.emplace_back([this, taken = std::make_shared<Tcp::socket>(std::move(socket))] {
        const int handle = taken->native_handle();
        talk(std::move(*taken));
        const std::lock_guard done(mutex_);
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
    if (!beast::websocket::is_upgrade(ask)) return answer_http(socket, std::string(ask.target()));
    beast::websocket::stream<Tcp::socket> stream(std::move(socket));
    stream.accept(ask, trouble);
    if (trouble) return;
    ++sessions;
    if (!send(stream, state(true))) return;
    while (!stop_) {
      beast::flat_buffer message;
      stream.read(message, trouble);
      if (trouble) return;
      ++messages;
      obey(beast::buffers_to_string(message.data()));
      int stall = 0;
      bool silent = false, pings = false, hang_up = false;
      std::string answer;
      with([&](Wishes& w) {
        std::swap(stall, w.stall_ms);
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

  void answer_http(Tcp::socket& socket, const std::string& target) {
    namespace http = boost::beast::http;
    const std::string version = with([](Wishes& w) { return w.version; });
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
    const bool fragments = with([](Wishes& w) { return w.fragments; });
    stream.auto_fragment(fragments);
    stream.write_buffer_bytes(fragments ? 16 : 4096);
    stream.text(true);
    stream.write(boost::asio::buffer(text), trouble);
    return !trouble;
  }

  static Json xyz(const math::Vec3& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

  std::string state(bool first) {
    return with([&](Wishes& w) {
      Json all = {{"session_id", 7}, {"inverse3", Json::array()}};
      for (Arm& arm : w.arms) {
        arm.answers.tell(arm.place.data());
        Json one = {
            {"device_id", arm.id},
            {"status",
             {{"calibrated", arm.calibrated}, {"power_supply", arm.powered}, {"ready", true}}}};
        one["state"] = {{"cursor_position", xyz(arm.place)},
                        {"cursor_velocity", xyz(arm.velocity)}};
        if (!w.leaves_out || arm.force != math::Vec3::Zero())
          one["state"]["current_cursor_force"] = xyz(arm.force);
        if (w.leaves_out && arm.place == math::Vec3::Zero()) one["state"].erase("cursor_position");
        if (first)
          one["config"] = {{"type", arm.type},
                           {"handedness", "right"},
                           {"device_info", {{"major_version", 7}, {"minor_version", 4}}}};
        all["inverse3"].push_back(one);
      }
      if (w.grip) {
        Json buttons;
        for (unsigned n = 0; n < 3; ++n)
          buttons[w.names_of_buttons == "abc" ? std::string(1, static_cast<char>('a' + n))
                                              : "button_" + std::to_string(n)] =
              (w.buttons >> n & 1U) != 0;
        const math::Quat& q = w.orientation;
        all["wireless_verse_grip"] = {
            {{"device_id", "GRIP"},
             {"state",
              {{"orientation", {{"w", q.w()}, {"x", q.x()}, {"y", q.y()}, {"z", q.z()}}},
               {"buttons", buttons},
               {"battery_level", 0.8}}},
             {"status", {{"connected", true}, {"awake", w.grip_awake}}}}};
      }
      return all.dump();
    });
  }

  void obey(const std::string& text) {
    const Json all = Json::parse(text, nullptr, false);
    if (!all.is_object() || !all.contains("inverse3")) {
      ++unreadable;
      return;
    }
    with([&](Wishes& w) {
      for (const Json& asked : all["inverse3"])
        for (Arm& arm : w.arms) {
          if (asked.value("device_id", "") != arm.id) continue;
          const Json force = asked.value("/commands/set_cursor_force"_json_pointer, Json());
          if (!force.is_object() || !force.contains(w.key)) continue;  // not obeyed
          const Json& v = force[w.key];
          arm.force = {v.at("x").get<double>(), v.at("y").get<double>(), v.at("z").get<double>()};
          arm.answers.take(arm.force.data());
          const double size = arm.force.norm();
          if (!(size <= arm.largest)) arm.largest = size;
        }
    });
  }

  boost::asio::io_context io_;
  Tcp::acceptor acceptor_;
  std::mutex mutex_;
  Wishes wishes_;
  std::vector<int> open_;
  std::vector<std::thread> talks_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace burr::test
