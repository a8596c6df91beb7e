// serve/page_files.h - the parts of the instructor's page; they are built into the program (web/school).
#pragma once

#include <span>
#include <string_view>

namespace burr::app {

struct PageFile {
  std::string_view path;  // "/school.css"
  std::string_view type;
  std::string_view text;
};

[[nodiscard]] std::span<const PageFile> page_files();

}  // namespace burr::app
