// Cells of tables: no text becomes a formula, and every text comes back.
#include "burr/base/table_cell.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace burr::base {
namespace {

// As a spreadsheet or Python's csv takes a cell out of a line.
std::string without_quotes(const std::string& cell) {
  if (!cell.starts_with('"')) return cell;
  std::string out;
  for (std::size_t n = 1; n + 1 < cell.size(); ++n) {
    out += cell[n];
    if (cell[n] == '"') ++n;
  }
  return out;
}

TEST(TableCell, ATextIsNoFormulaAndANumberStaysOne) {
  EXPECT_EQ(table_cell("=1+1"), "'=1+1");
  EXPECT_EQ(table_cell("=HYPERLINK(\"http://x\",\"y\")"),
            "\"'=HYPERLINK(\"\"http://x\"\",\"\"y\"\")\"");
  EXPECT_EQ(table_cell("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(table_cell("+46 70 123"), "'+46 70 123");
  EXPECT_EQ(table_cell("-cmd|' /C calc'!A0"), "'-cmd|' /C calc'!A0");
  EXPECT_EQ(table_cell("\t=1"), "\"'\t=1\"");
  EXPECT_EQ(table_cell("\r=1"), "\"'\r=1\"");
  EXPECT_EQ(table_cell("'=1"), "''=1");
  for (const char* number : {"-5", "-0.25", "-3e-07", "-1.5E+10", "7", "0"})
    EXPECT_EQ(table_cell(number), number);
  for (const char* text : {"-", "-5+2", "-inf", "-nan", "-1-2", "--5", "+5"})
    EXPECT_EQ(table_cell(text), std::string("'") + text);
  for (const char* text : {"", "Anna", "it's", "'tis", "a=b", "5 - 3"})
    EXPECT_EQ(table_cell(text), text);
  EXPECT_EQ(table_cell("a;=b"), "\"a;=b\"");
  EXPECT_EQ(table_cell("# Anna"), "\"# Anna\"");
  EXPECT_EQ(text_of_cell("'tis"), "'tis");
}

TEST(TableCell, EveryTextComesBack) {
  const unsigned seed = 31;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const std::string letters = "=+-@\t\r\n'\",;# 0159.eEaäx";
  for (int n = 0; n < 200000; ++n) {
    std::string text;
    for (auto size = random() % 7; size > 0; --size) text += letters[random() % letters.size()];
    const std::string cell = table_cell(text), shown = without_quotes(cell);
    ASSERT_EQ(text_of_cell(shown), text) << cell;
    if (!shown.empty() && std::string("=+@\t\r\n").find(shown[0]) != std::string::npos)
      FAIL() << cell;
  }
}

}  // namespace
}  // namespace burr::base
