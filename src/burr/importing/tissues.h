// importing/tissues.h - which labels are bone, which are soft, which are air: by name, or by a TOML table.
// Format of the table: docs/labels.md. What each is made of: importing/materials.h. Private to io.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/importing/materials.h"
#include "burr/io/scan.h"
#include "burr/volume/tissue.h"

namespace burr::importing {

// What the name alone says.
[[nodiscard]] volume::Tissue tissue_by_name(const io::Label& label, bool named,
                                            const Materials& materials = built_in_materials());

struct LabelTissues {
  volume::TissueTable table;                     // [0] air
  std::array<volume::TissueId, 256> of_label{};  // by value in the file
  std::vector<volume::Tissue> air;               // labels that are
  std::vector<std::string> notices;
};

// present: which values occur. table_path may be empty.
[[nodiscard]] Result<LabelTissues> label_tissues(const io::Scan& scan,
                                                 const std::array<bool, 256>& present,
                                                 const std::string& table_path,
                                                 const Materials& materials = built_in_materials());

// CT by HU class: trabecular bone in four steps, each as hard as the square of its density says;
// cortical bone all alike, because there CT numbers say little of stiffness (Rho et al. 1995);
// enamel. ids 1..4 trabecular, 5 cortical or dentine, 6 enamel or metal.
inline constexpr int kTrabecularClasses = 4;
inline constexpr double kTrabecularFromHu = 200, kTrabecularStepHu = 125, kCorticalHu = 700,
                        kEnamelHu = 2000;
[[nodiscard]] volume::TissueTable hu_tissues(const Materials& materials = built_in_materials());

// Of every voxel of a scan, so it is short. What lies below 200 HU and still in bone is of its
// softest kind.
[[nodiscard]] inline volume::TissueId hu_tissue(double hu) {
  if (hu >= kEnamelHu) return kTrabecularClasses + 2;
  if (hu >= kCorticalHu) return kTrabecularClasses + 1;
  int step = 0;
  while (step + 1 < kTrabecularClasses && hu >= kTrabecularFromHu + (step + 1) * kTrabecularStepHu)
    ++step;
  return static_cast<volume::TissueId>(1 + step);
}

}  // namespace burr::importing
