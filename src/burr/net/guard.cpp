#include "burr/net/guard.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/random.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "burr/base/text_file.h"
#include "burr/base/trimmed.h"

namespace burr::net {
namespace {

constexpr std::size_t kShortestToken = 32;

// Takes as long wherever the first difference is.
bool same(const std::string& a, const std::string& b) {
  unsigned differs = a.size() == b.size() ? 0 : 1;
  for (std::size_t n = 0; n < a.size(); ++n)
    differs |= static_cast<unsigned>(static_cast<unsigned char>(a[n]) ^
                                     static_cast<unsigned char>(b.empty() ? 0 : b[n % b.size()]));
  return differs == 0;
}

bool is_own(const std::string& origin, const Guard& guard) {
  return std::any_of(guard.hosts.begin(), guard.hosts.end(), [&](const std::string& host) {
    return origin == (guard.tls ? "https://" : "http://") + host;
  });
}

}  // namespace

Result<std::string> new_token() {
  std::array<unsigned char, 32> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    return error(Trouble::io, "the system gives no random numbers, so no token can be made");
  std::string out;
  for (const unsigned char byte : bytes) out += fmt::format("{:02x}", byte);
  return out;
}

Result<std::string> token_from(const std::string& file) {
  struct stat status = {};
  const std::string name = std::filesystem::path(file).filename().string();
  if (stat(file.c_str(), &status) == 0 && (status.st_mode & (S_IRWXG | S_IRWXO)) != 0)
    return error(Trouble::usage,
                 fmt::format("{}: other users may read the token; run: chmod 600 {}", name, name));
  auto text = base::text_of_file(file, 4096, "a token; check that this is the right file");
  if (!text) return text.error();
  std::string token(base::trimmed(*text));
  const bool plain = token.find_first_not_of(
                         "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~") ==
                     std::string::npos;
  if (token.size() < kShortestToken || !plain)
    return error(
        fmt::format("{}: a token has at least {} letters and digits, and of signs only - . _ ~",
                    name, kShortestToken));
  return token;
}

std::optional<Response> refused(const Request& request, const Guard& guard) {
  const std::string host = request.field("host");
  if (std::find(guard.hosts.begin(), guard.hosts.end(), host) == guard.hosts.end())
    return refusal(421, "this server does not go by that name; use the address that burr printed");
  if (request.method != "GET" && request.method != "HEAD" && request.method != "POST")
    return refusal(405, "only GET, HEAD and POST are answered");
  const std::string origin = request.field("origin"), site = request.field("sec-fetch-site");
  if ((!origin.empty() && !is_own(origin, guard)) ||
      (!site.empty() && site != "same-origin" && site != "none"))
    return refusal(403, "another page may not ask this server");
  if (!request.path.starts_with("/api/")) {
    if (request.method == "POST") return refusal(405, "nothing can be posted here");
    return std::nullopt;
  }
  const std::string bearer = "Bearer ", given = request.field("authorization");
  if (request.path == kStationPath) {
    if (guard.station_token.empty())
      return refusal(404,
                     "this server takes no stations; start it with `net::Guard::station_token`");
    if (!given.starts_with(bearer) || !same(given.substr(bearer.size()), guard.station_token))
      return refusal(401, "the token of the stations is missing or wrong");
    if (request.method != "POST") return refusal(405, "a station posts");
    if (request.field("content-type") != "image/jpeg")
      return refusal(415, "a station posts pictures");
    return std::nullopt;
  }
  if (!given.starts_with(bearer) || !same(given.substr(bearer.size()), guard.token))
    return refusal(401, "the token is missing or wrong; open the address that burr printed");
  if (request.method == "POST" && !request.field("content-type").starts_with("application/json"))
    return refusal(415, "only JSON can be posted");
  return std::nullopt;
}

void add_fences(Response& response) {
  const std::pair<const char*, const char*> fences[] = {
      {"Content-Security-Policy",
       "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src "
       "'self'; img-src 'self' blob: data:; "
       "connect-src 'self'; "
       "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      {"Cache-Control", response.keeps ? "private, max-age=3600" : "no-store"},
  };
  for (const auto& [name, value] : fences) response.fields.emplace_back(name, value);
}

}  // namespace burr::net
