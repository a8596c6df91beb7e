// edit/laws/thesis_law.h - removal as in the thesis: whatever is in the mill loses density with time.
//
// Eriksson 2006: no force, no spindle, no tissue decides how much. It is what the other laws are
// compared with (removal.h, chip_law.h).
//
// Thread: servo. Frame: p_grid [voxel]. Memory: none.
#pragma once

#include <cstdint>

#include "burr/edit/carve.h"
#include "burr/rt/rt.h"

namespace burr::edit {

// One tick: every voxel in the ball loses `amount` [field units], whatever volume that is. The
// removed volume is added to `asked`, too. Adds to `flags` (rt/flags.h: undo full, put off).
void lower(Carver& carver, const Cut& cut, double amount, std::uint32_t& flags) BURR_RT;

}  // namespace burr::edit
