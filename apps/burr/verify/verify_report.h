// apps/burr/verify/verify_report.h - a report: what was expected, what was measured, and the series of
// data.
//
//     VerifyReport::Part& part = report.begin("friction", "Friction", "the question that this part answers");
//     part.near("stick-slip.threshold", 0.300, measured, 0.003, "");  // one line, one verdict
//     part.plot({...});  part.table({...});  part.cannot("no data: ../shared/data is absent");
//
// A check says what it judges. A check of burr's own method must hold. A check of a baseline must
// fail as predicted. A check that is only information never counts as wrong. Thread: one. Numbers
// in SI unless the unit says otherwise.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "burr/base/result.h"

namespace burr::app {

struct Check {
  std::string name;      // part.subject.case
  std::string expected;  // as text: "0.300 +- 0.003", "<= 0.5", "> 0.75"
  double measured = 0;
  std::string unit;
  bool pass = true;
};

// Columns of numbers; the others are drawn over the first.
struct Series {
  std::string name;  // of the file, without .csv
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
};

struct Line {
  std::string legend;
  std::vector<double> x, y;
  bool dashed = false;  // true: an expected value
  bool dots = false;
};
struct Axes {
  std::string title, x, y;  // with units
  std::vector<Line> lines;
  bool log_x = false, log_y = false;
};
// One or several axes side by side, with one caption that says what to expect.
struct Plot {
  std::string caption;
  int columns = 1;
  std::vector<Axes> axes;
};

struct Table {
  std::string caption;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

class VerifyReport {
 public:
  struct Part {
    std::string name, title, about;
    std::vector<Check> checks;
    std::vector<Series> series;
    std::vector<Plot> plots;
    std::vector<Table> tables;
    std::vector<std::string> left_out;
    double took_s = 0;

    void near(const std::string& what, double expected, double measured, double tolerance,
              const std::string& unit);
    void at_most(const std::string& what, double bound, double measured, const std::string& unit);
    void at_least(const std::string& what, double bound, double measured, const std::string& unit);
    void plot(Plot plot) { plots.push_back(std::move(plot)); }
    void table(Table table) { tables.push_back(std::move(table)); }
    void cannot(std::string sentence) { left_out.push_back(std::move(sentence)); }
    [[nodiscard]] int failed() const;
  };

  Part& begin(std::string name, std::string title, std::string about);
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] int failed() const;
  [[nodiscard]] int checks() const;

  // The check on one line, as on the terminal.
  [[nodiscard]] static std::string line(const Check& check);
  [[nodiscard]] std::string json() const;
  // The text of bench/results/validation.md; nothing in it depends on the time of day or the
  // computer.
  [[nodiscard]] std::string markdown() const;
  // Writes FOLDER/<series>.csv, <part>_plot<n>_<axes>.csv, report.html, validation.md, verify.json.
  // html: the content of report.html, from page(*this).
  [[nodiscard]] Status write(const std::string& folder, const std::string& html) const;

 private:
  std::vector<Part> parts_;
};

}  // namespace burr::app
