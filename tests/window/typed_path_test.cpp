// Tab completes a path as in a shell.
#include "window/ui/typed_path.h"
#include "support/folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace burr::app {
namespace {

namespace fs = std::filesystem;

TEST(TypedPath, TabAddsWhatAllThatBeginSoHaveInCommon) {
  const test::Folder own;
  const fs::path& folder = own.path();
  fs::create_directories(folder / "scans of ears");
  fs::create_directories(folder / ".hidden");
  for (const char* name :
       {"skull_left.nrrd", "skull_right.nrrd", "scans of ears/å1.nii", "scans of ears/ä2.nii"})
    std::ofstream(folder / name) << "x";
  const auto tab = [&](const std::string& typed) {
    const std::string at = folder.string() + "/";
    const std::string whole = completed_path(at + typed);
    EXPECT_EQ(whole.rfind(at, 0), 0U) << whole;
    return whole.substr(at.size());
  };
  EXPECT_EQ(tab("sk"), "skull_");
  EXPECT_EQ(tab("skull_l"), "skull_left.nrrd");
  EXPECT_EQ(tab("sc"), "scans of ears/") << "a folder, to go on in it";
  EXPECT_EQ(tab("s"), "s") << "they part after it";
  EXPECT_EQ(tab("x"), "x") << "nothing begins so";
  EXPECT_EQ(tab(""), "s") << "hidden ones do not count";
  EXPECT_EQ(tab(".h"), ".hidden/");
  EXPECT_EQ(tab("scans of ears/"), "scans of ears/") << "half a letter is never added";
  EXPECT_EQ(completed_path("/nowhere/at/all/x"), "/nowhere/at/all/x");
}

}  // namespace
}  // namespace burr::app
