#include "commands/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "burr/base/markup.h"
#include "burr/base/new_file.h"
#include "burr/base/version.h"
#include "shared/html_page.h"
#include "shared/recorded_session.h"

namespace burr::app {
namespace {

using Row = std::pair<std::string, std::string>;

// in the order of interest
std::vector<Row> rows_of(const Summary& s) {
  std::vector<Row> rows;
  const auto row = [&rows](std::string name, std::string value) {
    rows.emplace_back(std::move(name), std::move(value));
  };
  row("bone", fmt::format("{}, {} x {} x {} voxels of {:.3g} mm", s.what, s.size.x(), s.size.y(),
                          s.size.z(), 1e3 * s.voxel));
  row("burr", fmt::format("{:.2g} mm, {:.0f} rpm", 2e3 * s.burr_radius, s.rpm));
  row("hand", s.hand);
  row("time", fmt::format("{:.1f} s, {} ticks at {:.0f} Hz, {}", s.seconds, s.ticks, s.rate_hz,
                          s.realtime ? "paced by the clock" : "as fast as possible"));
  row("removed", fmt::format("{:.2f} mm\u00b3", 1e9 * s.removed));
  row("asked for by the force", fmt::format("{:.2f} mm\u00b3, of which {:.2f} could not be cut",
                                            1e9 * s.asked, 1e9 * s.not_cut));
  if (s.added > 0) row("added", fmt::format("{:.2f} mm\u00b3", 1e9 * s.added));
  row("force", fmt::format("peak {:.2f} N, mean in contact {:.2f} N", s.peak_force, s.mean_force));
  row("work of a tick",
      fmt::format("median {:.1f}, p99 {:.1f}, p99.9 {:.1f}, longest {:.1f} \u00b5s", s.p50_us,
                  s.p99_us, s.p999_us, s.max_us));
  if (s.realtime) row("ticks", fmt::format("{} late, {} missed", s.late, s.missed));
  row("remarks", s.flags.empty() ? "none" : s.flags);
  row("bone's hash", fmt::format("0x{:016x}", s.bone_hash));
  return rows;
}

}  // namespace

Status write_summary(const Summary& summary, const std::filesystem::path& folder) {
  std::string page = fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\">"
      "<title>burr: a session</title><style>{}</style>\n<h1>A session on {}</h1>\n",
      kPageStyle, base::markup_text(summary.what));
  if (!summary.task.empty())
    page +=
        fmt::format("<p style=\"white-space:pre-line\">{}</p>\n", base::markup_text(summary.task));
  for (const auto& [file, caption] : summary.pictures)
    page +=
        fmt::format("<figure><img src=\"{0}\" alt=\"{1}\"><figcaption>{1}</figcaption></figure>\n",
                    base::markup_text(file), base::markup_text(caption));
  page += "<table>\n";
  for (const auto& [name, value] : rows_of(summary))
    page += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", base::markup_text(name),
                        base::markup_text(value));
  page += "</table>\n";
  if (!summary.tissues.empty()) {
    page += "<h1>Removed, by tissue</h1>\n<table>\n";
    for (const TissueLoss& loss : summary.tissues)
      page += fmt::format("<tr{}><td>{}</td><td>{:.2f} mm\u00b3{}</td></tr>\n",
                          loss.spare ? " class=\"spare\"" : "", base::markup_text(loss.name),
                          1e9 * loss.removed, loss.spare ? ", was to be spared" : "");
    page += "</table>\n";
  }
  if (!summary.recording.empty())
    page += fmt::format(
        "<p>Recording: <a href=\"{0}\">{0}</a>; <code>burr replay {0} --check</code> simulates it "
        "again.</p>\n",
        base::markup_text(summary.recording));
  page += fmt::format("<footer>burr {} ({})</footer></html>\n", base::version(),
                      base::markup_text(base::build()));

  Result<base::NewFile> file = base::NewFile::create((folder / "summary.html").string());
  if (!file) return file.error();
  file->write(page);
  return file->put_in_place();
}

std::string summary_text(const Summary& summary) {
  std::string text;
  for (const auto& [name, value] : rows_of(summary))
    text += fmt::format("{:<20} {}\n", name, value);
  for (const TissueLoss& loss : summary.tissues)
    text += fmt::format("{:<20} {} {:.2f} mm\u00b3{}\n", "", loss.name, 1e9 * loss.removed,
                        loss.spare ? ", was to be spared" : "");
  return text;
}

}  // namespace burr::app
