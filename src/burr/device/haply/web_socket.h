// device/haply/web_socket.h - our end of a WebSocket, and of a question over HTTP: the two ways in
// which Haply's service is spoken to.
//
//     WebSocket line(1 << 20);
//     if (!line.connect("127.0.0.1", 10001).empty()) return;
//     if (line.send(text) && line.receive(2ms) == WebSocket::Heard::message) take(line.text());
//
// Every wait has an end. A message that has not come by then is not given up: the next receive()
// goes on waiting for it. After `lost` nothing more comes; connect() begins anew.
// Thread: one at a time, but stop(). Memory: a message at a time, its room kept for the next.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace burr::device::haply {

class WebSocket {
 public:
  // A longer message ends the connection [byte].
  explicit WebSocket(std::size_t longest);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  // Half a second for each step. Empty: connected; else why not.
  [[nodiscard]] std::string connect(const std::string& host, int port);
  // Somebody listens where connect() looked, whatever he speaks.
  [[nodiscard]] bool answered() const;
  // Who is at the other end, in numbers; empty: nobody.
  [[nodiscard]] std::string peer() const;

  // Half a second at most.
  [[nodiscard]] bool send(const std::string& text);
  enum class Heard { message, nothing, lost };
  [[nodiscard]] Heard receive(std::chrono::milliseconds longest);
  // The message, until the next receive().
  [[nodiscard]] std::string_view text() const;
  // Connected, and neither has failed since.
  [[nodiscard]] bool whole() const;
  void close();

  // So long, or until stop().
  void rest(std::chrono::milliseconds time);
  // Any thread: whatever waits returns at once, and nothing is waited for any more.
  void stop();
  [[nodiscard]] bool stopped() const;

 private:
  struct Line;
  std::unique_ptr<Line> line_;
};

// The body of what is answered, within a second; empty: nothing is.
[[nodiscard]] std::string http_body(const std::string& host, int port, const std::string& target);

}  // namespace burr::device::haply
