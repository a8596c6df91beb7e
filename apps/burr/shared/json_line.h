// apps/burr/shared/json_line.h - the one line that --json prints.
//
// File names and names of tissues may hold bytes that are not UTF-8, which JSON cannot hold; U+FFFD
// stands in their place. Thread: any.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace burr::app {

template <class Json>  // nlohmann::json or nlohmann::ordered_json
[[nodiscard]] std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace burr::app
