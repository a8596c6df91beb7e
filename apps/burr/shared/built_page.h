// shared/built_page.h - the page, burr in a browser, as it is published (web/publish): all its parts lie in a folder that their hash names, and
// version.json names every file with its hash.
//
// Thread: any.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::app {

inline constexpr const char* kSignOfPage =
    "version.json";  // a folder with this file is a page of burr

struct BuiltPage {
  std::filesystem::path folder;
  std::string parts;  // name of the folder in it that holds all but the pages themselves
  std::map<std::string, std::string> files;  // path in the folder -> SHA-256
};

// The page that came with this program: beside its build, or in its installation. Error: there is none.
[[nodiscard]] Result<BuiltPage> built_page();
// The one in a folder. Error: there is none, or version.json is damaged.
[[nodiscard]] Result<BuiltPage> page_in(const std::filesystem::path& folder);
// A folder's name that is one of a version: v- and 16 digits, 0 to f.
[[nodiscard]] bool is_parts(std::string_view name);
// The bytes of version.json.
[[nodiscard]] Result<std::string> list_of_page(const BuiltPage& page);
// A file's bytes. Error: it cannot be read, or is not the one that version.json names.
[[nodiscard]] Result<std::string> file_of_page(const BuiltPage& page, const std::string& path);

}  // namespace burr::app
