// net/http_server.h - a small web server for one centre's page (HTTP/1.1, with TLS where a certificate is given).
//
//     auto server = HttpServer::open(door, [&](const Request& request) { return answer(request); });
//     (*server)->run();            // until stop(), from any thread or a signal
//
// No file is read by a path of a request, no upload is kept. A request has a head of at most 16 KiB and a body of at most
// 64 KiB, and must arrive within Door::wait_s; at most 128 connections are open, further ones are closed at once.
// Thread: run() in one; the answers are made there, one after the other. An answer that throws becomes 500.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/net/request.h"

namespace burr::net {

struct Door {
  std::string address = "127.0.0.1";
  unsigned short port = 0;       // 0: any that is free
  std::string certificate, key;  // PEM files; both or none
  double wait_s = 15;            // for a whole request, and between two
};

using Answering = std::function<Response(const Request&)>;

class HttpServer {
 public:
  // Error: the address is not one of this computer, the port is in use, or certificate and key do not fit.
  [[nodiscard]] static Result<std::unique_ptr<HttpServer>> open(const Door& door, Answering answer);
  virtual ~HttpServer() = default;

  [[nodiscard]] virtual unsigned short port() const = 0;
  virtual void run() = 0;
  virtual void stop() = 0;  // thread: any; not from a signal's handler
  // These signals end run(). Call it once, before run().
  virtual void stop_at_signals(const std::vector<int>& signals) = 0;
};

// An address of the computer itself: 127.x.x.x or ::1.
[[nodiscard]] bool is_loopback(const std::string& address);

}  // namespace burr::net
