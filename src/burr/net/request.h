// net/request.h - what a browser asks, and what it gets.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace burr::net {

struct Request {
  std::string method;  // "GET", "HEAD", "POST"
  std::string path;    // decoded; begins with '/', has no "..", '\' or control character
  std::map<std::string, std::string> query;   // decoded
  std::map<std::string, std::string> fields;  // of the head; names in small letters
  std::string body;

  // "" where there is none.
  [[nodiscard]] std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? std::string() : found->second;
  }
  [[nodiscard]] std::string asked(const std::string& name) const {
    const auto found = query.find(name);
    return found == query.end() ? std::string() : found->second;
  }
};

struct Response {
  int status = 200;
  std::string type = "application/json; charset=utf-8";
  std::string body;
  std::vector<std::pair<std::string, std::string>> fields;  // more of the head
  bool keeps = false;  // the browser may keep it for an hour: a part of the page, no data
};

// {"error": sentence}
[[nodiscard]] Response refusal(int status, std::string_view sentence);

// "/a%20b?x=1" into path and query. False: not a target that burr answers.
[[nodiscard]] bool read_target(std::string_view target, Request& request);

}  // namespace burr::net
