// net/guard.h - who may ask, and what every answer forbids a browser.
//
//     Host        must name this server: a foreign name that was made to point here (DNS rebinding) gets nothing
//     Origin      where a browser sends it, it must be this server's own; so does Sec-Fetch-Site
//     token       everything under /api/ needs "Authorization: Bearer TOKEN". The page takes it from the part of its
//                 address after '#', which no browser sends, and keeps it for its tab. There is no cookie: cookies are
//                 shared by all ports of a computer, so another user's server on it could collect them
//     stations    have a token of their own, with which they post pictures to /api/station and can read nothing
//     POST        must bring JSON, of a station a picture, so no form of another page can make one
//
// Parts of the page itself need no token: they hold no data. docs/teach/security.md lists threats
// and what meets them.
// Thread: any.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/net/request.h"

namespace burr::net {

inline constexpr const char* kStationPath = "/api/station";

struct Guard {
  std::vector<std::string> hosts;  // "127.0.0.1:8231", "localhost:8231"
  bool tls = false;
  std::string token;
  // What stations show themselves with (POST /api/station), good for nothing else. Empty: there are none.
  std::string station_token = {};
};

// 256 bits from the system, as 64 digits. Error: the system gives none.
[[nodiscard]] Result<std::string> new_token();
// The token in a file that only its owner may read. Error: it may be read by others, or holds less than 32 characters.
[[nodiscard]] Result<std::string> token_from(const std::string& file);

// A refusal: 403, 401, 405, 415, 421. None: go on.
[[nodiscard]] std::optional<Response> refused(const Request& request, const Guard& guard);

// What every answer carries: Content-Security-Policy and its like.
void add_fences(Response& response);

}  // namespace burr::net
