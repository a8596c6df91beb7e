#define TOML_IMPLEMENTATION  // the code of toml++ is here
#include "safe_toml.h"

#include <fmt/core.h>

#include "burr/base/printable.h"

namespace burr {

Result<toml::table> parse_toml(std::string_view text, std::string_view file) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& problem) {
    return error(fmt::format("{}: line {}: {}", file, problem.source().begin.line,
                             base::printable(problem.description(), 300)));
  }
}

}  // namespace burr
