#include "burr/base/new_file.h"
#include "support/folder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace burr::base {
namespace {

namespace fs = std::filesystem;

int mode_of(const std::string& path) {
  struct stat facts = {};
  return ::stat(path.c_str(), &facts) == 0 ? static_cast<int>(facts.st_mode & 0777) : -1;
}

class NewFileTest : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const char* name) const { return (folder / name).string(); }
  static std::string content(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  }
  const test::Folder own_;
  const fs::path folder = own_.path();
};

TEST_F(NewFileTest, IsThereWholeOnceItIsPutInPlace) {
  std::string large(5'000'000, 'x');
  {
    auto file = NewFile::create(path("a"));
    ASSERT_TRUE(file.ok());
    file->write("head");
    file->write(large.data(), large.size());
    file->write_at(1, "EA", 2);
    EXPECT_EQ(file->size(), large.size() + 4);
    EXPECT_FALSE(fs::exists(path("a")));
    ASSERT_TRUE(file->put_in_place().ok());
  }
  EXPECT_EQ(content(path("a")), "hEAd" + large);
  EXPECT_EQ(files(), 1);
}

TEST_F(NewFileTest, LeavesTheOldFileAndNothingElseWhenGivenUp) {
  std::ofstream(path("a")) << "old";
  {
    auto file = NewFile::create(path("a"));
    ASSERT_TRUE(file.ok());
    file->write("new");
  }
  EXPECT_EQ(content(path("a")), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(NewFileTest, AFullDiskIsTroubleNotHalfAFile) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{}, small{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  small = before;
  small.rlim_cur = 100'000;
  std::ofstream(path("a")) << "old";
  {
    auto file = NewFile::create(path("a"));
    ASSERT_TRUE(file.ok());
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string large(3'000'000, 'x');
    file->write(large.data(), large.size());
    EXPECT_FALSE(file->ok());
    const Status status = file->put_in_place();
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().trouble, Trouble::io);
    EXPECT_NE(status.error().text.find(path("a")), std::string::npos) << status.error().text;
  }
  EXPECT_EQ(content(path("a")), "old");
  EXPECT_EQ(files(), 1);
}

TEST_F(NewFileTest, RefusesWhatIsNoPlainFileAndFollowsLinks) {
  EXPECT_FALSE(NewFile::create(folder.string()).ok());
  EXPECT_FALSE(NewFile::create("/dev/null").ok());
  EXPECT_FALSE(NewFile::create("").ok());
  const auto missing = NewFile::create(path("no/such/folder"));
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().trouble, Trouble::io);

  std::ofstream(path("real")) << "old";
  fs::create_symlink("real", path("link"));
  {
    auto file = NewFile::create(path("link"));
    ASSERT_TRUE(file.ok());
    file->write("new");
    ASSERT_TRUE(file->put_in_place().ok());
  }
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content(path("real")), "new");
}

TEST_F(NewFileTest, WhoDoesNotSayGetsAFileForThisUserAlone) {
  const mode_t before = ::umask(0022);
  for (const auto& [mode, wanted] : {std::pair(kForMe, 0600), {kForAll, 0644}}) {
    auto file = NewFile::create(path("a.txt"), mode);
    ASSERT_TRUE(file.ok()) << file.error().text;
    file->write("text");
    for (const auto& one : fs::directory_iterator(folder)) {  // already while it is written
      if (one.path().filename() == "a.txt") continue;
      EXPECT_EQ(mode_of(one.path().string()), wanted) << one.path();
    }
    ASSERT_TRUE(file->put_in_place().ok());
    EXPECT_EQ(mode_of(path("a.txt")), wanted);
  }
  auto file = NewFile::create(path("b.txt"));
  ASSERT_TRUE(file.ok() && file->put_in_place().ok());
  EXPECT_EQ(mode_of(path("b.txt")), 0600);
  ::umask(before);
}

}  // namespace
}  // namespace burr::base
