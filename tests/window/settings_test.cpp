// Settings come back as they were written; what cannot be is named, and never lost.
#include "shared/user_settings.h"
#include "support/folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace burr::app {
namespace {

namespace fs = std::filesystem;

class SettingsFile : public testing::Test {
 protected:
  void put(const std::string& text) const { std::ofstream(path_) << text; }
  [[nodiscard]] static std::string text_of(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  const test::Folder own_;
  fs::path folder_ = own_.path();
  fs::path path_ = folder_ / "deep" / ".." / "settings.toml";
};

TEST_F(SettingsFile, ComesBackAsItWasWrittenWithEveryValueChanged) {
  Settings s;
  s.language = "sv";
  s.scale = 1.25;
  s.left_handed = true;
  s.device = "touch:\"Left\" \\ one";
  s.force_limit_n = 2.5;
  s.press_mm = 3;
  s.turn_pace = 0.5;
  s.zoom_pace = 2;
  s.pad_pace = 2;
  s.pad_dead = 0.25;
  s.pedal_mill = 3;
  s.pedal_burr = 0;
  s.pedal_coolant = 4;
  s.pedal_tool = 5;
  s.pedal_clutch = 5;
  s.pedal_rest = 1;
  s.shaft_touches = true;
  s.effects = false;
  s.stereo = render::Stereo::interleaved;
  s.stereo_depth = 0.5;
  s.swap_eyes = true;
  s.headset = true;
  s.panels = false;
  s.help = true;
  s.autosave = false;
  s.sessions_kept = 3;
  s.sessions_mb = 100;
  s.recent_names = true;
  s.remember_scans = false;
  const fs::path path = folder_ / "made" / "by itself" / "settings.toml";
  const Status written = write_settings(s, path, false);
  ASSERT_TRUE(written) << written.error().text;
  const SettingsRead read = read_settings(path);
  EXPECT_TRUE(read.troubles.empty()) << read.troubles.front();
  EXPECT_EQ(settings_text(read.settings), settings_text(s));
  EXPECT_NE(settings_text(read.settings), settings_text(Settings()));
}

TEST_F(SettingsFile, IsExplainedLineByLine) {
  // every line that sets something has a line above it that says what
  const std::string text = settings_text({});
  std::istringstream lines(text);
  std::string line, before;
  int set = 0;
  while (std::getline(lines, line)) {
    if (line.find(" = ") != std::string::npos && line.front() != '#') {
      ++set;
      EXPECT_EQ(before.substr(0, 2), "# ") << line;
    }
    before = line;
  }
  EXPECT_EQ(set, 30);
}

TEST_F(SettingsFile, WhichIsNotThereMeansTheDefaultsWithoutTrouble) {
  const SettingsRead read = read_settings(path_);
  EXPECT_TRUE(read.troubles.empty());
  EXPECT_EQ(settings_text(read.settings), settings_text({}));
}

TEST_F(SettingsFile, NamesFileAndFieldOfWhatCannotBeAndTakesTheRest) {
  const SettingsRead read = parse_settings(
      "scale = 40\nleft_handed = true\nlanguage = \"klingon\"\npanels = 1\ncolour = 2\n"
      "force_limit_n = nan\nstereo = \"both\"\ndevice = \"broom\"\n",
      "settings.toml");
  EXPECT_TRUE(read.settings.left_handed);
  EXPECT_EQ(read.settings.scale, 1);
  EXPECT_EQ(read.settings.force_limit_n, 3.3);
  ASSERT_EQ(read.troubles.size(), 7U);
  for (const std::string& one : read.troubles)
    EXPECT_EQ(one.rfind("settings.toml: ", 0), 0U) << one;
  std::string all;
  for (const std::string& one : read.troubles) all += one + "\n";
  EXPECT_NE(all.find("scale: must be a number from 0.5 to 3"), std::string::npos) << all;
  EXPECT_NE(
      all.find("language: must be empty, or one of \"en\" English, \"de\" Deutsch, \"sv\" Svenska"),
      std::string::npos)
      << all;
  EXPECT_NE(all.find("stereo: must be \"off\", \"side_by_side\""), std::string::npos) << all;
  EXPECT_NE(all.find("device: must be empty, or one of touch, "), std::string::npos) << all;
  EXPECT_NE(all.find("panels: must be true or false"), std::string::npos) << all;
  EXPECT_NE(all.find("colour: is not a setting of this version"), std::string::npos) << all;
}

TEST_F(SettingsFile, ThatIsBrokenIsKeptAsideWhenSettingsAreWritten) {
  path_ = folder_ / "settings.toml";
  const std::string broken = "scale = = 3\nmy own notes";
  put(broken);
  const SettingsRead read = read_settings(path_);
  ASSERT_EQ(read.troubles.size(), 1U);
  EXPECT_EQ(read.troubles[0].rfind("settings.toml", 0), 0U) << read.troubles[0];
  EXPECT_EQ(text_of(path_), broken) << "reading changed the file";
  ASSERT_TRUE(write_settings(read.settings, path_, true));
  EXPECT_EQ(text_of(folder_ / "settings.toml.old"), broken);
  EXPECT_TRUE(read_settings(path_).troubles.empty());
}

}  // namespace
}  // namespace burr::app
