// Force logs as CSV: columns in any order, units in their names, and a sentence for each error.
#include "burr/fit/force_log.h"

#include <gtest/gtest.h>

#include <numbers>

namespace burr::fit {
namespace {

constexpr const char* kHead = "time_s,normal_n,tangential_n,rpm,radius_mm,removal_mm3_s\n";

TEST(ForceLog, ReadsColumnsByName) {
  const auto log = parse_force_log(
      "\xef\xbb\xbf# a bench\r\n\r\n removal_mm3_s , edge_mm, rpm, material, power_w, radius_mm, "
      "temperature_c, time_s, tangential_n, normal_n\r\n"
      "  # the first cut\n"
      "4,0.5,60000,dentine,7.5,2,37,0.1,0.8,2\r\n\n"
      "1e1,5e-1,-600,enamel,0,1.5,37,0.2,-.5,0",
      "a.csv");
  ASSERT_TRUE(log.ok()) << log.error().text;
  ASSERT_EQ(log->rows.size(), 2U);
  const ForceRow& row = log->rows[0];
  EXPECT_NEAR(row.time, 0.1, 1e-15);
  EXPECT_NEAR(row.normal, 2, 1e-15);
  EXPECT_NEAR(*row.tangential, 0.8, 1e-15);
  EXPECT_NEAR(row.speed, 2000 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(row.radius, 2e-3, 1e-15);
  EXPECT_NEAR(row.removal, 4e-9, 1e-20);
  EXPECT_NEAR(*row.power, 7.5, 1e-15);
  EXPECT_NEAR(*row.edge, 0.5e-3, 1e-15);
  EXPECT_EQ(log->materials[row.material], "dentine");
  EXPECT_EQ(log->materials[log->rows[1].material], "enamel");
  EXPECT_LT(log->rows[1].speed, 0);
  ASSERT_EQ(log->notices.size(), 1U);
  EXPECT_EQ(log->notices[0], "a.csv: line 3: column \"temperature_c\" is not used");
}

TEST(ForceLog, WhatIsOptionalMayBeMissing) {
  const auto log = parse_force_log(std::string(kHead) + "0,1,0.4,40000,2,3\n", "a.csv");
  ASSERT_TRUE(log.ok()) << log.error().text;
  EXPECT_FALSE(log->rows[0].power || log->rows[0].edge);
  EXPECT_EQ(log->materials.at(log->rows[0].material), "");
}

TEST(ForceLog, BadLogsEndInOneSentence) {
  const std::string head = kHead;
  const std::pair<std::string, const char*> cases[] = {
      {"", "a.csv: is empty; the first line must name the columns: time_s, normal_n"},
      {"# only words\n\n", "is empty"},
      {head, "has no rows"},
      {"time_s,normal_n,tangential_n,rpm,removal_mm3_s\n", "line 1: column radius_mm is missing"},
      {"0,1,0.4,40000,2,3\n", "line 1: column time_s is missing"},
      {"# x\ntime_s,time_s,normal_n\n", "line 2: column time_s appears twice"},
      {head + "0,1,0.4,40000,2\n", "line 2: 5 values, but the first line names 6 columns"},
      {head + "0,1,0.4,40000,2,3,\n", "line 2: 7 values"},
      {head + "0,1,0.4,40000,2,3\n\n#\n0,one,0.4,40000,2,3\n",
       "line 5: column normal_n: \"one\" is not a number"},
      {head + "0,1,,40000,2,3\n", "line 2: column tangential_n: \"\" is not a number"},
      {head + "0,1,0.4 N,40000,2,3\n", "\"0.4 N\" is not a number"},
      {head + "0,1,nan,40000,2,3\n", "column tangential_n: \"nan\""},
      {head + "0,1,0.4,inf,2,3\n", "column rpm: \"inf\""},
      {head + "0,1,0.4,1e300,2,3\n", "column rpm"},
      {head + "0,1,0.4,40000,0,3\n", "line 2: column radius_mm: 0 is not a radius"},
      {head + "0,1,0.4,40000,-2,3\n", "column radius_mm: -2"},
      {"edge_mm," + head + "-1,0,1,0.4,40000,2,3\n", "line 2: column edge_mm: -1 is not a length"},
      {"material," + head + std::string(101, 'x') + ",0,1,0.4,40000,2,3\n",
       "line 2: column material: the name"},
      {"time_s;normal_n;tangential_n;rpm;radius_mm;removal_mm3_s\n", "separated by commas"},
  };
  for (const auto& [text, words] : cases) {
    const auto log = parse_force_log(text, "a.csv");
    ASSERT_FALSE(log.ok()) << text;
    EXPECT_EQ(log.error().text.find("a.csv: "), 0U) << log.error().text;
    EXPECT_NE(log.error().text.find(words), std::string::npos) << text << log.error().text;
    EXPECT_EQ(log.error().text.find('\n'), std::string::npos);
  }
  const auto missing = read_force_log("/no/such/folder/b.csv");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().trouble, Trouble::io);
  EXPECT_EQ(missing.error().text.find("b.csv: cannot be read"), 0U) << missing.error().text;
}

}  // namespace
}  // namespace burr::fit
