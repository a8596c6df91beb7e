#include "shared/bone_option.h"

#include <CLI/CLI.hpp>

#include "burr/phantom/phantoms.h"

namespace burr::app {

void add_bone_option(CLI::App& command, std::uint32_t& number) {
  command
      .add_option("--bone", number,
                  "number of another bone for the same case: what differs between people is drawn "
                  "from it (default: the bone that the case names)")
      ->check(CLI::Range(std::uint32_t{1}, phantom::kMostBones));
}

}  // namespace burr::app
