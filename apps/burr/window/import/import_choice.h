// apps/burr/window/import/import_choice.h - what the user decides about a scan before it becomes
// bone: grey level, directions, region, kinds of labels, memory; all as values of a recipe.
//
//     auto opened = open_scan(recipe, progress);             // reads it, once
//     recipe.region = region_of(*opened->scan, box);          // as the mouse pulled it
//     auto planned = plan_session(*opened->scan, recipe);    // what would be made of it
//
// Thread: any.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/importing/import.h"
#include "burr/io/scan.h"
#include "burr/scenario/recipe.h"

namespace burr::app {

// A histogram of the scan's values.
struct Greys {
  double low = 0, high = 0;          // range of all values
  double from = 0, to = 1;           // range of the steps; outer steps include values beyond
  std::vector<std::int64_t> counts;  // equal steps
  std::int64_t most = 0;             // largest count of one step

  [[nodiscard]] double share_from(double value) const;  // of the voxels at or above it, 0..1
  [[nodiscard]] double step() const;                    // a sensible step for changing a level
};
[[nodiscard]] Greys greys_of(const io::Scan& scan, int steps = 256);

// Direction in which an axis of the scan points in the patient, as the patient sees it. about: only
// approximately.
enum class PatientDirection { left, right, backwards, forwards, upwards, downwards };
struct Direction {
  PatientDirection way = PatientDirection::left;
  bool about = false;
};
[[nodiscard]] std::array<Direction, 3> directions(const math::Mat3& axes);

// The shortest text for this number that an option of the command line reads back as the same
// number.
[[nodiscard]] std::string number_text(double value);

// A box of voxels of a Scan; first and last are both inside.
struct Box {
  math::Ijk from = {0, 0, 0}, to = {0, 0, 0};
  bool operator==(const Box& other) const { return from == other.from && to == other.to; }
};
[[nodiscard]] Box whole(const io::Scan& scan);
// As voxels of the file; none: the box is the whole scan.
[[nodiscard]] std::optional<scenario::Region> region_of(const io::Scan& scan, const Box& box);
// Error: the region is not inside the scan.
[[nodiscard]] Result<Box> box_of(const io::Scan& scan,
                                 const std::optional<scenario::Region>& region);

// What the user says of a label.
struct LabelChoice {
  volume::TissueKind kind = volume::TissueKind::air;
  bool spare = false;    // must not be cut
  bool assumed = false;  // solid, because neither a name nor the user says what it is
  bool operator==(const LabelChoice&) const = default;
};
[[nodiscard]] std::vector<LabelChoice> choices_of(
    const std::vector<importing::TissueFound>& labels);
// A table for --tissues of the labels that differ from what burr would assume; "" if none differs.
// It contains no name of a label.
[[nodiscard]] std::string table_of(const std::vector<importing::TissueFound>& taken_for,
                                   const std::vector<LabelChoice>& wanted);
// Saves the table in `folder` under a name made from its content, so that recordings can find it
// again.
struct KeptTable {
  std::filesystem::path path;
  bool fresh = false;  // true: the file did not exist before
};
[[nodiscard]] Result<KeptTable> keep_table(const std::filesystem::path& folder,
                                           const std::string& table);

// Memory of the whole program above its use without a bone.  [MB = 2^20 bytes]
struct SessionMemory {
  double making = 0;   // maximum during import, including the scan
  double working = 0;  // after the import
};
// An estimate from the amount of bone and surface; within a third of what a session in the window
// uses (tests/window).
[[nodiscard]] SessionMemory session_memory(const io::Scan& scan,
                                           const importing::ImportSummary& plan);
// Memory that this computer still has free, or that this program may still use.  [MB]
[[nodiscard]] double free_memory_mb();

struct Planned {
  importing::ImportSummary import;
  SessionMemory memory;
};
[[nodiscard]] Result<Planned> plan_session(const io::Scan& scan,
                                           const scenario::BoneRecipe& recipe);

struct OpenedScan {
  scenario::BoneRecipe volume;  // as requested
  std::shared_ptr<const io::Scan> scan;
  Greys greys;                                 // for a grey scan
  std::vector<importing::TissueFound> labels;  // for a label map
  Result<Planned> planned;                     // with the recipe `volume`
};
// Error: the file cannot be read, or is a picture and not a volume.
[[nodiscard]] Result<OpenedScan> open_scan(const scenario::BoneRecipe& recipe, Progress& progress);

}  // namespace burr::app
