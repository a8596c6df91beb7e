// The list of where the scans of recordings lie: what goes in comes out, nothing is lost between
// two processes, only the user can read it, and it never leads to another scan.
#include "burr/record/scan_list.h"

#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "burr/record/find_volume.h"
#include "record/made_up.h"

namespace burr::record {
namespace {

namespace fs = std::filesystem;
using burr::test::Folder;

VolumeInfo wanted(std::uint64_t print, std::uint64_t content) {
  VolumeInfo info;
  info.source_fingerprint = print;
  info.content_hash = content;
  return info;
}

int lines_of(const std::string& list) {
  std::ifstream file(list);
  int count = 0;
  for (std::string line; std::getline(file, line);) count += line.starts_with("0x") ? 1 : 0;
  return count;
}

TEST(ScanList, GivesThePathsOfAScanTheSameBoneFirst) {
  const Folder folder;
  const std::string list = folder / "state/scans.txt";
  EXPECT_TRUE(remembered(list, wanted(1, 2)).empty());
  ASSERT_TRUE(remember_scan(list, {1, 2, "/scans/fine.nrrd"}));
  ASSERT_TRUE(remember_scan(list, {1, 3, "/scans/other bone/of it.nrrd"}));
  ASSERT_TRUE(remember_scan(list, {9, 2, "/scans/another.nrrd"}));
  using Paths = std::vector<std::string>;
  EXPECT_EQ(remembered(list, wanted(1, 2)),
            (Paths{"/scans/fine.nrrd", "/scans/other bone/of it.nrrd"}));
  EXPECT_EQ(remembered(list, wanted(1, 3)),
            (Paths{"/scans/other bone/of it.nrrd", "/scans/fine.nrrd"}));
  EXPECT_TRUE(remembered(list, wanted(0, 2)).empty()) << "a bone without a file";
  // the file was replaced: what the path held is forgotten
  ASSERT_TRUE(remember_scan(list, {5, 5, "/scans/fine.nrrd"}));
  EXPECT_EQ(remembered(list, wanted(1, 2)), (Paths{"/scans/other bone/of it.nrrd"}));
  ASSERT_TRUE(forget_scan(list, "/scans/fine.nrrd"));
  EXPECT_TRUE(remembered(list, wanted(5, 5)).empty());
  EXPECT_EQ(lines_of(list), 2);
  // a relative path is kept as absolute
  ASSERT_TRUE(remember_scan(list, {7, 7, "x/../ct"}));
  EXPECT_EQ(remembered(list, wanted(7, 7)), (Paths{(fs::current_path() / "ct").string()}));
  EXPECT_FALSE(remember_scan(list, {8, 8, "/two\nlines"}));
}

TEST(ScanList, OnlyTheUserCanReadIt) {
  const Folder folder;
  fs::create_directory(folder / "state");
  fs::permissions(folder / "state", fs::perms::all);
  const std::string list = folder / "state/scans.txt";
  ASSERT_TRUE(remember_scan(list, {1, 2, "/scans/a"}));
  for (const auto& [path, mode] :
       {std::pair{list, 0600U}, {list + ".lock", 0600U}, {folder / "state", 0700U}}) {
    struct stat about {};
    ASSERT_EQ(::stat(path.c_str(), &about), 0) << path;
    EXPECT_EQ(about.st_mode & 0777U, mode) << path;
  }
}

TEST(ScanList, HoldsAThousandTheOldestGo) {
  const Folder folder;
  const std::string list = folder / "scans.txt";
  {
    std::ofstream file(list);
    for (unsigned n = 1; n <= 1000; ++n) file << hex(n) << ' ' << hex(n) << " /scans/" << n << '\n';
  }
  ASSERT_TRUE(remember_scan(list, {5000, 5000, "/scans/new"}));
  EXPECT_EQ(lines_of(list), 1000);
  EXPECT_FALSE(remembered(list, wanted(5000, 5000)).empty());
  EXPECT_FALSE(remembered(list, wanted(999, 999)).empty());
  EXPECT_TRUE(remembered(list, wanted(1000, 1000)).empty());
}

TEST(ScanList, ProcessesAtTheSameTimeKeepEachOthersEntries) {
  const Folder folder;
  const std::string list = folder / "scans.txt";
  constexpr unsigned kProcesses = 4, kEach = 6;
  std::vector<pid_t> children;
  for (unsigned p = 0; p < kProcesses; ++p) {
    const pid_t child = ::fork();
    if (child == 0) {
      bool good = true;
      for (unsigned n = 0; n < kEach; ++n) {
        const std::uint64_t id = 1 + p * kEach + n;
        good = remember_scan(list, {id, id, "/scans/" + std::to_string(id)}).ok() && good;
      }
      ::_exit(good ? 0 : 1);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int how = 0;
    ::waitpid(child, &how, 0);
    EXPECT_EQ(how, 0);
  }
  for (unsigned id = 1; id <= kProcesses * kEach; ++id)
    EXPECT_EQ(remembered(list, wanted(id, id)).size(), 1U) << id;
}

TEST(ScanList, ThatCannotBeWrittenOrReadIsAnErrorAndNothingMore) {
  const Folder folder;
  test::write_file(folder / "file", {1, 2, 3});
  const std::string list = folder / "file/scans.txt";  // a folder that cannot be made
  const Status kept = remember_scan(list, {1, 2, "/scans/a"});
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().text.find("is not remembered"), std::string::npos) << kept.error().text;
  EXPECT_TRUE(remembered(list, wanted(1, 2)).empty());
  EXPECT_TRUE(forget_scan(list, "/scans/a"));
  // bytes that are no list, then the same file in use
  test::write_file(folder / "scans.txt", std::vector<std::uint8_t>(5000, 0xAB));
  EXPECT_TRUE(remembered(folder / "scans.txt", wanted(1, 2)).empty());
  EXPECT_TRUE(remember_scan(folder / "scans.txt", {1, 2, "/scans/a"}));
  EXPECT_EQ(remembered(folder / "scans.txt", wanted(1, 2)).size(), 1U);
}

TEST(ScanList, IsOffByTheEnvironment) {
  ::setenv("BURR_REMEMBER_SCANS", "0", 1);
  EXPECT_EQ(scan_list(), "");
  EXPECT_EQ(scan_list("/state"), "");
  ::unsetenv("BURR_REMEMBER_SCANS");
  EXPECT_EQ(scan_list("/state"), "/state/scans.txt");
  EXPECT_EQ(scan_list(fs::path()), "");
  const Folder folder;
  EXPECT_TRUE(remember_scan("", {1, 2, "/scans/a"}));
}

TEST(ScanList, LeadsToTheScanWhileItIsThereAndTheSame) {
  const Folder folder;
  const std::string scan = folder / "far/away/ct.nrrd", list = folder / "state/scans.txt";
  fs::create_directories(folder / "far/away");
  fs::create_directories(folder / "here");
  test::write_file(scan, std::vector<std::uint8_t>(50'000, 7));
  VolumeInfo info = wanted(*fingerprint(scan), 2);
  VolumeHints hints;
  hints.recording = folder / "here/s.mcap";
  EXPECT_FALSE(find_volume(info, hints)) << "without the list it is not found";
  hints.list = list;
  ASSERT_TRUE(remember_scan(list, {info.source_fingerprint, 2, scan}));
  ASSERT_TRUE(find_volume(info, hints));
  EXPECT_EQ(*find_volume(info, hints), scan);
  // beside the recording comes first
  fs::copy_file(scan, folder / "here/copy.nrrd");
  EXPECT_EQ(*find_volume(info, hints), folder / "here/copy.nrrd");
  fs::remove(folder / "here/copy.nrrd");
  // of the same size, but other bytes: forgotten
  test::write_file(scan, std::vector<std::uint8_t>(50'000, 8));
  EXPECT_FALSE(find_volume(info, hints));
  EXPECT_EQ(lines_of(list), 0);
  // gone: forgotten, and the sentence says what to do
  test::write_file(scan, std::vector<std::uint8_t>(50'000, 7));
  ASSERT_TRUE(remember_scan(list, {info.source_fingerprint, 2, scan}));
  fs::remove(scan);
  const auto lost = find_volume(info, hints);
  ASSERT_FALSE(lost);
  EXPECT_NE(lost.error().text.find("`volume`"), std::string::npos) << lost.error().text;
  EXPECT_EQ(lines_of(list), 0);
}

}  // namespace
}  // namespace burr::record
