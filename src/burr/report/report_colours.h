// report/report_colours.h - the colours of the pictures of a report. For use of this folder only.
//
// Thread: any.
#pragma once

#include "burr/render/look.h"

namespace burr::report {

// Okabe and Ito's, which colour-blind people can tell apart; violet is darker than both others.
inline constexpr render::Colour kGoodColour = {0.00F, 0.62F, 0.45F},
                                kLeftColour = {0.58F, 0.36F, 0.70F},
                                kBareColour = {0.84F, 0.37F, 0.00F},
                                kCutColour = {0.97F, 0.93F, 0.80F};

}  // namespace burr::report
