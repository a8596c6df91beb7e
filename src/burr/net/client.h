// net/client.h - asks a server of the web, with TLS where the address says so.
//
//     auto answer = net::ask({"POST", "https://lrs.example.org/xapi/statements", {{"Content-Type", "application/json"}}, body});
//     if (answer && answer->status == 200) ...
//
// The server's certificate and name are checked by the authorities that the system knows (or those of SSL_CERT_FILE).
// Without TLS only this computer itself is asked: other computers could read the key along. A redirection is not followed:
// it would carry the key elsewhere. Errors. Trouble::usage: the address. Trouble::io: no whole answer came in time.
// Thread: any. Cost: waits for the network, at most Question::wait_s and as long as the system looks for a name.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/result.h"

namespace burr::net {

struct Question {
  std::string method = "GET", url;
  std::vector<std::pair<std::string, std::string>> fields = {};
  std::string body = {};
  double wait_s = 30;  // for the whole answer
};
struct Answer {
  int status = 0;
  std::map<std::string, std::string> fields;  // names in small letters; of some the last
  std::string body;                           // at most 8 MiB
};

struct Url {
  bool tls = true;
  std::string host, port;  // of "[::1]" without brackets
  std::string target;      // path and query, "/" at least
};
// Error: not http or https, a name and password within, no host; or without TLS to another computer.
[[nodiscard]] Result<Url> parse_url(const std::string& text);
// "a b&c" -> "a%20b%26c": one value of a query.
[[nodiscard]] std::string escaped(const std::string& text);
[[nodiscard]] std::string unescaped(const std::string& text);

[[nodiscard]] Result<Answer> ask(const Question& question);

}  // namespace burr::net
