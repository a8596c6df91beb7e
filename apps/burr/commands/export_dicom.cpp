#include "commands/export_dicom.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <utility>

#include "burr/base/printable.h"
#include "burr/importing/import.h"
#include "burr/importing/label_codes.h"
#include "burr/io/read/read_scan.h"
#include "burr/workshop/open_bone.h"
#include "shared/counted.h"
#include "shared/front_words.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

// Whether the boxes around two grids of voxels share a point, seen along the axes of the first.
bool meet(const io::Scan& scan, const io::Scan& labels) {
  const math::Vec3 last = (labels.size - math::Ijk::Ones()).cast<double>();
  math::Vec3 low = math::Vec3::Constant(1e30), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const math::Vec3 at((corner & 1) != 0 ? last.x() : 0, (corner & 2) != 0 ? last.y() : 0,
                        (corner & 4) != 0 ? last.z() : 0);
    const math::Vec3 world = labels.origin_mm + labels.axes * labels.spacing_mm.cwiseProduct(at);
    const math::Vec3 there =
        (scan.axes.transpose() * (world - scan.origin_mm)).cwiseQuotient(scan.spacing_mm);
    low = low.cwiseMin(there);
    high = high.cwiseMax(there);
  }
  const math::Vec3 end = (scan.size - math::Ijk::Ones()).cast<double>();
  return (low.array() <= end.array() + 0.5).all() && (high.array() >= -0.5).all();
}

bool names_patient(const io::DicomStudy& study) {
  return std::any_of(study.values.begin(), study.values.end(), [](const auto& value) {
    return value.first >> 16 == 0x0010 && !value.second.empty();
  });
}

Result<std::optional<io::DicomStudy>> study_of(const DicomOptions& options,
                                               const scenario::BoneRecipe& recipe,
                                               const io::Scan* source, const io::Scan& labels,
                                               Progress& progress) {
  if (options.no_patient) return std::optional<io::DicomStudy>();
  if (options.study_of.empty())
    return source != nullptr ? source->study : std::optional<io::DicomStudy>();
  io::ReadOptions reading = workshop::read_options(recipe);
  reading.study = true;
  reading.spacing_mm = math::Vec3::Zero();
  const auto scan = io::read_scan(options.study_of, reading, progress);
  if (!scan) return scan.error();
  const std::string name = base::printable(options.study_of);
  if (!scan->study)
    return error(fmt::format(
        "--study-of {}: is {} and no DICOM, so it belongs to no study; give the DICOM scan that "
        "was segmented",
        name, scan->format));
  if (!meet(*scan, labels))
    return error(
        fmt::format("--study-of {}: the labels lie outside of this scan, so they do not belong to "
                    "it; give the scan that was segmented",
                    name));
  return scan->study;
}

}  // namespace

void add_dicom_options(CLI::App& command, DicomOptions& options) {
  command.add_option("--study-of", options.study_of,
                     "with .dcm: the DICOM scan that was segmented; its patient, study and frame "
                     "of reference go into the file (default: the source, if it is DICOM)");
  command.add_flag("--no-patient", options.no_patient,
                   "with .dcm: name no patient, and begin a new study");
  command.add_option("--uid-root", options.uid_root,
                     "with .dcm: root of new UIDs, if your centre has one (default: 2.25)");
  command
      .add_option("--segmented-by", options.by,
                  "with .dcm: how the labels came about (default: automatic for bone that burr "
                  "found by its grey level, otherwise semiautomatic)")
      ->check(CLI::IsMember({"automatic", "semiautomatic", "manual"}));
  command
      .add_option("--seg-kind", options.kind,
                  "with .dcm: binary, one bit a voxel for each segment (default), or labelmap, one "
                  "number a voxel (Label Map Segmentation, of 2024; fewer programs read it)")
      ->check(CLI::IsMember({"binary", "labelmap"}));
  command.add_option("--algorithm", options.algorithm,
                     "with .dcm: name of the method that made the labels (default: burr and its "
                     "version)");
}

bool is_dicom_path(const std::string& path) {
  constexpr std::string_view kEnding = ".dcm";
  return path.size() > kEnding.size() &&
         std::equal(kEnding.rbegin(), kEnding.rend(), path.rbegin(), [](char e, char p) {
           return e == std::tolower(static_cast<unsigned char>(p));
         });
}

Result<io::SegOptions> seg_options(const DicomOptions& options, const scenario::BoneRecipe& recipe,
                                   const io::Scan* source, const io::Scan& labels,
                                   Progress& progress) {
  io::SegOptions seg;
  seg.uid_root = options.uid_root;
  if (const auto root = io::new_uid(options.uid_root); !root) return root.error();
  seg.algorithm = options.algorithm;
  if (options.kind == "labelmap") seg.kind = io::SegKind::label_map;
  const bool by_level = source != nullptr && source->labels.empty();
  seg.by = options.by == "manual" ? io::SegmentedBy::manual
           : options.by == "automatic" || (options.by.empty() && by_level)
               ? io::SegmentedBy::automatic
               : io::SegmentedBy::semiautomatic;
  const auto codes = importing::label_codes(recipe.labels);
  if (!codes) return codes.error();
  seg.codes = importing::codes_of(*codes, labels.label_names);
  auto study = study_of(options, recipe, source, labels, progress);
  if (!study) return study.error();
  seg.study = std::move(*study);
  if (seg.study && names_patient(*seg.study))
    fmt::print(stderr,
               "The file names the patient as the scan does; --no-patient leaves that out.\n");
  return seg;
}

Result<io::Scan> own_labels(io::Scan scan, const scenario::BoneRecipe& recipe) {
  if (scan.labels.empty())
    return error(
        fmt::format("{}: is a grey scan, which has no labels; leave out --part labels to "
                    "write the bone that burr makes of it",
                    base::printable(recipe.source)));
  auto found = importing::labels_of(scan, recipe);
  if (!found) return found.error();
  std::vector<io::Label> names;
  for (const importing::TissueFound& one : *found) {
    io::Label label{
        .value = one.tissue.label, .name = one.tissue.name, .colour = one.tissue.colour};
    for (const io::Label& had : scan.label_names)
      if (had.value == label.value) label.in_file = had.in_file;
    names.push_back(std::move(label));
  }
  for (const io::Label& had : scan.label_names)  // those without a voxel, to be told
    if (std::none_of(names.begin(), names.end(),
                     [&](const io::Label& one) { return one.value == had.value; }))
      names.push_back(had);
  scan.label_names = std::move(names);
  return scan;
}

void tell_segments(const std::string& out, const std::vector<io::SegSegment>& segments,
                   const std::vector<std::string>& notices, double voxel_mm3, const char* part,
                   bool json) {
  print_notices(notices);
  if (json) {
    nlohmann::ordered_json row = {{"part", part}, {"segments", nlohmann::ordered_json::array()}};
    for (const io::SegSegment& one : segments)
      row["segments"].push_back({{"number", one.number},
                                 {"label", one.label},
                                 {"name", one.name},
                                 {"voxels", one.voxels},
                                 {"volume_mm3", voxel_mm3 * static_cast<double>(one.voxels)}});
    fmt::print("{}\n", json_line(row));
    return;
  }
  fmt::print("{}: {}\n", out, counted(segments.size(), "segment"));
  for (const io::SegSegment& one : segments)
    fmt::print("  {:3} {}: {:.1f} mm^3{}\n", one.number, base::printable(one.name),
               voxel_mm3 * static_cast<double>(one.voxels),
               one.number == one.label ? "" : fmt::format(" (label {})", one.label));
}

}  // namespace burr::app
