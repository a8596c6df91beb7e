// `burr case check`: is a case complete, and are the labels of its bone as it expects.
// `burr case new`: a commented case for a volume, with what is missing.
#include <fmt/core.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/phantom/phantoms.h"
#include "burr/report/scored.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "burr/scenario/open_lesson.h"
#include "burr/scoring/step_done.h"
#include "burr/workshop/case_session.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/other_bone.h"
#include "burr/workshop/prepare.h"
#include "commands/case_new.h"
#include "shared/bone_option.h"
#include "shared/counted.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

struct Options {
  std::string name;
  std::uint32_t bone = 0;
  std::vector<std::string> accepted;
  scenario::BoneRecipe volume;
  bool json = false;
};

void print(const workshop::LabelFinding& one) {
  const workshop::LabelFigures& f = one.figures;
  fmt::print("  {:<24} ", base::printable(one.structure));
  if (f.voxels == 0)
    fmt::print("not in this bone");
  else
    fmt::print("{} mm3, inscribed {:.2f} mm, {}, {:.1f} mm long ({})",
               workshop::figure(1e9 * f.volume, 4), 1e3 * f.inscribed,
               counted(static_cast<std::size_t>(f.pieces), "piece"), 1e3 * f.length,
               base::list_of(one.tissues));
  fmt::print("{}\n", one.faults.empty() ? "" : one.accepted ? "  ACCEPTED in spite of:" : "  BAD:");
  for (const std::string& fault : one.faults) fmt::print("    {}\n", fault);
}

nlohmann::json json_of(const workshop::LabelFinding& one) {
  return {{"structure", one.structure},
          {"tissues", one.tissues},
          {"volume_mm3", 1e9 * one.figures.volume},
          {"inscribed_mm", 1e3 * one.figures.inscribed},
          {"pieces", one.figures.pieces},
          {"length_mm", 1e3 * one.figures.length},
          {"faults", one.faults},
          {"accepted", one.accepted}};
}

Status run_check(const Options& options) {
  auto work = scenario::read_case(options.name);
  if (!work) return work.error();
  if (const Status taken = workshop::take_bone(*work, options.bone); !taken) return taken;
  if (const Status set = workshop::check_session(*work); !set) return set;
  const std::string file = work->name + ".toml";
  auto read = scenario::lesson_of(*work);
  if (!read) return read.error();
  const auto lesson = scenario::place(std::move(*read), workshop::landmarks_of(*work), file);
  if (!lesson) return lesson.error();
  if (Status fits = scoring::check_done(*lesson, file); !fits) return fits;
  if (Status fits = report::rubric_fits(*work); !fits) return fits;
  auto made = workshop::open_bone(workshop::recipe_of(*work, options.volume), progress());
  if (!made) return made.error();
  if (Status same = scenario::check_tissues(*work, made->bone->tissues()); !same) return same;
  const auto findings = workshop::check_labels(*lesson, *made->bone, options.accepted, progress());
  if (!findings) return findings.error();
  fmt::print("{}: {}\n", file, base::printable(work->title));
  if (options.bone > 0) {
    const std::string drawn = phantom::drawn_bone(work->phantom, options.bone);
    fmt::print("  bone {}: {}\n", options.bone, drawn.empty() ? "as usual" : drawn);
  }
  fmt::print("  format {}: {}, {}, {}, {}, {}\n", lesson->format,
             counted(lesson->structures.size(), "structure"),
             counted(lesson->regions.size(), "region"),
             counted(lesson->landmarks.size(), "landmark"), counted(lesson->steps.size(), "step"),
             counted(lesson->complications.size(), "complication"));
  if (lesson->structures.empty())
    fmt::print("  note: it names no [[structure]], so no label was judged\n");
  for (const workshop::LabelFinding& one : *findings) print(one);
  if (options.json) {
    nlohmann::json labels = nlohmann::json::array();
    for (const workshop::LabelFinding& one : *findings) labels.push_back(json_of(one));
    fmt::print("{}\n", json_line(nlohmann::json{{"case", work->name},
                                                {"format", lesson->format},
                                                {"steps", lesson->steps.size()},
                                                {"labels", labels}}));
  }
  return workshop::as_expected(*findings, file);  // the other faults have been printed
}

// ---- case new

struct NewOptions {
  scenario::BoneRecipe volume;
  std::string out;
  bool force = false;
};

