// `burr info`: what a file contains, and what an import would do with it. No name, id, date or path
// of a patient.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "burr/base/printable.h"
#include "burr/io/sandbox/fence.h"
#include "burr/record/chain.h"
#include "burr/record/player.h"
#include "burr/report/piece_words.h"
#include "burr/sim/move_pieces.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "commands/session_lines.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"
#include "window/replay/playback.h"

namespace burr::app {
namespace {

struct Options {
  scenario::BoneRecipe volume;
  bool json = false;
};

const char* word(volume::TissueKind kind) {
  switch (kind) {
    case volume::TissueKind::air:
      return "air";
    case volume::TissueKind::soft:
      return "soft";
    case volume::TissueKind::solid:
      return "solid";
  }
  return "";
}

std::string vector_text(const math::Vec3& v) {
  return fmt::format("({:.5g}, {:.5g}, {:.5g})", v.x(), v.y(), v.z());
}

nlohmann::json array(const math::Vec3& v) { return {v.x(), v.y(), v.z()}; }
nlohmann::json array(const math::Ijk& v) { return {v.x(), v.y(), v.z()}; }

// "74 parts; the largest 98.2 %; 49 below 0.1 mm3 (--keep largest, --drop-islands-mm3 0.1)"
std::string parts_text(const importing::PartsFound& parts) {
  if (parts.count == 0) return "no bone";
  if (parts.count == 1) return "1 part";
  std::string text = fmt::format("{} parts; the largest {:.3g} %", parts.count,
                                 100 * parts.largest_mm3 / parts.mm3);
  if (parts.islands > 0)
    text += fmt::format("; {} below {:g} mm3", parts.islands, importing::kIslandMm3);
  return text + (parts.islands > 0 ? fmt::format(" (--keep largest, --drop-islands-mm3 {:g})",
                                                 importing::kIslandMm3)
                                   : " (--keep largest)");
}

void print(const importing::ImportSummary& s) {
  fmt::print("{}{}: {} x {} x {} voxels of {:.5g} x {:.5g} x {:.5g} mm, {}\n", s.format,
             s.modality.empty() ? "" : " (" + base::printable(s.modality, 16) + ")",
             s.scan_size.x(), s.scan_size.y(), s.scan_size.z(), s.spacing_mm.x(), s.spacing_mm.y(),
             s.spacing_mm.z(),
             s.labels       ? "labels"
             : s.hounsfield ? "Hounsfield units"
                            : "grey values");
  fmt::print("  first voxel at {} mm LPS; rows {}, columns {}, slices {}\n",
             vector_text(s.origin_mm), vector_text(s.axes.col(0)), vector_text(s.axes.col(1)),
             vector_text(s.axes.col(2)));
  if (!s.labels) fmt::print("  values {:.5g} to {:.5g}\n", s.low, s.high);
  if (s.size.isZero()) return;
  if (s.roi_size != s.scan_size)
    fmt::print("  cropped to {} x {} x {} voxels\n", s.roi_size.x(), s.roi_size.y(),
               s.roi_size.z());
  fmt::print("makes a bone of {} x {} x {} voxels of {:.5g} mm, about {:.0f} MB\n", s.size.x(),
             s.size.y(), s.size.z(), s.voxel_mm, s.memory_mb);
  if (!s.labels)
    fmt::print("  surface at {:.5g}{}{}; noise smoothed: {:.3g}\n", s.iso,
               s.hounsfield ? " HU" : "",
               s.iso_by_otsu ? " (Otsu)"
               : s.iso_estimated
                   ? fmt::format(" (an estimate; how sure: {})", importing::word_of(s.iso_sure))
                   : "",
               s.smooth);
  if (s.parts) fmt::print("  {}\n", parts_text(*s.parts));
  for (const importing::TissueFound& t : s.tissues) {
    fmt::print("  {:>3} {:<28} {:<5}{}", t.tissue.label, t.tissue.name, word(t.tissue.kind),
               t.tissue.spare ? " spare" : "");
    if (t.voxels > 0) fmt::print("  {:.1f} mm^3", t.volume_mm3);
    fmt::print("\n");
  }
}

nlohmann::json to_json(const importing::ImportSummary& s) {
  nlohmann::json out = {{"format", s.format},
                        {"modality", s.modality},
                        {"size", array(s.scan_size)},
                        {"spacing_mm", array(s.spacing_mm)},
                        {"origin_mm", array(s.origin_mm)},
                        {"axes",
                         {array(math::Vec3(s.axes.col(0))), array(math::Vec3(s.axes.col(1))),
                          array(math::Vec3(s.axes.col(2)))}},
                        {"labels", s.labels},
                        {"hounsfield", s.hounsfield},
                        {"notices", in_options(s.notices)}};
  if (!s.labels) {
    out["low"] = s.low;
    out["high"] = s.high;
  }
  if (s.size.isZero()) {
    out["bone"] = nullptr;
    return out;
  }
  nlohmann::json bone = {
      {"size", array(s.size)}, {"voxel_mm", s.voxel_mm}, {"memory_mb", s.memory_mb}};
  if (!s.labels) {
    bone["iso"] = s.iso;
    bone["iso_by_otsu"] = s.iso_by_otsu;
    bone["iso_estimated"] = s.iso_estimated;
    if (s.iso_estimated) {
      bone["iso_sure"] = importing::word_of(s.iso_sure);
      bone["iso_why"] = s.iso_why;
    }
    bone["smooth"] = s.smooth;
  }
  if (s.parts)
    bone["parts"] = {{"count", s.parts->count},
                     {"mm3", s.parts->mm3},
                     {"largest_mm3", s.parts->largest_mm3},
                     {"islands", s.parts->islands},
                     {"island_mm3", importing::kIslandMm3},
                     {"removed", s.parts->removed},
                     {"removed_mm3", s.parts->removed_mm3},
                     {"largest_removed_mm3", s.parts->largest_removed_mm3}};
  for (const importing::TissueFound& t : s.tissues) {
    nlohmann::json one = {{"label", t.tissue.label},
                          {"name", t.tissue.name},
                          {"kind", word(t.tissue.kind)},
                          {"spare", t.tissue.spare},
                          {"cutting_energy_J_mm3", t.tissue.cutting_energy * 1e-9}};
    if (t.voxels > 0) one["volume_mm3"] = t.volume_mm3;
    bone["tissues"].push_back(one);
  }
  out["bone"] = bone;
  return out;
}

// Adds how complete the fence around damaged files is on this computer (burr/io/sandbox/fence.h).
nlohmann::json with_fence(nlohmann::json out) {
  const io::FenceState fence = io::fence_state();
  out["fence"] = {{"process", !fence.reader.empty()},
                  {"memory_limit", fence.memory_limit},
                  {"landlock", fence.landlock},
                  {"seccomp", fence.seccomp}};
  return out;
}

// The content of the file and, if it can be milled, the plan of its import.
Result<importing::ImportSummary> look(const scenario::BoneRecipe& recipe) {
  if (scenario::is_phantom(recipe.source)) {
    auto made = workshop::open_bone(recipe, progress());
    if (!made) return made.error();
    return std::move(made->summary);
  }
  auto scan = io::read_scan(recipe.source, workshop::read_options(recipe), progress());
  if (!scan) return scan.error();
  auto plan = importing::plan_import(*scan, recipe);
  if (plan) {
    const Status counted = importing::count_parts(*scan, recipe, progress(), *plan);
    if (!counted) return counted.error();
  }
  if (plan || plan.error().trouble == Trouble::usage) return plan;
  // a file that can be read but not milled is still described
  importing::ImportSummary s;
  s.format = scan->format;
  s.modality = scan->modality;
  s.scan_size = s.roi_size = scan->size;
  s.spacing_mm = scan->spacing_mm;
  s.axes = scan->axes;
  s.origin_mm = scan->origin_mm;
  s.labels = scan->values.empty();
  s.hounsfield = scan->hounsfield;
  if (!s.labels) {
    const auto [low, high] = std::minmax_element(scan->values.begin(), scan->values.end());
    s.low = *low;
    s.high = *high;
  }
  s.notices = scan->notices;
  s.notices.push_back("This volume cannot be milled: " + in_options(plan.error()).text + ".");
  return s;
}

// Only where one was moved is the bone opened.
Result<std::vector<report::MovedPiece>> pieces_of(record::Player& player,
                                                  const scenario::BoneRecipe& volume,
                                                  const std::optional<scenario::Case>& work) {
  std::vector<report::MovedPiece> none;
  if (!sim::moves_pieces(player)) return none;
  scenario::BoneRecipe recipe = volume;
  recipe.source.clear();  // the recording itself was named
  auto bone = workshop::bone_of(player, recipe, progress());
  if (!bone) return bone.error();
  std::optional<scenario::CaseLesson> lesson;
  if (work) {
    auto placed = workshop::placed_lesson(*work);
    if (!placed) return placed.error();
    lesson = std::move(*placed);
  }
  auto moved = report::moved_pieces_of(player, **bone, lesson ? &*lesson : nullptr);
  if (!moved) return moved.error();
  return std::move(moved->pieces);
}

// A recording: how long, of which bone, and what was to be done.
Status run_recording(const Options& options) {
  auto opened = record::Player::open(options.volume.source);
  if (!opened) return opened.error();
  record::Player& player = **opened;
  const record::SessionInfo& info = player.info();
  const math::Ijk& size = info.volume.grid.size;
  fmt::print("recording by burr {}: {:.1f} s at {:g} Hz{}\n", base::printable(info.burr_version),
             player.seconds(), info.rate_hz,
             player.stopped()    ? ", stopped before its end"
             : player.finished() ? ""
                                 : ", cut off");
  fmt::print("  bone of {} x {} x {} voxels of {:.5g} mm, {}in the file\n", size.x(), size.y(),
             size.z(), 1e3 * info.volume.grid.voxel, info.embedded ? "" : "not ");
  const std::string phantom = scenario::phantom_name(info.volume.recipe.source);
  if (!phantom.empty()) fmt::print("  the bone is the phantom {}\n", base::printable(phantom));
  std::optional<scenario::Case> work_case;
  if (info.work_case) {
    auto read = record::case_of(info);
    if (!read) return read.error();
    work_case = std::move(*read);
    fmt::print("case {}: {}", base::printable(work_case->name), scenario::task_text(*work_case));
  }
  fmt::print("{}", session_text(player));
  const auto moved = pieces_of(player, options.volume, work_case);
  if (moved)
    for (const std::string& line : report::pieces_text(*moved)) fmt::print("  moved: {}\n", line);
  else  // the rest is known all the same
    fmt::print("  pieces were moved; how they lie is not known: {}\n",
               in_options(moved.error()).text);
  for (const std::string& notice : player.notices()) fmt::print("  note: {}\n", in_options(notice));
  // it is shown all the same, so that one can see what was changed
  const Status unchanged = record::check_chain(player, progress());
  if (!options.json) return unchanged;
  nlohmann::json out = {
      {"burr_version", info.burr_version},
      {"seconds", player.seconds()},
      {"rate_hz", info.rate_hz},
      {"finished", player.finished()},
      {"embedded", info.embedded},
      {"phantom", phantom.empty() ? nlohmann::json(nullptr) : nlohmann::json(phantom)},
      {"notices", in_options(player.notices())},
      {"unchanged", unchanged.ok()},
      {"case", nullptr}};
  out.update(session_json(player));
  out["pieces"] =
      moved ? nlohmann::json::parse(report::pieces_json(*moved)) : nlohmann::json(nullptr);
  if (work_case) {
    nlohmann::json targets = nlohmann::json::array();
    for (const scenario::Target& target : work_case->targets)
      targets.push_back({{"tissue", target.tissue},
                         {"goal", scenario::word_of(target.goal)},
                         {"share", target.share}});
    out["case"] = {{"name", work_case->name},
                   {"title", work_case->title},
                   {"text_hash", record::hex(info.work_case->text_hash)},
                   {"unchanged", info.work_case->unchanged()},
                   {"targets", targets},
                   {"spare", work_case->spare}};
  }
  fmt::print("{}\n", json_line(out));
  return unchanged;
}

Status run(const Options& options) {
  if (is_recording(options.volume.source)) return run_recording(options);
  auto found = look(options.volume);
  if (!found) return found.error();
  print(*found);
  for (const std::string& notice : found->notices) fmt::print("  note: {}\n", in_options(notice));
  if (options.json) fmt::print("{}\n", json_line(with_fence(to_json(*found))));
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand(
      "info", "show what a volume contains, and the bone burr would make from it");
  auto options = std::make_shared<Options>();
  command
      ->add_option("volume", options->volume.source,
                   "file, DICOM folder, phantom:NAME, or a recording (.mcap)")
      ->required();
  add_volume_options(*command, options->volume);
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{20, add};

}  // namespace
}  // namespace burr::app
