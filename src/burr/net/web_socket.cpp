#include "burr/net/web_socket.h"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>
#include <utility>

namespace burr::net {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
namespace asio = boost::asio;
using Tcp = asio::ip::tcp;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kPatience(500);  // for an answer of the other end

}  // namespace

struct WebSocket::Line {
  std::size_t longest = 0;
  asio::io_context io{1};
  asio::executor_work_guard<asio::io_context::executor_type> stays{asio::make_work_guard(io)};
  std::optional<websocket::stream<beast::tcp_stream>> stream;
  beast::flat_buffer buffer;
  std::string out;
  bool reading = false, writing = false;  // an operation is under way
  bool failed = true;                     // not connected, or no longer
  bool answered = false;
  beast::error_code read_error;
  std::atomic<bool> stop = false;

  // Runs the operations under way until done() or for this time; what is not done then stays under
  // way.
  template <class Done>
  bool run(milliseconds time, Done done) {
    const auto until = steady_clock::now() + time;
    while (!done()) {
      const auto now = steady_clock::now();
      if (stop || now >= until) return false;
      io.run_one_for(until - now);
    }
    return true;
  }
  // One step of connecting. Empty: it succeeded.
  template <class Begin>
  std::string step(const char* late, Begin begin) {
    bool done = false;
    beast::error_code trouble;
    begin([&done, &trouble](beast::error_code error, auto&&...) {
      trouble = error;
      done = true;
    });
    if (run(kPatience, [&done] { return done; })) return trouble ? trouble.message() : "";
    beast::get_lowest_layer(*stream).close();
    while (!done) io.run_one();
    return late;
  }
  void close() {
    if (!stream) return;
    failed = true;
    beast::get_lowest_layer(*stream).close();
    while (reading || writing) io.run_one();  // a closed operation ends at once
  }
};

WebSocket::WebSocket(std::size_t longest) : line_(std::make_unique<Line>()) {
  line_->longest = longest;
}
WebSocket::~WebSocket() { close(); }

std::string WebSocket::connect(const std::string& host, int port) {
  Line& line = *line_;
  line.close();
  line.answered = false;
  if (host.empty()) return "no address";
  line.stream.emplace(line.io);
  line.stream->read_message_max(line.longest);
  line.buffer.consume(line.buffer.size());
  beast::error_code trouble;
  const auto where = Tcp::resolver(line.io).resolve(host, std::to_string(port), trouble);
  if (trouble) return trouble.message();
  auto& below = beast::get_lowest_layer(*line.stream);
  if (std::string why =
          line.step("no answer", [&](auto then) { below.async_connect(where, std::move(then)); });
      !why.empty())
    return why;
  line.answered = true;
  below.socket().set_option(Tcp::no_delay(true), trouble);
  const std::string name = fmt::format("{}:{}", host, port);
  const std::string why = line.step(
      "no WebSocket", [&](auto then) { line.stream->async_handshake(name, "/", std::move(then)); });
  line.failed = !why.empty();
  return line.failed ? "no WebSocket" : "";
}

bool WebSocket::answered() const { return line_->answered; }

std::string WebSocket::peer() const {
  if (!line_->stream) return "";
  beast::error_code trouble;
  const auto end = beast::get_lowest_layer(*line_->stream).socket().remote_endpoint(trouble);
  return trouble ? "" : end.address().to_string();
}

bool WebSocket::send(const std::string& text) {
  Line& line = *line_;
  if (line.writing || line.failed) return false;
  line.out = text;
  line.writing = true;
  line.stream->async_write(asio::buffer(line.out), [&line](beast::error_code error, std::size_t) {
    line.failed = line.failed || error;
    line.writing = false;
  });
  return line.run(kPatience, [&line] { return !line.writing; }) && !line.failed;
}

WebSocket::Received WebSocket::receive(milliseconds longest) {
  Line& line = *line_;
  if (line.failed) return Received::lost;
  if (!line.reading) {
    line.buffer.consume(line.buffer.size());
    line.reading = true;
    line.stream->async_read(line.buffer, [&line](beast::error_code error, std::size_t) {
      line.read_error = error;
      line.reading = false;
    });
  }
  if (line.run(longest, [&line] { return !line.reading; })) {
    line.failed = line.failed || line.read_error;
    return line.failed ? Received::lost : Received::message;
  }
  // hang up on data that is no message, without waiting for the other end to agree
  line.failed = line.failed || line.stop || !line.stream->is_open();
  return line.failed ? Received::lost : Received::nothing;
}

std::string_view WebSocket::text() const {
  return {static_cast<const char*>(line_->buffer.data().data()), line_->buffer.size()};
}

bool WebSocket::whole() const { return !line_->failed; }
void WebSocket::close() { line_->close(); }

void WebSocket::rest(milliseconds time) {
  static_cast<void>(line_->run(time, [] { return false; }));
}
void WebSocket::stop() {
  line_->stop = true;
  asio::post(line_->io, [] {});  // wakes the waiting thread
}
bool WebSocket::stopped() const { return line_->stop; }

std::string http_body(const std::string& host, int port, const std::string& target) {
  namespace http = beast::http;
  asio::io_context io{1};
  beast::tcp_stream stream(io);
  beast::error_code trouble;
  const auto where = Tcp::resolver(io).resolve(host, std::to_string(port), trouble);
  if (trouble) return "";
  std::string body;
  beast::flat_buffer buffer;
  http::request<http::empty_body> ask(http::verb::get, target, 11);
  ask.set(http::field::host, host);
  http::response<http::string_body> answer;
  stream.expires_after(kPatience);
  stream.async_connect(where, [&](beast::error_code error, const auto&) {
    if (error) return;
    http::async_write(stream, ask, [&](beast::error_code failed, std::size_t) {
      if (failed) return;
      http::async_read(stream, buffer, answer, [&](beast::error_code bad, std::size_t) {
        if (!bad) body = std::move(answer.body());
      });
    });
  });
  io.run_for(2 * kPatience);
  return body;
}

}  // namespace burr::net
