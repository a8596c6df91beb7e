// io/read/text.h - small functions for text headers. Internal to io.
//
// Thread: any.
#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/read/bytes.h"

namespace burr::io {

[[nodiscard]] std::string_view trimmed(std::string_view text);
[[nodiscard]] std::vector<std::string> words(std::string_view text);
[[nodiscard]] std::string lower(std::string_view text);
// The whole text as a number; false: it is not one.
[[nodiscard]] bool to_number(std::string_view text, double& out);
[[nodiscard]] bool to_number(std::string_view text, std::int64_t& out);
// Numbers separated by spaces, commas or brackets; empty if one of them is not a number.
[[nodiscard]] std::vector<double> numbers(std::string_view text);
// The same where `count` numbers are expected: "0,5 0,5 1,0" are three numbers then, with decimal
// commas (and `commas` is set). Empty: the text is not so many numbers.
[[nodiscard]] std::vector<double> numbers(std::string_view text, std::size_t count, bool& commas);
// A single number, perhaps with a decimal comma.
[[nodiscard]] bool to_number(std::string_view text, double& out, bool& commas);

}  // namespace burr::io
