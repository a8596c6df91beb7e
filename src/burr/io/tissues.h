// io/tissues.h - which labels are bone, which are soft, which are air: by name, or by a TOML table.
// Format of the table: docs/labels.md. Private to io.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/io/scan.h"
#include "burr/volume/tissue.h"

namespace burr::io {

// What the name alone says.
[[nodiscard]] volume::Tissue tissue_by_name(const Label& label, bool named);

struct LabelTissues {
  volume::TissueTable table;                     // [0] air
  std::array<volume::TissueId, 256> of_label{};  // by value in the file
  std::vector<std::string> notices;
};

// present: which values occur. table_path may be empty.
[[nodiscard]] Result<LabelTissues> label_tissues(const Scan& scan,
                                                 const std::array<bool, 256>& present,
                                                 const std::string& table_path);

// CT by HU class (algorithms.md 3e): ids 1 trabecular, 2 cortical or dentine, 3 enamel.
[[nodiscard]] volume::TissueTable hu_tissues();
[[nodiscard]] volume::TissueId hu_tissue(float hu);

}  // namespace burr::io
