// `burr export`: the bone, or what was removed or added, as a mesh or a volume for other programs.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "burr/io/export_part.h"
#include "burr/io/read/read_scan.h"
#include "burr/io/write/write_dicom_seg.h"
#include "burr/record/chain.h"
#include "burr/record/player.h"
#include "burr/sim/move_pieces.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "commands/export_dataset.h"
#include "commands/export_dicom.h"
#include "commands/export_pieces.h"
#include "shared/front_words.h"
#include "shared/json_line.h"
#include "shared/outputs.h"
#include "shared/subcommand.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

struct Options {
  std::string source, out;
  scenario::BoneRecipe volume;  // path: --volume, of a recording
  double at_s = -1;             // moment in a recording; below 0: its end
  std::string part = "bone", frame = "lps";
  bool scan = false, largest = false;
  DatasetOptions dataset;
  bool json = false, force = false;
  DicomOptions dicom;

  [[nodiscard]] io::ExportOptions what() const {
    return {part == "removed" ? io::Part::removed
            : part == "added" ? io::Part::added
                              : io::Part::bone,
            frame == "ras"     ? io::Frame::ras
            : frame == "print" ? io::Frame::print
                               : io::Frame::lps,
            scan,
            largest,
            {}};
  }
};

struct Bones {
  std::unique_ptr<volume::Bone> before, now;  // now empty: the same as before
  std::optional<io::Scan> scan;               // of a volume, for a DICOM segmentation
  edit::PieceStore moved;                     // for --part pieces
};

// A copy with room for deposits.
std::unique_ptr<volume::Bone> copy_of(const volume::Bone& from, std::size_t reserve_bricks) {
  auto copy = std::make_unique<volume::Bone>(from.grid(), from.tissues(), from.used_slots(),
                                             reserve_bricks, from.has_intensity());
  for (volume::BrickIndex brick = 0; brick < from.brick_count(); ++brick) {
    if (from.brick_field(brick) == nullptr) continue;
    copy->build_brick(brick, from.brick_field(brick), from.brick_tissue(brick));
    if (from.has_intensity())
      std::copy_n(from.brick_intensity(brick), volume::kBrickVoxels, copy->build_intensity(brick));
  }
  copy->pack();
  return copy;
}

bool is_recording(const std::string& path) {
  return path.size() > 5 && path.compare(path.size() - 5, 5, ".mcap") == 0;
}

// A scan, with the study that it belongs to.
Result<io::Scan> read_with_study(const scenario::BoneRecipe& volume) {
  io::ReadOptions reading = workshop::read_options(volume);
  reading.study = true;
  return io::read_scan(volume.source, reading, progress());
}

// A volume as it was opened: nothing has been removed from it.
Result<Bones> open_plain(const Options& options) {
  if (options.part == "removed" || options.part == "added")
    return error(Trouble::usage,
                 "nothing has been removed from this volume, or added; give a recording (.mcap)");
  scenario::BoneRecipe volume = options.volume;
  volume.source = options.source;
  volume.reserve_bricks = 0;
  Bones bones;
  if (is_dicom_path(options.out) && !scenario::is_phantom(volume.source) &&
      !volume.source.ends_with(".bone")) {
    auto scan = read_with_study(volume);
    if (!scan) return scan.error();
    bones.scan = std::move(*scan);
  }
  auto opened = workshop::open_bone(volume, progress(), bones.scan ? &*bones.scan : nullptr);
  if (!opened) return opened.error();
  print_notices(opened->summary.notices);
  bones.before = std::move(opened->bone);
  return bones;
}

// The bone at the start of a recording, and its state at the wanted moment.
Result<Bones> open_recording(const Options& options) {
  auto player = record::Player::open(options.source);
  if (!player) return player.error();
  if (const Status whole = record::check_chain(**player, progress()); !whole) return whole.error();
  Bones bones;
  auto before = workshop::bone_of(**player, options.volume, progress());
  if (!before) return before.error();
  bones.before = std::move(*before);
  bones.now = copy_of(*bones.before, (*player)->info().volume.recipe.reserve_bricks);
  const double at_s = options.at_s < 0 ? (*player)->seconds() : options.at_s;
  const Status there = (*player)->bone_at(at_s, *bones.now);
  if (!there) return there.error();
  if (options.part == "pieces") {
    const auto scratch = copy_of(*bones.before, (*player)->info().volume.recipe.reserve_bricks);
    auto again = record::Player::open(options.source);  // it goes through the moments by itself
    if (!again) return again.error();
    auto moved = sim::moved_in(**again, *scratch, at_s);
    if (!moved) return moved.error();
    bones.moved = std::move(*moved);
  }
  print_notices((*player)->notices());
  return bones;
}

std::string count_text(std::size_t count, const char* one, const char* more) {
  return count == 1 ? fmt::format("1 {}", one) : fmt::format("{} {}", count, more);
}

