// apps/burr/batch/canonical.h - JSON of which equal values have equal bytes: keys sorted, no spaces, each number as the
// shortest text that is read back as the same number. NaN and infinity become null; what is not UTF-8 becomes U+FFFD.
//
// Thread: any.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace burr::app {

[[nodiscard]] std::string canonical(const nlohmann::json& value);

}  // namespace burr::app
