// apps/burr/shared/bone_option.h - the option that takes a case to another bone.
#pragma once

#include <cstdint>

namespace CLI {
class App;
}

namespace burr::app {

// --bone N: workshop::take_bone(). Errors: of CLI11, one sentence.
void add_bone_option(CLI::App& command, std::uint32_t& number);

}  // namespace burr::app
