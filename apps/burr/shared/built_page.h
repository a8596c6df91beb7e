// shared/built_page.h - the page, burr in a browser, as it was built for this program.
//
// Thread: any.
#pragma once

#include <filesystem>
#include <vector>

#include "burr/base/result.h"

namespace burr::app {

inline constexpr const char* kSignOfPage =
    "burr_page.wasm";  // a folder with this file is a page of burr

// The folder of the page: beside the build of this program, or of its installation. Error: it is not built.
[[nodiscard]] Result<std::filesystem::path> built_page();
// All files below it, sorted.
[[nodiscard]] std::vector<std::filesystem::path> files_of_page(const std::filesystem::path& page);

}  // namespace burr::app
