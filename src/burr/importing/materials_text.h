// importing/materials_text.h - the text of materials/materials.toml, which cmake/library.cmake
// makes part of the library. For use of this room only.
#pragma once

namespace burr::importing {

[[nodiscard]] const char* built_in_materials_text();

}  // namespace burr::importing