// "  74 separate parts, 49 of them below 0.1 mm^3; 3 cavities inside them"
std::string parts_text(const surface::Shells& shells, bool largest) {
  std::string text = "  " + count_text(shells.parts, "part", "separate parts");
  if (shells.islands > 0)
    text += fmt::format(", {} of them below {:g} mm^3", shells.islands, surface::kIsland * 1e9);
  if (shells.cavities > 0)
    text += fmt::format("; {} inside", count_text(shells.cavities, "cavity", "cavities"));
  if (shells.parts > 1)
    text += largest ? "; only the largest part was written"
                    : "; --largest writes the largest part only";
  return text;
}

// Options that do not go together.
Status check_parts(const Options& options) {
  const bool dicom = is_dicom_path(options.out);
  if (!dicom && options.dicom.any())
    return error(Trouble::usage,
                 "--study-of, --no-patient, --uid-root, --segmented-by, --seg-kind and --algorithm "
                 "are for a "
                 "DICOM segmentation; give --out a name that ends in .dcm, or leave them out");
  if (options.part == "labels" && !dicom)
    return error(Trouble::usage,
                 "--part labels writes the labels of a file as DICOM; give --out a name that ends "
                 "in .dcm, or leave it out to write the bone");
  if (options.part == "labels" && is_recording(options.source))
    return error(Trouble::usage,
                 "--part labels: a recording holds bone; leave it out, or give the file of labels");
  if (options.part != "pieces") return fine();
  if (dicom)
    return error(Trouble::usage,
                 "--part pieces writes a file for each piece, and DICOM holds all segments in one; "
                 "use .seg.nrrd or a mesh, or --part bone");
  if (options.largest)
    return error(Trouble::usage,
                 "--largest and --part pieces contradict each other; the first file of --part "
                 "pieces is the largest piece");
  if (options.scan)
    return error(Trouble::usage,
                 "--scan: pieces have no grey values; leave it out, or use --part bone");
  return fine();
}

// The labels of a file on its own grid.
Status export_labels(const Options& options) {
  scenario::BoneRecipe volume = options.volume;
  volume.source = options.source;
  if (scenario::is_phantom(volume.source) || volume.source.ends_with(".bone"))
    return error(Trouble::usage,
                 "--part labels: a phantom is bone from the start; leave it out to write the bone");
  auto scan = read_with_study(volume);
  if (!scan) return scan.error();
  io::Scan source;  // as much as seg_options() asks for: a label map, and its study
  source.labels.assign(1, 0);
  source.study = scan->study;
  print_notices(scan->notices);
  auto labels = own_labels(std::move(*scan), volume);
  if (!labels) return labels.error();
  const auto dicom = seg_options(options.dicom, volume, &source, *labels, progress());
  if (!dicom) return dicom.error();
  const auto written = io::write_dicom_seg(*labels, options.out, *dicom, progress());
  if (!written) return written.error();
  tell_segments(options.out, written->segments, written->notices, labels->spacing_mm.prod(),
                "labels", options.json);
  return fine();
}

// Whose bone it is; of a recording, of the volume that the user names.
Result<io::SegOptions> dicom_of(const Options& options, const Bones& bones,
                                const volume::Bone& now) {
  std::optional<io::Scan> named;
  if (is_recording(options.source) && !options.volume.source.empty() &&
      options.dicom.study_of.empty() && !options.dicom.no_patient &&
      !scenario::is_phantom(options.volume.source)) {
    auto scan = read_with_study(options.volume);
    if (!scan) return scan.error();
    named = std::move(*scan);
  }
  return seg_options(options.dicom, options.volume,
                     bones.scan ? &*bones.scan
                     : named    ? &*named
                                : nullptr,
                     io::labels_of_bone(now), progress());
}

// What a data set is, and what the other parts are, do not mix.
Status check_dataset(const Options& options) {
  const std::string given = given_of(options.dataset);
  if (options.part != "dataset")
    return given.empty()
               ? fine()
               : error(Trouble::usage, given +
                                           ": is of --part dataset only; leave it out, or add "
                                           "--part dataset");
  if (!is_recording(options.source))
    return error(Trouble::usage, "--part dataset: give a recording (.mcap)");
  const char* const wrong = options.largest          ? "--largest"
                            : options.scan           ? "--scan"
                            : options.at_s >= 0      ? "--at"
                            : options.frame != "lps" ? "--frame"
                                                     : nullptr;
  if (wrong == nullptr) return fine();
  return error(Trouble::usage, fmt::format("{}: is of meshes and volumes; leave it out, because a "
                                           "data set holds the whole recording",
                                           wrong));
}

