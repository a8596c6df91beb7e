// `burr fit` as a whole: a log with known constants becomes a table that the reader of materials
// accepts.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "burr/importing/materials.h"
#include "fit/made_logs.h"
#include "io/folder_of_test.h"
#include "support/test_places.h"

namespace burr::fit {
namespace {

class FitProgram : public burr::test::FolderTest {
 protected:
  void SetUp() override {
    program_ = burr::test::build_dir() + "/burr";
    ASSERT_TRUE(std::filesystem::exists(program_)) << "build the target burr first";
  }
  // The program's output, with "exit N" as the last line.
  std::string burr(const std::string& words) {
    return output_of("cd " + folder.string() + " && " + program_ + " " + words +
                     " 2>&1; echo \"exit $?\"");
  }
  void write_log(const std::string& name, const ForceLog& log, bool edge) {
    std::ofstream out(path(name));
    out << "time_s,normal_n,tangential_n,rpm,radius_mm,removal_mm3_s" << (edge ? ",edge_mm" : "")
        << "\n";
    for (const ForceRow& row : log.rows) {
      out << fmt::format("{},{},{},{},{},{}", row.time, row.normal, *row.tangential,
                         row.speed * 30 / std::numbers::pi, 1e3 * row.radius, 1e9 * row.removal);
      if (edge) out << fmt::format(",{}", 1e3 * *row.edge);
      out << "\n";
    }
  }
  std::string program_;
};

TEST_F(FitProgram, WhatItWritesIsReadAsMaterials) {
  BURR_FIT_SEEDED(random, 21);
  const test::Truth truth;
  write_log("bench.csv", test::level_2(truth, 400, 0.05, random), true);
  const std::string said = burr("fit bench.csv --material dentine --date 2026-11-22 --out d.toml");
  EXPECT_NE(said.find("exit 0"), std::string::npos) << said;
  EXPECT_NE(said.find("dentine: 400 rows used, 0 rows without cutting left out"), std::string::npos)
      << said;
  const auto read = importing::read_materials(path("d.toml"));
  ASSERT_TRUE(read.ok()) << read.error().text;
  const importing::Material& dentine = *read->find("dentine");
  const auto near = [](const std::optional<importing::Constant>& c, double value) {
    ASSERT_TRUE(c.has_value());
    EXPECT_NEAR(c->value / value, 1, 0.05);
    EXPECT_LT(c->low, c->value);
    EXPECT_GT(c->high, c->value);
    EXPECT_TRUE(c->calibrated);
    EXPECT_EQ(c->source, "burr fit bench.csv, 2026-11-22, 400 rows");
  };
  near(dentine.chip_tangential, truth.tc);
  near(dentine.edge_tangential, truth.te);
  near(dentine.chip_radial, truth.rc);
  near(dentine.edge_radial, truth.re);
  EXPECT_FALSE(dentine.conductivity->calibrated) << "the rest stays as it was";
  EXPECT_FALSE(read->find("enamel")->cutting_energy->calibrated);
  const std::string listed = burr("materials --materials d.toml");
  EXPECT_NE(listed.find("burr fit bench.csv"), std::string::npos) << listed;
  EXPECT_NE(listed.find("\n6 of "), std::string::npos) << listed;
}

TEST_F(FitProgram, SaysItAsJsonToo) {
  BURR_FIT_SEEDED(random, 22);
  const test::Truth truth;
  write_log("a.csv", test::level_1(truth, 300, 0, 0, random), false);
  const std::string said = burr("fit a.csv --json");
  const auto out = nlohmann::json::parse(said.substr(0, said.find('\n')));
  const auto& material = out.at("materials").at(0);
  EXPECT_EQ(material.at("rows_used"), 300);
  EXPECT_NEAR(material.at("constants").at("cutting_energy_J_mm3").at("value").get<double>(),
              1e-9 * truth.energy, 1e-6);
  EXPECT_NEAR(material.at("constants").at("cutting_friction").at("value").get<double>(), truth.mu,
              1e-6);
}

TEST_F(FitProgram, RefusesInOneSentence) {
  BURR_FIT_SEEDED(random, 23);
  const test::Truth truth;
  write_log("a.csv", test::level_1(truth, 30, 0, 0, random), false);
  write_log("two.csv", test::level_1(truth, 2, 0, 0, random), false);
  std::ofstream(path("bad.csv")) << "time_s,normal_n\n1,2\n";
  const auto expect = [this](const std::string& words, const char* code, const char* says) {
    const std::string said = burr(words);
    EXPECT_NE(said.find(std::string("exit ") + code), std::string::npos) << words << "\n" << said;
    EXPECT_NE(said.find(says), std::string::npos) << words << "\n" << said;
  };
  expect("fit two.csv", "65",
         "two.csv: no constant can be determined: cutting_friction: only 2 rows");
  expect("fit bad.csv", "65", "bad.csv: line 1: column tangential_n is missing");
  expect("fit none.csv", "74", "none.csv: cannot be read");
  expect("fit none.mcap", "74", "none.mcap");
  expect("fit a.csv --out x.toml", "2", "name it with --material");
  expect("fit a.csv --date yesterday", "2", "--date: \"yesterday\" is not a date");
  expect("fit a.csv --date 2026-02-30", "2", "is not a date");
  expect("materials --materials bad.csv", "65", "bad.csv: ");
  EXPECT_FALSE(std::filesystem::exists(path("x.toml")));
}

}  // namespace
}  // namespace burr::fit
