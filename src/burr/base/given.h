// base/given.h - what a person gave for one field of a case, of the command line or of Python, before
// anybody asks what it means there.
#pragma once

#include <cstdint>
#include <string>
#include <variant>

namespace burr::base {

// Yes or no, a whole number, a number, a text.
using Given = std::variant<bool, std::int64_t, double, std::string>;

}  // namespace burr::base