Status run(const Options& options) {
  Status asked = check_parts(options);
  if (asked) asked = check_dataset(options);
  if (!asked) return asked;
  if (options.part == "dataset")
    return export_dataset(options.source, options.volume, options.out, options.dataset,
                          options.json, progress());
  const Status possible = io::check_export(options.out, options.what());
  if (!possible) return possible;
  const Status allowed =
      check_outputs({options.source, options.volume.source, options.volume.labels,
                     options.volume.materials, options.dicom.study_of},
                    {{"--out",
                      options.out,
                      {".stl", ".ply", ".obj", ".3mf", ".glb", ".seg.nrrd", ".nrrd", ".dcm"}}},
                    options.force);
  if (!allowed) return allowed;
  if (options.part == "labels") return export_labels(options);
  auto bones = is_recording(options.source) ? open_recording(options) : open_plain(options);
  if (!bones) return bones.error();
  const volume::Bone& before = *bones->before;
  const volume::Bone& now = bones->now ? *bones->now : before;
  if (options.part == "pieces")
    return export_pieces(now, options.out, options.what(), options.force, options.json, progress(),
                         bones->moved);
  io::ExportOptions what = options.what();
  if (is_dicom_path(options.out)) {
    auto dicom = dicom_of(options, *bones, now);
    if (!dicom) return dicom.error();
    what.dicom = std::move(*dicom);
  }
  const auto exported = io::export_part(before, now, options.out, what, progress());
  if (!exported) return exported.error();
  if (is_dicom_path(options.out)) {
    tell_segments(options.out, exported->segments, exported->notices,
                  std::pow(1e3 * now.grid().voxel, 3), options.part.c_str(), options.json);
    return fine();
  }

  const double volume_mm3 = exported.value().volume * 1e9;
  const surface::Shells& shells = exported.value().shells;
  if (options.json) {
    nlohmann::ordered_json row;
    row["part"] = options.part;
    row["volume_mm3"] = volume_mm3;
    row["triangles"] = exported.value().triangles;
    if (exported.value().triangles > 0) {
      row["parts"] = shells.parts;
      row["islands"] = shells.islands;
      row["cavities"] = shells.cavities;
      row["largest_mm3"] = shells.largest * 1e9;
      row["crumbs"] = exported.value().crumbs.parts;
    }
    fmt::print("{}\n", json_line(row));
  } else if (exported.value().triangles > 0) {
    fmt::print("{}: {:.1f} mm^3 in {} triangles\n", options.out, volume_mm3,
               exported.value().triangles);
    fmt::print("{}\n", parts_text(shells, options.largest));
    if (const surface::LeftOut& crumbs = exported.value().crumbs; crumbs.parts > 0)
      fmt::print("  {} below one voxel {} left out ({:.2g} mm^3 in all)\n",
                 count_text(crumbs.parts, "crumb", "crumbs"), crumbs.parts == 1 ? "was" : "were",
                 crumbs.volume * 1e9);
  } else {
    fmt::print("{}: {:.1f} mm^3\n", options.out, volume_mm3);
  }
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command =
      app.add_subcommand("export", "write the bone, or the removed or added part, to a file");
  auto options = std::make_shared<Options>();
  command
      ->add_option("source", options->source,
                   "a recording (.mcap), or a volume (file, DICOM folder, phantom:NAME)")
      ->required();
  command
      ->add_option("--out", options->out,
                   "file to write; its ending decides the format: .stl .ply .obj .3mf .glb "
                   ".seg.nrrd .nrrd .dcm, or .hdf5 of --part dataset")
      ->required();
  command
      ->add_option("--part", options->part,
                   "what to write: bone, removed, added; labels: of a file, as they are; pieces: a "
                   "numbered file for each separate piece; dataset: the recording as HDF5 in the "
                   "layout of FIVRS")
      ->check(CLI::IsMember({"bone", "removed", "added", "labels", "pieces", "dataset"}))
      ->capture_default_str();
  command
      ->add_option("--frame", options->frame,
                   "axes of a mesh: lps as the scan, ras, or print (z up, on the bed, centred)")
      ->check(CLI::IsMember({"lps", "ras", "print"}))
      ->capture_default_str();
  command->add_flag("--scan", options->scan,
                    "with .nrrd: write the scan's grey values with the cut in them, not the field");
  command->add_flag("--largest", options->largest,
                    "of a mesh: write only the largest of its separate parts");
  command->add_option("--at", options->at_s, "moment of the recording [s]; default: its end")
      ->check(CLI::NonNegativeNumber);
  command->add_option(
      "--volume", options->volume.source,
      "for a recording: the volume it was made from (default: burr searches for it)");
  add_volume_options(*command, options->volume);
  add_dicom_options(*command, options->dicom);
  add_dataset_options(*command, options->dataset);
  add_force(*command, options->force);
  command->add_flag("--json", options->json, "one JSON object as the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{60, add};

}  // namespace
}  // namespace burr::app
