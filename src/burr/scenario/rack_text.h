// scenario/rack_text.h - the text of tools/tools.toml, which cmake/library.cmake makes part of the
// library. For use of this room only.
#pragma once

namespace burr::scenario {

[[nodiscard]] const char* built_in_rack_text();

}  // namespace burr::scenario
