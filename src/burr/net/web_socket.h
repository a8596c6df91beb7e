// net/web_socket.h - a client for WebSocket and for one HTTP question: the two ways to
// talk to Haply's service.
//
//     WebSocket line(1 << 20);
//     if (!line.connect("127.0.0.1", 10001).empty()) return;
//     if (line.send(text) && line.receive(2ms) == WebSocket::Received::message) take(line.text());
//
// Every wait has a time limit. A message that has come only in part by then is kept; the next
// receive() continues with it. After `lost` nothing more comes until connect() succeeds again.
// Thread: one at a time; stop() any. Memory: one message at a time; its buffer is kept for the
// next.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace burr::net {

class WebSocket {
 public:
  // longest: a longer message ends the connection [byte].
  explicit WebSocket(std::size_t longest);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  // At most half a second for each step. Empty: connected; otherwise the reason why not.
  [[nodiscard]] std::string connect(const std::string& host, int port);
  // True: something listened at the address of connect(), whatever its protocol.
  [[nodiscard]] bool answered() const;
  // Numeric address of the other end; empty: not connected.
  [[nodiscard]] std::string peer() const;

  // Takes at most half a second. False: the connection is lost.
  [[nodiscard]] bool send(const std::string& text);
  enum class Received { message, nothing, lost };
  [[nodiscard]] Received receive(std::chrono::milliseconds longest);
  // The message that came last; valid until the next receive().
  [[nodiscard]] std::string_view text() const;
  // True: connected, and nothing has failed since.
  [[nodiscard]] bool whole() const;
  void close();

  // Waits for this time, or until stop().
  void rest(std::chrono::milliseconds time);
  // Thread: any. Whatever waits returns at once, and nothing waits any more.
  void stop();
  [[nodiscard]] bool stopped() const;

 private:
  struct Line;
  std::unique_ptr<Line> line_;
};

// The body of the answer, within a second; empty: no answer.
[[nodiscard]] std::string http_body(const std::string& host, int port, const std::string& target);

}  // namespace burr::net