// One line; empty: enter alone, or the end of the input.
std::string ask(const std::string& question) {
  fmt::print(stderr, "{} ", question);
  std::string line;
  std::getline(std::cin, line);
  return line;
}

CaseAnswers ask_all(const volume::TissueTable& table) {
  CaseAnswers answers;
  answers.title = ask("What is to be done, in one line?");
  for (std::size_t id = 1; id < table.tissues.size(); ++id)
    if (const std::string said = ask(fmt::format("Must \"{}\" stay uncut? y, or Enter for no:",
                                                 base::printable(table.tissues[id].name)));
        said == "y" || said == "Y")
      answers.spare.push_back(table.tissues[id].name);
  for (std::string said;
       !(said = ask("A landmark, NAME = X, Y, Z in mm (Enter: no more):")).empty();)
    if (is_landmark(said))
      answers.landmarks.push_back(said);
    else
      fmt::print(stderr, "This is not NAME = X, Y, Z; for example: entry = 12.5, -3, 40\n");
  for (std::string said; !(said = ask("The next step, one sentence (Enter: no more):")).empty();)
    answers.steps.push_back(said);
  return answers;
}

// As the case names it: the file from the folder of the case.
std::string source_for(const std::string& source, const std::string& out) {
  if (scenario::is_phantom(source)) return source;
  std::error_code nobody_asks;
  const std::filesystem::path folder = std::filesystem::absolute(out, nobody_asks).parent_path();
  const std::filesystem::path near = std::filesystem::proximate(
      std::filesystem::absolute(source, nobody_asks), folder, nobody_asks);
  return near.empty() ? source : near.string();
}

Status run_new(const NewOptions& options) {
  Status possible =
      check_outputs({options.volume.source}, {{"--out", options.out, {".toml"}}}, options.force);
  std::error_code nobody_asks;
  if (possible && !options.force && std::filesystem::exists(options.out, nobody_asks))
    possible = error(Trouble::usage, fmt::format("--out {}: this case exists; choose another name, "
                                                 "or replace it with --force",
                                                 options.out));
  if (!possible) return possible;
  auto made = workshop::open_bone(options.volume, progress());
  if (!made) return made.error();
  if (Status named = check_label_names(made->bone->tissues()); !named) return named;
  const bool asks = isatty(STDIN_FILENO) != 0;
  const CaseAnswers answers = asks ? ask_all(made->bone->tissues()) : CaseAnswers{};
  const NewCase written =
      new_case(*made->bone, source_for(options.volume.source, options.out), answers);
  // what is written must be a case
  if (const auto read = scenario::parse_case(written.text, options.out); !read) return read.error();
  auto file = base::NewFile::create(options.out, base::kForAll);
  if (!file) return file.error();
  file->write(written.text);
  if (Status placed = file->put_in_place(); !placed) return placed;
  fmt::print("{}: a case with {}\n", options.out,
             counted(made->bone->tissues().tissues.size() - 1, "structure"));
  for (const std::string& missing : written.missing) fmt::print("  missing: {}\n", missing);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command =
      app.add_subcommand("case", "begin a case, or check a case and the labels of its bone");
  command->require_subcommand(1);
  auto options = std::make_shared<Options>();
  auto* check = command->add_subcommand(
      "check", "read a case, open its bone, and compare its labels with what the case expects");
  check->add_option("case", options->name, "a built-in case, or a .toml file")->required();
  check->add_option("--accept-label", options->accepted,
                    "go on in spite of the faults of this structure's label; may be repeated");
  add_volume_options(*check, options->volume);
  add_bone_option(*check, options->bone);
  check->add_flag("--json", options->json, "print a JSON object as the last line");
  check->callback([options, &todo] { todo.work = [options] { return run_check(*options); }; });

  auto begin = std::make_shared<NewOptions>();
  auto* fresh = command->add_subcommand(
      "new",
      "write a commented case for a labelled volume; at a terminal burr asks for what is missing");
  fresh->add_option("volume", begin->volume.source, "file, DICOM folder or phantom:NAME")
      ->required();
  fresh->add_option("--out", begin->out, "the case, .toml")->required();
  add_force(*fresh, begin->force);
  add_volume_options(*fresh, begin->volume);
  fresh->callback([begin, &todo] { todo.work = [begin] { return run_new(*begin); }; });
}

const Command command{65, add};

}  // namespace
}  // namespace burr::app
