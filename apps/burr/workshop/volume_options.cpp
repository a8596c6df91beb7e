#include "workshop/volume_options.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <charconv>
#include <functional>
#include <utility>
#include <vector>

#include "burr/importing/materials.h"
#include "burr/phantom/phantoms.h"
#include "burr/volume/volume_of.h"
#include "workshop/prebuilt_phantom.h"

namespace burr::app {
namespace {

constexpr const char* kPhantom = "phantom:";

// "0.3,0.3,0.6"
bool numbers(const std::string& text, std::vector<double>& out) {
  for (std::size_t at = 0; at <= text.size();) {
    std::size_t end = text.find(',', at);
    if (end == std::string::npos) end = text.size();
    double value = 0;
    const auto result = std::from_chars(text.data() + at, text.data() + end, value);
    if (result.ec != std::errc() || result.ptr != text.data() + end) return false;
    out.push_back(value);
    at = end + 1;
  }
  return true;
}

Result<importing::Imported> open_phantom(const VolumeOptions& options, Progress& progress) {
  const std::string name = options.path.substr(std::string(kPhantom).size());
  if (!options.series.empty() || !options.spacing_mm.empty() || !options.roi.empty() ||
      !options.iso.empty() || !options.tissues.empty() || options.read_seconds != 0 ||
      options.read_memory_mb != 0)
    return error(Trouble::usage,
                 "a phantom is a formula: only --voxel-mm and --materials apply to it");
  std::function<void(volume::TissueTable&)> made_of;
  if (!options.materials.empty()) {
    auto materials = importing::read_materials(options.materials);
    if (!materials) return materials.error();
    made_of = [all = std::move(*materials)](volume::TissueTable& table) {
      for (std::size_t id = 1; id < table.tissues.size(); ++id) all.lay_over(table.tissues[id]);
    };
  }
  importing::Imported made;
  const bool usual = options.voxel_mm == 0 || options.voxel_mm == phantom::default_voxel_mm(name);
  if (usual && !made_of) made.bone = prebuilt_phantom(name, options.reserve_bricks);
  if (!made.bone) {
    auto bone =
        phantom::phantom(name, options.voxel_mm, progress, options.reserve_bricks, 2, made_of);
    if (!bone) return bone.error();
    made.bone = std::move(*bone);
  }
  importing::ImportSummary& s = made.summary;
  s.format = "formula";
  s.voxel_mm = made.bone->grid().voxel * 1e3;
  s.size = s.scan_size = s.roi_size = made.bone->grid().size;
  s.spacing_mm = math::Vec3::Constant(s.voxel_mm);
  s.axes = made.bone->grid().frame.q.toRotationMatrix();
  s.origin_mm = made.bone->grid().frame.p * 1e3;
  s.labels = true;
  const auto& table = made.bone->tissues().tissues;
  for (std::size_t id = 1; id < table.size(); ++id)
    s.tissues.push_back({static_cast<volume::TissueId>(id), table[id], 0, 0});
  s.solid_mm3 = volume::volume_of(*made.bone) * 1e9;
  return made;
}

}  // namespace

void add_volume_options(CLI::App& command, VolumeOptions& options) {
  command.add_option("--series", options.series,
                     "series of a DICOM folder: Series Instance UID, its beginning, or #2 as in "
                     "the list of burr info");
  command.add_option("--voxel-mm", options.voxel_mm,
                     "edge of the cubic voxels (default: the finest axis)");
  command.add_option("--spacing-mm", options.spacing_mm,
                     "X,Y,Z: replaces a wrong spacing in the file");
  command.add_option(
      "--iso", options.iso,
      "level of the bone surface, in HU or the file's unit (default: 300 HU, otherwise by Otsu)");
  command.add_option(
      "--roi", options.roi,
      "I0,I1,J0,J1,K0,K1: use only these voxels of the file (first and last, counted from 0)");
  command.add_option("--tissues", options.tissues,
                     "TOML table: which labels are solid, soft or air");
  command.add_option("--materials", options.materials,
                     "TOML table: constants of the materials (default: burr materials)");
  command.add_option(
      "--smooth", options.smooth,
      "noise to smooth, in HU or the file's unit; 0: no smoothing (default: as measured)");
  command.add_option("--memory-mb", options.memory_mb,
                     "memory budget of the import (default: 2048)");
  command.add_option("--read-seconds", options.read_seconds,
                     "limit of the processor time for reading (default: by the size of the files)");
  command.add_option("--read-memory-mb", options.read_memory_mb,
                     "limit of the memory for reading (default: by the size of the files)");
}

bool is_phantom(const std::string& path) { return path.rfind(kPhantom, 0) == 0; }

Result<io::ReadOptions> read_options(const VolumeOptions& options) {
  io::ReadOptions out;
  out.series = options.series;
  if (!(options.read_seconds >= 0) || !(options.read_memory_mb >= 0))
    return error(Trouble::usage, "--read-seconds and --read-memory-mb: must be numbers above 0");
  out.seconds = options.read_seconds;
  out.memory_mb = options.read_memory_mb;
  if (options.spacing_mm.empty()) return out;
  std::vector<double> spacing;
  if (!numbers(options.spacing_mm, spacing) || spacing.size() != 3 || !(spacing[0] > 0) ||
      !(spacing[1] > 0) || !(spacing[2] > 0) || spacing[0] > 100 || spacing[1] > 100 ||
      spacing[2] > 100)
    return error(Trouble::usage,
                 fmt::format("--spacing-mm: \"{}\" is not three numbers above 0, as in 0.3,0.3,0.6",
                             options.spacing_mm));
  out.spacing_mm = {spacing[0], spacing[1], spacing[2]};
  return out;
}

Result<importing::ImportOptions> import_options(const VolumeOptions& options) {
  importing::ImportOptions out;
  out.voxel_mm = options.voxel_mm;
  out.smooth = options.smooth;
  out.tissue_table = options.tissues;
  out.materials = options.materials;
  out.reserve_bricks = options.reserve_bricks;
  out.keep_greys = options.keep_greys;
  if (options.memory_mb != 0) {
    if (!(options.memory_mb >= 16))
      return error(Trouble::usage, "--memory-mb: must be at least 16 MB");
    out.memory_budget_mb = options.memory_mb;
  }
  if (!options.iso.empty()) {
    std::vector<double> iso;
    if (!numbers(options.iso, iso) || iso.size() != 1)
      return error(Trouble::usage, fmt::format("--iso: \"{}\" is not a number", options.iso));
    out.iso = iso[0];
  }
  if (!options.roi.empty()) {
    std::vector<double> roi;
    if (!numbers(options.roi, roi) || roi.size() != 6)
      return error(Trouble::usage,
                   fmt::format("--roi: \"{}\" is not six whole numbers, as in 10,200,0,99,5,80",
                               options.roi));
    std::array<int, 6> box{};
    for (std::size_t n = 0; n < 6; ++n) {
      if (!(roi[n] >= 0 && roi[n] < 1e6))
        return error(Trouble::usage, "--roi: voxels count from 0");
      box[n] = static_cast<int>(roi[n]);
    }
    out.roi = importing::Roi{{box[0], box[1]}, {box[2], box[3]}, {box[4], box[5]}};
  }
  return out;
}

Result<importing::Imported> open_volume(const VolumeOptions& options, Progress& progress,
                                        const io::Scan* scan) {
  if (is_phantom(options.path)) return open_phantom(options, progress);
  const auto reading = read_options(options);
  if (!reading) return reading.error();
  const auto importing = import_options(options);
  if (!importing) return importing.error();
  if (scan != nullptr) return importing::import_bone(*scan, *importing, progress);
  auto read = io::read_scan(options.path, *reading, progress);
  if (!read) return read.error();
  return importing::import_bone(*read, *importing, progress);
}

}  // namespace burr::app
