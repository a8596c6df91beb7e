// importing/tissues.h - decides which labels are bone, which are soft and which are air: by name,
// or by a TOML table (docs/use/labels.md). The constants of each: importing/materials.h. Internal
// to importing.
//
// Thread: any. Errors: what is wrong in the table, one sentence.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/importing/materials.h"
#include "burr/io/scan.h"
#include "burr/volume/tissue.h"

namespace burr::importing {

// The tissue that a label's name alone suggests.
[[nodiscard]] volume::Tissue tissue_by_name(const io::Label& label, bool named,
                                            const Materials& materials = built_in_materials());

struct LabelTissues {
  volume::TissueTable table;                     // [0] air
  std::array<volume::TissueId, 256> of_label{};  // by value in the file
  std::vector<volume::Tissue> air;               // labels that are air
  // by value in the file: solid, because neither a name nor a table says what it is
  std::array<bool, 256> assumed{};
  std::vector<std::string> notices;
};

// present: which values occur in the map. table_path: a table (docs/use/labels.md), or a list of
// ITK-SNAP or FreeSurfer that names the labels; may be empty.
[[nodiscard]] Result<LabelTissues> label_tissues(const io::Scan& scan,
                                                 const std::array<bool, 256>& present,
                                                 const std::string& table_path,
                                                 const Materials& materials = built_in_materials());

// Tissue classes of CT by HU. Trabecular bone has four classes, whose hardness goes with the square
// of their density; cortical bone is one class, because there CT numbers say little about stiffness
// (Rho et al. 1995); then enamel. Ids: 1..4 trabecular, 5 cortical or dentine, 6 enamel or metal.
inline constexpr int kTrabecularClasses = 4;
inline constexpr double kTrabecularFromHu = 200, kTrabecularStepHu = 125, kCorticalHu = 700,
                        kEnamelHu = 2000;
[[nodiscard]] volume::TissueTable hu_tissues(const Materials& materials = built_in_materials());

// Short, because it is called for every voxel of a scan. Bone below 200 HU is of the softest class.
[[nodiscard]] inline volume::TissueId hu_tissue(double hu) {
  if (hu >= kEnamelHu) return kTrabecularClasses + 2;
  if (hu >= kCorticalHu) return kTrabecularClasses + 1;
  int step = 0;
  while (step + 1 < kTrabecularClasses && hu >= kTrabecularFromHu + (step + 1) * kTrabecularStepHu)
    ++step;
  return static_cast<volume::TissueId>(1 + step);
}

}  // namespace burr::importing
