// `burr report`: a recording becomes one page: what was met, why, and what to do next.
// `burr compare`: two recordings of one case, side by side.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/report/make_report.h"
#include "burr/report/report_page.h"
#include "burr/report/score_words.h"
#include "burr/report/scored.h"
#include "burr/report/self_marks.h"
#include "shared/front_words.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"
#include "shared/word_names.h"

namespace burr::app {
namespace {

struct Options {
  std::string source, other, rubric, out, self, beside, language = "en";
  scenario::BoneRecipe volume;
  std::size_t pictures = 12;
};

Result<report::Scored> scored_file(const std::string& file, const Options& options) {
  auto judged = report::judged_by(file, options.rubric);
  if (!judged) return judged.error();
  print_notices(judged->player->notices());
  return report::scored(std::move(*judged), options.volume, progress());
}

Status write_page(const report::Report& report, const Options& options) {
  const std::string page = report::page_of(report);
  auto file = base::NewFile::create(options.out);
  if (!file) return file.error();
  file->write(page);
  if (const Status written = file->put_in_place(); !written) return written;
  std::size_t items = 0, pictures = 0;
  for (const report::ReportSides& side : report.sides) pictures += side.pictures.size();
  for (const report::ReportPart& part : report.parts) {
    items += part.items.size();
    for (const report::ReportItem& item : part.items) pictures += item.pictures.size();
  }
  fmt::print("{}: {} items, {} pictures, {:.1f} MB\n", base::printable(options.out), items,
             pictures, 1e-6 * static_cast<double>(page.size()));
  return fine();
}

Status run_report(const Options& options) {
  const Status possible =
      check_outputs({options.source, options.beside, options.self, options.volume.source},
                    {{"--out", options.out, {".html"}}});
  if (!possible) return possible;
  speak(options.language);
  auto judged = report::judged_by(options.source, options.rubric);
  if (!judged) return judged.error();
  report::ReportSettings settings;
  settings.most_pictures = options.pictures;
  settings.rubric = options.rubric;
  settings.self = report::recorded_self_marks(*judged->player, judged->rubric);
  if (!options.self.empty()) {
    auto marks = report::read_self_marks(options.self, judged->rubric);
    if (!marks) return marks.error();
    settings.self = std::move(*marks);
  }
  print_notices(judged->player->notices());
  auto mine = report::scored(std::move(*judged), options.volume, progress());
  if (!mine) return mine.error();
  std::optional<report::Scored> expert;
  if (!options.beside.empty()) {
    auto made = scored_file(options.beside, options);
    if (!made) return made.error();
    expert = std::move(*made);
    settings.beside = &*expert;
  }
  const auto report = report::report_on(*mine, settings, progress());
  if (!report) return report.error();
  return write_page(*report, options);
}

// Item by item, for a terminal.
void print_comparison(const report::Scored& a, const report::Scored& b) {
  const scoring::Rubric& rubric = a.judged.rubric;
  fmt::print("{}, version {}\n  {:<26}  {:<26}  {}\n", base::printable(rubric.name), rubric.version,
             "", "A", "B");
  const auto cell = [](const scoring::Outcome& outcome) {
    std::string text = scoring::word_of(scoring::standing_of(outcome));
    if (outcome.value) text += " (" + scoring::text_of(outcome.quantity, *outcome.value) + ")";
    return text;
  };
  for (std::size_t n = 0; n < rubric.items.size(); ++n) {
    const scoring::Outcome &first = a.score.outcomes[n], &second = b.score.outcomes[n];
    const bool same = scoring::standing_of(first) == scoring::standing_of(second);
    fmt::print("{} {:<26}  {:<26}  {}\n", same ? " " : "*", base::printable(rubric.items[n].id),
               cell(first), cell(second));
  }
  for (const auto& [name, one] : {std::pair{"A", &a}, std::pair{"B", &b}})
    for (const std::string& line :
         {report::total_line(rubric, scoring::Part::product, one->score.product),
          report::total_line(rubric, scoring::Part::process, one->score.process)})
      if (!line.empty()) fmt::print("{}: {}\n", name, line);
  fmt::print("*: the two differ. No threshold was compared with people; there is no grade.\n");
}

Status run_compare(const Options& options) {
  const Status possible = check_outputs({options.source, options.other, options.volume.source},
                                        {{"--out", options.out, {".html"}}});
  if (!possible) return possible;
  speak(options.language);
  auto a = scored_file(options.source, options);
  if (!a) return a.error();
  auto b = scored_file(options.other, options);
  if (!b) return b.error();
  if (const Status same = report::comparable(*a, *b); !same) return same;
  print_comparison(*a, *b);
  if (options.out.empty()) return fine();
  report::ReportSettings settings;
  settings.most_pictures = options.pictures;
  settings.rubric = options.rubric;
  const auto report = report::comparison(*a, *b, settings, progress());
  if (!report) return report.error();
  return write_page(*report, options);
}

void add_common(CLI::App& command, Options& options) {
  command.add_option("--rubric", options.rubric,
                     "a built-in rubric, or a .toml file (default: that of the recording's case)");
  std::vector<std::string> codes;
  for (const Language& one : languages()) codes.push_back(one.code);
  command.add_option("--language", options.language, "of the page")
      ->check(CLI::IsMember(codes))
      ->capture_default_str();
  command
      .add_option(
          "--pictures", options.pictures,
          "most pictures: four sides, then evidence; 0: none, for a computer without OpenGL")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  command.add_option("--volume", options.volume.source,
                     "the volume it was made from (default: burr searches for it)");
  add_volume_options(command, options.volume);
}

void add_report(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand(
      "report", "one page on a recorded session: what was met, and what is next");
  auto options = std::make_shared<Options>();
  command->add_option("recording", options->source, "a recording (.mcap)")->required();
  command->add_option("--out", options->out, "F.html: the page")->required();
  command->add_option("--self", options->self,
                      "TOML: your own marks, made before you see those of the machine");
  command->add_option("--beside", options->beside,
                      "a recording of an expert on the same case, shown beside yours");
  add_common(*command, *options);
  command->callback([options, &todo] { todo.work = [options] { return run_report(*options); }; });
}

void add_compare(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("compare", "two recorded sessions on one case, side by side");
  auto options = std::make_shared<Options>();
  command->add_option("a", options->source, "a recording (.mcap)")->required();
  command->add_option("b", options->other, "another one")->required();
  command->add_option("--out", options->out, "F.html: a page with pictures and time lines");
  add_common(*command, *options);
  command->callback([options, &todo] { todo.work = [options] { return run_compare(*options); }; });
}

const Command report_command{68, add_report};
const Command compare_command{69, add_compare};

}  // namespace
}  // namespace burr::app
