// The last ticks before a fault, on disk.
#include "fault_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "burr/haptics/contact.h"

namespace burr::app {
namespace {

TEST(FaultFile, SaysWhatHappenedAndHoldsEveryTick) {
  auto report = std::make_unique<sim::FaultReport>();
  report->flags = haptics::kFlagHandLost;
  report->count = 200;
  for (int n = 0; n < 200; ++n) {
    record::TickRow& row = report->rows[static_cast<std::size_t>(n)];
    row.tick = 1000 + static_cast<std::uint64_t>(n);
    row.hand.world_from_tool.p = {1e-3 * n, 0.002, -0.003};
    row.hand.valid = n < 195;
    row.contact.force = {0, 0.5, 0};
  }
  device::DeviceSpec spec;
  spec.name = "Touch\n# nonsense";
  spec.serial = "T-1";
  std::istringstream text(fault_text(*report, spec, 1000, "It does not answer."));
  std::string line, head;
  int rows = 0, last_rows = 0;
  std::size_t columns = 0;
  while (std::getline(text, line)) {
    if (line[0] == '#') {
      head += line + "\n";
      continue;
    }
    const auto commas = static_cast<std::size_t>(std::count(line.begin(), line.end(), ','));
    if (columns == 0) columns = commas;
    EXPECT_EQ(commas, columns) << line;
    if (line.rfind("1199,0,199,2,-3,", 0) == 0) {
      EXPECT_NE(line.find(",0,0.5,0,"), std::string::npos);
      ++last_rows;
    }
    ++rows;
  }
  EXPECT_EQ(last_rows, 1);
  EXPECT_EQ(rows, 201) << "the names and 200 ticks";
  EXPECT_NE(head.find("lost the hand"), std::string::npos) << head;
  EXPECT_NE(head.find("does not answer"), std::string::npos);
  EXPECT_NE(head.find("Touch # nonsense T-1"), std::string::npos) << head;
}

TEST(FaultFile, KeepsTheNewestTwenty) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("burr_faults_" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  for (int n = 10; n < 35; ++n)
    std::ofstream(folder / ("fault-20200101-0000" + std::to_string(n) + ".csv")) << "x";
  std::ofstream(folder / "mine.txt") << "x";
  const auto kept = keep_fault(folder, "words\n");
  ASSERT_TRUE(kept.ok()) << kept.error().text;
  EXPECT_TRUE(std::filesystem::exists(*kept));
  EXPECT_TRUE(std::filesystem::exists(folder / "mine.txt"));
  EXPECT_FALSE(std::filesystem::exists(folder / "fault-20200101-000015.csv"));
  EXPECT_TRUE(std::filesystem::exists(folder / "fault-20200101-000034.csv"));
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++count;
  EXPECT_EQ(count, 21);
  std::filesystem::remove_all(folder);
  const auto nowhere = keep_fault("/proc/no/such", "x");
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().text.find("/proc/no/such"), std::string::npos);
}

}  // namespace
}  // namespace burr::app
