#include "page.h"

#include <fmt/format.h>

#include "burr/base/markup.h"
#include "burr/base/version.h"

namespace burr::app {
namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>burr verify</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; color: #222; max-width: 1100px; margin: 2em auto; padding: 0 1em }
h1 { font-size: 1.5em } h2 { font-size: 1.2em; margin-top: 2.2em; border-bottom: 1px solid #ccc }
table { border-collapse: collapse; font-size: 13px; margin: 1em 0 }
td, th { border: 1px solid #ddd; padding: 2px 8px; text-align: left; font-variant-numeric: tabular-nums }
th { background: #f3f3f3 } td.n { text-align: right } .pass { color: #176b2c } .fail { color: #fff; background: #b3261e }
figure { margin: 1.2em 0 } figcaption, .about { color: #444; max-width: 75em } svg { max-width: 100%; height: auto }
.left { color: #7a4b00 }
</style></head><body>
)";

}  // namespace

std::string page(const VerifyReport& report) {
  std::string html = kHead;
  html += fmt::format("<h1>burr verify</h1><p>burr {} ({}): {} checks, {} failed.</p>\n",
                      base::version(), base::markup_text(base::build()), report.checks(),
                      report.failed());
  html +=
      "<p>A check of our method passes if the stated bound holds. A check of a baseline (another "
      "method, for comparison) passes if the baseline does what was predicted, including predicted "
      "failures.</p><ul>\n";
  for (const VerifyReport::Part& part : report.parts())
    html += fmt::format("<li><a href=\"#{}\">{}</a>: {} of {} passed, {:.1f} s</li>\n", part.name,
                        base::markup_text(part.title),
                        part.checks.size() - static_cast<std::size_t>(part.failed()),
                        part.checks.size(), part.took_s);
  html += "</ul>\n";
  for (const VerifyReport::Part& part : report.parts()) {
    html += fmt::format("<h2 id=\"{}\">{}</h2>\n<p class=\"about\">{}</p>\n", part.name,
                        base::markup_text(part.title), base::markup_text(part.about));
    for (const Plot& plot : part.plots)
      html += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", svg(plot),
                          base::markup_text(plot.caption));
    for (const Table& table : part.tables) {
      html += fmt::format("<p>{}</p>\n<table><tr>", base::markup_text(table.caption));
      for (const std::string& cell : table.head) html += "<th>" + base::markup_text(cell) + "</th>";
      html += "</tr>\n";
      for (const auto& row : table.rows) {
        html += "<tr>";
        for (const std::string& cell : row) html += "<td>" + base::markup_text(cell) + "</td>";
        html += "</tr>\n";
      }
      html += "</table>\n";
    }
    for (const std::string& sentence : part.left_out)
      html += fmt::format("<p class=\"left\">Not checked: {}</p>\n", base::markup_text(sentence));
    if (part.checks.empty()) continue;
    html +=
        "<table><tr><th>check</th><th>expected</th><th>measured</th><th>unit</th><th></th></tr>\n";
    for (const Check& check : part.checks)
      html += fmt::format(
          "<tr><td>{}</td><td class=\"n\">{}</td><td class=\"n\">{:.4g}</td><td>{}</td><td "
          "class=\"{}\">{}</td></tr>\n",
          base::markup_text(check.name), base::markup_text(check.expected), check.measured,
          base::markup_text(check.unit), check.pass ? "pass" : "fail",
          check.pass ? "pass" : "FAIL");
    html += "</table>\n";
  }
  return html + "</body></html>\n";
}

}  // namespace burr::app
