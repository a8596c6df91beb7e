// The settings that a user keeps for each device, by its serial number.
#include "burr/workshop/device_book.h"

#include "burr/device/axes.h"
#include "support/folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace burr::workshop {
namespace {

TEST(DeviceBook, ComesBackAsItWasWritten) {
  DeviceBook book;
  ASSERT_TRUE(book.set("Touch T-1", "scale=0.5").ok());
  ASSERT_TRUE(book.set("Touch T-1", "dead_man=true").ok());
  ASSERT_TRUE(book.set("Odd \"name\" \\ 7", "max_force_n=2.5").ok());
  ASSERT_TRUE(book.set("Odd \"name\" \\ 7", "clutch_button=-1").ok());
  ASSERT_TRUE(book.set("CRTK arm /MTMR", "axes=far left up").ok());
  const DeviceBook again = DeviceBook::parse(book.text(), "devices.toml");
  EXPECT_EQ(device::words_of_axes(again.of("CRTK arm /MTMR").mapping.axes), "far left up");
  EXPECT_TRUE(again.troubles().empty()) << again.troubles().front();
  EXPECT_EQ(again.of("Touch T-1").mapping.scale, 0.5);
  EXPECT_TRUE(again.of("Touch T-1").mapping.dead_man);
  EXPECT_EQ(again.of("Odd \"name\" \\ 7").max_force_n, 2.5);
  EXPECT_EQ(again.of("Odd \"name\" \\ 7").mapping.clutch_button, -1);
  EXPECT_EQ(again.of("another").mapping.scale, 1);
  EXPECT_EQ(again.text(), book.text());
}

TEST(DeviceBook, RefusesInOneSentenceWhatCannotBe) {
  for (const char* wrong :
       {"scale", "scale=", "scale=0", "scale=99", "scale=nan", "scale=\"1\"", "scale=1,2",
        "colour=1", "=1", "", "dead_man=1", "mill_button=0.5", "mill_button=31", "max_force_n=-1",
        "axes=up", "axes=1", "axes=\"left up near\"", "scale=1\nmax_force_n=3"}) {
    DeviceBook book;
    const Status taken = book.set("a", wrong);
    const bool second_line = std::string(wrong).find('\n') != std::string::npos;
    EXPECT_EQ(taken.ok(), second_line) << wrong;
    if (!taken.ok()) {
      EXPECT_EQ(taken.error().trouble, Trouble::usage) << wrong;
      EXPECT_GT(taken.error().text.size(), 20U);
    }
    EXPECT_EQ(book.of("a").max_force_n, 0) << "only what was named";
  }
}

TEST(DeviceBook, TwoOfAKindHaveAPageEach) {
  device::DeviceSpec one, other, unknown;
  one.name = other.name = unknown.name = "Touch";
  one.serial = "T-1";
  other.serial = "T-2";
  EXPECT_EQ(id_of(one), "Touch T-1");
  EXPECT_EQ(id_of(unknown), "Touch");
  DeviceBook book;
  ASSERT_TRUE(book.set(id_of(one), "scale=2").ok());
  EXPECT_EQ(book.of(id_of(one)).mapping.scale, 2);
  EXPECT_EQ(book.of(id_of(other)).mapping.scale, 1);
}

TEST(DeviceBook, AFileWithTroubleLosesNothing) {
  const test::Folder own;
  const std::filesystem::path& folder = own.path();
  const auto file = folder / "devices.toml";
  std::ofstream(file) << "[\"Touch T-1\"]\nscale = 40\nmax_force_n = 2\nfoo = 1\n[";
  DeviceBook book = DeviceBook::read(file);
  ASSERT_EQ(book.troubles().size(), 1U);  // the text itself ends too early
  std::ofstream(file) << "[\"Touch T-1\"]\nscale = 40\nmax_force_n = 2\nfoo = 1\n";
  book = DeviceBook::read(file);
  ASSERT_EQ(book.troubles().size(), 2U);
  EXPECT_NE(book.troubles()[0].find("devices.toml"), std::string::npos);
  EXPECT_NE(book.troubles()[0].find("Touch T-1"), std::string::npos);
  EXPECT_EQ(book.of("Touch T-1").mapping.scale, 1);
  EXPECT_EQ(book.of("Touch T-1").max_force_n, 2);
  ASSERT_TRUE(book.write(file).ok());
  EXPECT_TRUE(std::filesystem::exists(folder / "devices.toml.old"));
  EXPECT_TRUE(DeviceBook::read(file).troubles().empty());
  EXPECT_TRUE(DeviceBook::read(folder / "none.toml").troubles().empty());
}

}  // namespace
}  // namespace burr::workshop
