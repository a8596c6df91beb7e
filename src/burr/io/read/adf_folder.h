// io/read/adf_folder.h - where the pictures of an ADF lie: the description file (.yaml) of AMBF,
// the simulator on which FIVRS (volumetric_drilling) is built. Internal to io.
//
// The rule: the folder of the pictures must lie in the folder that holds the ADF's folder, so the
// name may begin with one ".." and no more (FIVRS names "../resources/volumes/RT143_512"). It is
// used on both sides of the fence: the fence opens this one folder to the reader.
// Thread: any.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace burr::io {

[[nodiscard]] bool named_as_adf(const std::filesystem::path& path);  // .yaml, .yml

// The folder of that name, seen from the ADF; nothing: the name breaks the rule.
[[nodiscard]] std::optional<std::filesystem::path> pictures_folder(const std::filesystem::path& adf,
                                                                   std::string_view name);

// The folder of the first "path:" behind "images:" in the text of the file, found without a parser
// of YAML; for the fence. Nothing: there is none, or it is not a folder that the rule allows.
[[nodiscard]] std::optional<std::filesystem::path> pictures_folder_in_text(
    const std::filesystem::path& adf);

// A folder of pictures as what describes it: the one ADF beside the folder that names it. Otherwise
// the path itself, also if a .yaml lies inside.
[[nodiscard]] std::filesystem::path with_its_adf(const std::filesystem::path& path);

}  // namespace burr::io
