// workshop/spared.h - the tissues that must not be cut: named by a case, or marked in the bone's table;
// by number in a recording.
//
// Thread: any.
#pragma once

#include <string>
#include <vector>

#include "burr/record/session_info.h"
#include "burr/volume/tissue.h"

namespace burr::workshop {

using Tissues = std::vector<volume::TissueId>;

// What a case names, or, where nothing is named, what the table marks. Names that the bone does not
// have are left out: whoever opens a case checks them before (scenario::check_tissues()).
[[nodiscard]] Tissues to_spare(const volume::TissueTable& table,
                               const std::vector<std::string>& named);

// The same into a recording and out of it; one without the word: what its table marks.
void write_spared(const Tissues& spared, record::SessionInfo& info);
[[nodiscard]] Tissues read_spared(const record::SessionInfo& info);

}  // namespace burr::workshop
