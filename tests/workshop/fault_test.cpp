// The ticks before a fault, as a file.
#include "burr/workshop/fault_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "burr/haptics/contact.h"
#include "burr/rt/flags.h"
#include "support/folder.h"

namespace burr::workshop {
namespace {

TEST(FaultFile, SaysWhatHappenedAndHoldsEveryTick) {
  auto report = std::make_unique<tick::FaultReport>();
  report->flags = rt::kFlagHandLost;
  report->count = 200;
  for (int n = 0; n < 200; ++n) {
    tick::TickRow& row = report->rows[static_cast<std::size_t>(n)];
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

// Each number under its own name, in the unit of that name.
TEST(FaultFile, ColumnsHoldWhatTheirNamesSay) {
  auto report = std::make_unique<tick::FaultReport>();
  report->count = 1;
  tick::TickRow& row = report->rows[0];
  row.tick = 7;
  row.hand.world_from_tool.p = {0.001, 0.002, 0.003};
  row.hand.velocity = {0.011, 0.012, 0.013};
  row.contact.proxy = {0.021, 0.022, 0.023};
  row.contact.force = {0.1, 0.2, 0.3};
  row.contact.torque = {0.01, 0.02, 0.03};
  row.contact.depth = 0.0045;
  row.contact.flags = 5;
  row.hand.pedal = 0.5;
  row.hand.buttons = 3;
  row.took_us = 12.5F;
  row.late_us = 1.5F;
  std::istringstream text(fault_text(*report, {}, 1000, ""));
  std::string names, values;
  while (std::getline(text, names) && names[0] == '#') {
  }
  ASSERT_TRUE(std::getline(text, values));
  EXPECT_EQ(names,
            "tick,valid,hand_x_mm,hand_y_mm,hand_z_mm,velocity_x_mm_s,velocity_y_mm_s,"
            "velocity_z_mm_s,proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,"
            "torque_x_nm,torque_y_nm,torque_z_nm,depth_mm,pedal,buttons,flags,took_us,late_us");
  EXPECT_EQ(values, "7,1,1,2,3,11,12,13,21,22,23,0.1,0.2,0.3,0.01,0.02,0.03,4.5,0.5,3,5,12.5,1.5");
}

TEST(FaultFile, KeepsTheNewestTwenty) {
  const test::Folder own;
  const std::filesystem::path folder = own / "faults";
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
  const auto next = keep_fault(folder, "other words\n");
  ASSERT_TRUE(next.ok()) << next.error().text;
  EXPECT_NE(*next, *kept) << "however soon it comes";
  EXPECT_TRUE(std::filesystem::exists(*next));
  EXPECT_TRUE(std::filesystem::exists(*kept));
  const auto nowhere = keep_fault("/proc/no/such", "x");
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().text.find("/proc/no/such"), std::string::npos);
}

}  // namespace
}  // namespace burr::workshop
