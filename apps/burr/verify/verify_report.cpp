#include "verify_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "burr/base/new_file.h"
#include "burr/base/table_cell.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

constexpr std::size_t kMostInPage = 80;

std::string number(double value) { return fmt::format("{:.4g}", value); }

Status write_file(const std::string& path, const std::string& text) {
  auto file = base::NewFile::create(path, base::kForAll);
  if (!file) return file.error();
  file->write(text);
  return file->put_in_place();
}

std::vector<std::string> cells_of(const std::vector<std::string>& texts) {
  std::vector<std::string> cells;
  for (const std::string& text : texts) cells.push_back(base::table_cell(text));
  return cells;
}

std::string csv(const Series& series) {
  std::string text = fmt::format("{}\n", fmt::join(cells_of(series.columns), ","));
  for (const std::vector<double>& row : series.rows)
    text += fmt::format("{:.9g}\n", fmt::join(row, ","));
  return text;
}

// The curves of a pair of axes, one row per point.
std::string csv(const Axes& axes) {
  std::string text =
      fmt::format("line,{},{}\n", base::table_cell(axes.x), base::table_cell(axes.y));
  for (const Line& line : axes.lines)
    for (std::size_t n = 0; n < std::min(line.x.size(), line.y.size()); ++n)
      text +=
          fmt::format("{},{:.9g},{:.9g}\n", base::table_cell(line.legend), line.x[n], line.y[n]);
  return text;
}

std::string row_of(const std::vector<std::string>& cells) {
  return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

}  // namespace

void VerifyReport::Part::near(const std::string& what, double expected, double measured,
                              double tolerance, const std::string& unit) {
  checks.push_back({name + "." + what, fmt::format("{} +- {}", number(expected), number(tolerance)),
                    measured, unit, std::abs(measured - expected) <= tolerance});
}

void VerifyReport::Part::at_most(const std::string& what, double bound, double measured,
                                 const std::string& unit) {
  checks.push_back({name + "." + what, "<= " + number(bound), measured, unit, measured <= bound});
}

void VerifyReport::Part::at_least(const std::string& what, double bound, double measured,
                                  const std::string& unit) {
  checks.push_back({name + "." + what, ">= " + number(bound), measured, unit, measured >= bound});
}

int VerifyReport::Part::failed() const {
  int count = 0;
  for (const Check& check : checks) count += check.pass ? 0 : 1;
  return count;
}

VerifyReport::Part& VerifyReport::begin(std::string name, std::string title, std::string about) {
  Part part;
  part.name = std::move(name);
  part.title = std::move(title);
  part.about = std::move(about);
  parts_.push_back(std::move(part));
  return parts_.back();
}

int VerifyReport::failed() const {
  int count = 0;
  for (const Part& part : parts_) count += part.failed();
  return count;
}

int VerifyReport::checks() const {
  std::size_t count = 0;
  for (const Part& part : parts_) count += part.checks.size();
  return static_cast<int>(count);
}

std::string VerifyReport::line(const Check& check) {
  return fmt::format("{:<52} {:>22} {:>12} {:<7} {}", check.name, check.expected,
                     number(check.measured), check.unit, check.pass ? "pass" : "FAIL");
}

std::string VerifyReport::json() const {
  nlohmann::json out;
  out["checks"] = checks();
  out["failed"] = failed();
  for (const Part& part : parts_) {
    nlohmann::json one = {
        {"name", part.name}, {"took_s", part.took_s}, {"left_out", part.left_out}};
    for (const Check& check : part.checks)
      one["checks"].push_back({{"name", check.name},
                               {"expected", check.expected},
                               {"measured", check.measured},
                               {"unit", check.unit},
                               {"pass", check.pass}});
    out["parts"].push_back(one);
  }
  return json_line(out);
}

std::string VerifyReport::markdown() const {
  std::string text =
      "# Validation\n\n"
      "`burr verify --out DIR --data DATA` writes this page; edits made by hand are lost. Each "
      "check compares what burr does with a formula, a theory or an independent reference. A check "
      "of a baseline (another method, for comparison) passes if the baseline does what was "
      "predicted, including predicted failures. The plots are in `DIR/report.html`; every series "
      "is a CSV file beside it. What `./test` checks in addition: "
      "[tested.md](../../docs/develop/tested.md).\n\n"
      "**Not** validated: that it feels like bone. Cutting energies are the middle of published "
      "ranges (cortical bone about 1 J/mm3), and so is friction. Nobody has compared a session "
      "with a real drill in the hand yet. Until somebody has, burr is for learning how such a "
      "simulator works. It is not for judging people, and it is no medical device.\n\n"
      "The marks of a session are compared with scripted surgeons of known faults: "
      "[acceptance.md](../../docs/understand/acceptance.md) has the figures. That shows which "
      "items of a rubric "
      "respond to faults that were put in. A surgeon without errors shows whether what a "
      "rubric asks for can be done; the page says which items it misses. Neither proves "
      "that a person would agree with a mark or with the order of two, that a threshold is "
      "right (all are defaults), that a person's faults are like the scripted ones, or "
      "anything about real bones: the cases are formulas, one bone each, and the people who "
      "wrote the measures wrote the surgeons.\n\n"
      "| part | checks | failed |\n|---|---|---|\n";
  for (const Part& part : parts_)
    text += row_of({part.title, std::to_string(part.checks.size()), std::to_string(part.failed())});
  for (const Part& part : parts_) {
    text += fmt::format("\n## {}\n\n{}\n", part.title, part.about);
    // with many checks of one kind, the table says more than their lines
    const bool all = part.checks.size() <= kMostInPage;
    if (!all)
      text += fmt::format("\n{} checks, {} failed; all of them are listed in `report.html`.\n",
                          part.checks.size(), part.failed());
    std::string rows;
    for (const Check& check : part.checks)
      if (all || !check.pass)
        rows += row_of({check.name, check.expected, number(check.measured), check.unit,
                        check.pass ? "pass" : "**FAIL**"});
    if (!rows.empty())
      text += "\n| check | expected | measured | unit | |\n|---|---|---|---|---|\n" + rows;
    for (const Table& table : part.tables) {
      text += "\n" + table.caption + "\n\n" + row_of(table.head) + "|";
      for (std::size_t n = 0; n < table.head.size(); ++n) text += "---|";
      text += "\n";
      for (const auto& row : table.rows) text += row_of(row);
    }
    for (const std::string& sentence : part.left_out)
      text += fmt::format("\nNot checked: {}\n", sentence);
  }
  return text;
}

Status VerifyReport::write(const std::string& folder, const std::string& html) const {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be made: {}; choose another folder", folder,
                                          trouble.message()));
  const std::filesystem::path into(folder);
  for (const Part& part : parts_) {
    int plots = 0;
    for (const Plot& plot : part.plots) {
      ++plots;
      for (std::size_t n = 0; n < plot.axes.size(); ++n) {
        const std::string name = fmt::format("{}_plot{}_{}.csv", part.name, plots, n + 1);
        if (Status done = write_file((into / name).string(), csv(plot.axes[n])); !done) return done;
      }
    }
    for (const Series& series : part.series)
      if (Status done = write_file((into / (series.name + ".csv")).string(), csv(series)); !done)
        return done;
  }
  if (Status done = write_file((into / "validation.md").string(), markdown()); !done) return done;
  if (Status done = write_file((into / "verify.json").string(), json() + "\n"); !done) return done;
  return write_file((into / "report.html").string(), html);
}

}  // namespace burr::app
