// scoring/show_regions.h - the regions that a page colours beside the marks. For use of this room only.
//
//     remove    what the case's reference removes; without one, the regions of `removed` items
//     keep      what lies within `leave` of a structure of the reference, and the regions of `kept`
//               items
//
// Thread: one at a time.
#pragma once

#include "burr/scoring/rubric.h"
#include "burr/scoring/shown.h"
#include "burr/scoring/workpiece.h"

namespace burr::scoring {

// Fills remove, keep and regions.
void show_regions(const Rubric& rubric, Workpiece& scene, Shown& shown);

}  // namespace burr::scoring
