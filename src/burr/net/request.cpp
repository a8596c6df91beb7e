#include "burr/net/request.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <optional>

namespace burr::net {
namespace {

constexpr std::size_t kLongestTarget = 2048;

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// Of percent signs, and in a query also of plus signs. None: a bad escape, or a control character.
std::optional<std::string> decoded(std::string_view text, bool of_query) {
  std::string out;
  for (std::size_t n = 0; n < text.size(); ++n) {
    char c = text[n];
    if (c == '%') {
      if (n + 2 >= text.size() || digit(text[n + 1]) < 0 || digit(text[n + 2]) < 0)
        return std::nullopt;
      c = static_cast<char>(digit(text[n + 1]) * 16 + digit(text[n + 2]));
      n += 2;
    } else if (of_query && c == '+') {
      c = ' ';
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return std::nullopt;
    out += c;
  }
  return out;
}

}  // namespace

Response refusal(int status, std::string_view sentence) {
  Response out;
  out.status = status;
  out.body = nlohmann::json{{"error", sentence}}.dump(-1, ' ', false,
                                                      nlohmann::json::error_handler_t::replace);
  return out;
}

bool read_target(std::string_view target, Request& request) {
  if (target.size() > kLongestTarget || target.empty() || target.front() != '/') return false;
  const std::size_t mark = target.find('?');
  const auto path = decoded(target.substr(0, mark), false);
  if (!path || path->find("..") != std::string::npos || path->find('\\') != std::string::npos ||
      path->find("//") != std::string::npos)
    return false;
  request.path = *path;
  request.query.clear();
  std::string_view rest =
      mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find('&'), rest.size());
    const std::string_view one = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const std::size_t equals = std::min(one.find('='), one.size());
    const auto name = decoded(one.substr(0, equals), true);
    const auto value = decoded(one.substr(std::min(equals + 1, one.size())), true);
    if (!name || !value) return false;
    request.query[*name] = *value;
  }
  return true;
}

}  // namespace burr::net
