// importing/materials_text.h - the text of materials/materials.toml, made part of the library by
// cmake/library.cmake; of this room only.
#pragma once

namespace burr::importing {

[[nodiscard]] const char* built_in_materials_text();

}  // namespace burr::importing
