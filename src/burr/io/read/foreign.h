// io/read/foreign.h - files that are no scan: what systems leave in folders, and the formats that
// people try though they hold no volume. Internal to io.
//
// Thread: any.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace burr::io {

// ".DS_Store", "._jaw.nii.gz", "__MACOSX", "Thumbs.db" and the like, by name.
[[nodiscard]] bool left_by_a_system(const std::filesystem::path& path);

// The same of the file or of a folder that it lies in, below `root`.
[[nodiscard]] bool left_by_a_system(const std::filesystem::path& path,
                                    const std::filesystem::path& root);

// ".tif", ".png", ".bmp": pictures that may be of a stack.
[[nodiscard]] bool named_as_picture(const std::filesystem::path& path);

// A format that burr does not read, though people have it: what it is ("a JPEG picture") and what
// to do instead. Both empty: none of them.
struct Foreign {
  std::string what, instead;
};
// head: the first bytes of the file, 132 or all
[[nodiscard]] Foreign foreign(const std::filesystem::path& path,
                              const std::vector<std::uint8_t>& head);

}  // namespace burr::io
