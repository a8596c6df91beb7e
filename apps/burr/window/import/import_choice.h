// apps/burr/window/import/import_choice.h - what is decided about a scan before it becomes bone, in the numbers
// of a recipe: its greys, its directions, the region, the kinds of its labels, the memory.
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

// How many voxels have which value.
struct Greys {
  double low = 0, high = 0;          // of all values
  double from = 0, to = 1;           // of the counts; rarer values beyond are in the outer ones
  std::vector<std::int64_t> counts;  // even steps
  std::int64_t most = 0;             // of one step

  [[nodiscard]] double share_from(double value) const;  // of the voxels at or above it, 0..1
  [[nodiscard]] double step() const;                    // that a level is worth setting by
};
[[nodiscard]] Greys greys_of(const io::Scan& scan, int steps = 256);

// Where a direction of the scan points in the patient, as seen by the patient; about: not exactly.
enum class Way { left, right, backwards, forwards, upwards, downwards };
struct Direction {
  Way way = Way::left;
  bool about = false;
};
[[nodiscard]] std::array<Direction, 3> directions(const math::Mat3& axes);

// The shortest text that is this number, as options take it.
[[nodiscard]] std::string number_text(double value);

// Voxels of a Scan, first and last, both inside.
struct Box {
  math::Ijk from = {0, 0, 0}, to = {0, 0, 0};
  bool operator==(const Box& other) const { return from == other.from && to == other.to; }
};
[[nodiscard]] Box whole(const io::Scan& scan);
// In voxels of the file; none: the whole scan.
[[nodiscard]] std::optional<scenario::Region> region_of(const io::Scan& scan, const Box& box);
// Error: not inside the scan.
[[nodiscard]] Result<Box> box_of(const io::Scan& scan,
                                 const std::optional<scenario::Region>& region);

// A table for --tissues that says of each label what kind it is, where that differs from what burr
// would take it for; "" where it nowhere does. Holds no name of a label.
[[nodiscard]] std::string table_of(const std::vector<importing::TissueFound>& taken_for,
                                   const std::vector<volume::TissueKind>& wanted);
// Kept in `folder` under a name made from its content, so that recordings find it again.
struct KeptTable {
  std::filesystem::path path;
  bool fresh = false;  // it was not there before
};
[[nodiscard]] Result<KeptTable> keep_table(const std::filesystem::path& folder,
                                           const std::string& table);

// Of the whole program beside what it takes with no bone.  [MB = 2^20 bytes]
struct SessionMemory {
  double making = 0;   // at its highest, the scan included
  double working = 0;  // from then on
};
// Estimated from how much bone and surface there is; good within a third of what a session in the
// window takes (tests/window).
[[nodiscard]] SessionMemory session_memory(const io::Scan& scan,
                                           const importing::ImportSummary& plan);
// What this computer still has to give, or this program may take.  [MB]
[[nodiscard]] double free_memory_mb();

struct Planned {
  importing::ImportSummary import;
  SessionMemory memory;
};
[[nodiscard]] Result<Planned> plan_session(const io::Scan& scan, const scenario::Recipe& recipe);

struct OpenedScan {
  scenario::Recipe volume;  // as asked for
  std::shared_ptr<const io::Scan> scan;
  Greys greys;                                 // of a grey scan
  std::vector<importing::TissueFound> labels;  // of a label map
  Result<Planned> planned;                     // with `volume`
};
// Error: it cannot be read, or is a picture and no volume.
[[nodiscard]] Result<OpenedScan> open_scan(const scenario::Recipe& recipe, Progress& progress);

}  // namespace burr::app
