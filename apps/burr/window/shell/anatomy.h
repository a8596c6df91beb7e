// apps/burr/window/shell/anatomy.h - the names of structures in the language of the user.
//
//     anatomy("facial nerve")     "nervus facialis" in Swedish
//
// Known are the tissues and structures of the bones made from formulas and of burr's own cases. Any
// other name comes back as the file has it, made safe to print. Thread: any; speak() on main.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace burr::app {

[[nodiscard]] std::string anatomy(std::string_view name);

// All of them, "facial nerve, dura".
[[nodiscard]] std::string anatomy_list(const std::vector<std::string>& names);

}  // namespace burr::app
