// Custom laws from shared libraries that the build made (samples/laws, tests/support/laws).
#include "burr/workshop/law_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "burr/workshop/sha256.h"
#include "support/folder.h"
#include "support/test_places.h"

namespace burr::workshop {
namespace {

const std::string kLaws = test::build_dir() + "/laws/";

burr_law_in_v1 pressed(double depth) {
  burr_law_in_v1 in = {};
  in.size = sizeof in;
  in.version = 1;
  in.stiffness = 1000;
  in.depth = depth;
  in.normal[2] = 1;
  in.touching = 1;
  return in;
}

double force_of(LawFile& law, double depth) {
  burr_law_out_v1 out = {};
  out.force[2] = 7;
  EXPECT_EQ(law.answer(pressed(depth), out), 0);
  return out.force[2];
}

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

TEST(LawFile, OfTheSampleIsItsFormula) {
  const burr::test::Folder folder;
  write(folder / "soft.txt", "d0_mm = 2\n");
  const auto law = LawFile::open(kLaws + "hardening.so", folder / "soft.txt");
  ASSERT_TRUE(law.ok()) << law.error().text;
  ASSERT_TRUE((*law)->begin().ok());
  for (const double d : {0.0, 0.5e-3, 2e-3})
    EXPECT_NEAR(force_of(**law, d), 1000 * d * (1 + d / 2e-3), 1e-12);
  EXPECT_EQ((*law)->about().name, "hardening.so");
  EXPECT_EQ((*law)->about().kind, "compiled");
  EXPECT_EQ((*law)->about().sha256.size(), 64U);
  EXPECT_EQ((*law)->about().settings_sha256, sha256("d0_mm = 2\n"));

  write(folder / "wrong.txt", "d0_mm = -1\n");
  const auto wrong = LawFile::open(kLaws + "hardening.so", folder / "wrong.txt");
  ASSERT_TRUE(wrong.ok());
  const Status refused = (*wrong)->begin();
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().text.find("refused its settings"), std::string::npos);
}

TEST(LawFile, SaysWhatIsWrong) {
  const burr::test::Folder folder;
  write(folder / "text.so", "this is no library");
  write(folder / "settings.txt", "");
  const auto says = [](const auto& law, const char* what) {
    ASSERT_FALSE(law.ok());
    EXPECT_NE(law.error().text.find(what), std::string::npos) << law.error().text;
    EXPECT_EQ(law.error().text.find("/proc/"), std::string::npos) << law.error().text;
  };
  says(LawFile::open(folder / "absent.so"), "there is no such file");
  says(LawFile::open(folder.str()), "is a folder, not a file");
  says(LawFile::open(folder / "text.so"), "it cannot be loaded");
  says(LawFile::open(kLaws + "is_none.so"), "has no function burr_law_v1");
  says(LawFile::open(kLaws + "nan.so", folder / "settings.txt"), "takes no settings");
  says(LawFile::open(kLaws + "hardening.so", folder / "absent.txt"), "`law_settings`");
}

// The bytes that were hashed are those that run, also when the file changes; each copy has its own memory.
TEST(LawFile, IsACopyOfItsOwn) {
  const burr::test::Folder folder;
  const std::string file = folder / "law.so";
  std::filesystem::copy_file(kLaws + "shares.so", file);
  const auto one = LawFile::open(file), two = LawFile::open(file);
  ASSERT_TRUE(one.ok() && two.ok());
  ASSERT_TRUE((*one)->begin().ok() && (*two)->begin().ok());
  const double first = force_of(**one, 1e-3);
  EXPECT_NE(force_of(**one, 1e-3), first) << "it counts";
  EXPECT_EQ(force_of(**two, 1e-3), first) << "for itself";
  std::filesystem::remove(file);
  std::filesystem::copy_file(kLaws + "twice.so", file);
  const auto three = LawFile::open(file);
  ASSERT_TRUE(three.ok());
  ASSERT_TRUE((*three)->begin().ok());
  EXPECT_EQ(force_of(**three, 1e-3), 2) << "another law by the same name";
  EXPECT_NE((*three)->about().sha256, (*one)->about().sha256);
  EXPECT_NEAR(force_of(**one, 1e-3), 7, 1e-3);
}

TEST(LawFile, IsFitForRealTimeOnceItsBytesAndSettingsPassed) {
  const burr::test::Folder folder;
  const std::filesystem::path passes = std::filesystem::path(folder.path()) / "state" / "laws";
  write(folder / "a.txt", "d0_mm = 1\n");
  write(folder / "b.txt", "d0_mm = 2\n");
  const auto open = [&](const char* settings) {
    auto law = LawFile::open(kLaws + "hardening.so",
                             *settings == 0 ? std::string() : folder / settings, passes);
    EXPECT_TRUE(law.ok());
    return *law;
  };
  const Status refused = open("a.txt")->fit_for_real_time();
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().text.find("passed its trial on this computer, again after each change"),
            std::string::npos);
  ASSERT_TRUE(remember_pass(passes, open("a.txt")->about(), "seed 1\n").ok());
  EXPECT_TRUE(open("a.txt")->fit_for_real_time().ok());
  EXPECT_FALSE(open("b.txt")->fit_for_real_time().ok());
  EXPECT_FALSE(open("")->fit_for_real_time().ok());
  const auto other = LawFile::open(kLaws + "twice.so", "", passes);
  ASSERT_TRUE(other.ok());
  EXPECT_FALSE((*other)->fit_for_real_time().ok());
  // a file that only has the name is no pass
  write((passes / (*other)->about().sha256).string(), "");
  EXPECT_FALSE((*other)->fit_for_real_time().ok());
  EXPECT_FALSE(remember_pass({}, (*other)->about(), "").ok());
}

}  // namespace
}  // namespace burr::workshop
