// workshop/spared.h - the tissues that must not be cut. A case names them, the bone's table of
// tissues marks them, and a recording holds their numbers.
//
// Thread: any.
#pragma once

#include <string>
#include <vector>

#include "burr/record/session_info.h"
#include "burr/volume/tissue.h"

namespace burr::workshop {

using Tissues = std::vector<volume::TissueId>;

// The named tissues; if `named` is empty, those marked in the table. Names that the bone lacks are
// left out; scenario::check_tissues() reports them when a case is opened.
[[nodiscard]] Tissues to_spare(const volume::TissueTable& table,
                               const std::vector<std::string>& named);

// Writes them into a recording, and reads them. A recording without them: those marked in its
// table.
void write_spared(const Tissues& spared, record::SessionInfo& info);
[[nodiscard]] Tissues read_spared(const record::SessionInfo& info);

}  // namespace burr::workshop
