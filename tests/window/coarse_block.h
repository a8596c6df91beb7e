// tests/window/coarse_block.h - the practice block in coarse voxels, which opens and is marked faster.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "support/test_places.h"

namespace burr::app {

// Writes the case as `folder`/block.toml.
inline void write_coarse_block(const std::filesystem::path& folder) {
  std::ifstream in(std::filesystem::path(burr::test::source_dir()) / "cases" / "block.toml");
  std::string text(std::istreambuf_iterator<char>(in), {});
  const std::string fine = "voxel_mm = 0.25";
  const std::size_t at = text.find(fine);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, fine.size(), "voxel_mm = 0.5");
  std::ofstream(folder / "block.toml") << text;
}

}  // namespace burr::app
