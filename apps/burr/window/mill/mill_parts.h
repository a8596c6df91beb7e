// apps/burr/window/mill/mill_parts.h - the parts of the page for milling, in the order in which they
// know each other: a part knows only those above it.
//
// Thread: main.
#pragma once

#include "window/mill/mill_case.h"
#include "window/mill/mill_hand.h"
#include "window/mill/mill_names.h"
#include "window/mill/mill_side.h"
#include "window/mill/mill_site.h"
#include "window/mill/mill_tools.h"
#include "window/mill/mill_view.h"
#include "window/mill/piece_carrier.h"
#include "window/mill/pointer.h"
#include "window/mill/step_follower.h"
#include "window/mill/worn_headset.h"

namespace burr::app {

struct MillParts {
  explicit MillParts(const MillSite& site)
      : work_case(site.session.bone(), site.session.settings().servo.rate_hz, site.scene,
                  site.options, site.row, site.notes),
        headset(site.desk),
        pointer(site.desk, site.scene),
        view(site, work_case, pointer),
        names(site, work_case, pointer, view),
        side(site, work_case, view, names),
        tools(site, work_case, headset),
        pieces(site, pointer, tools),
        hand(site, pointer, headset, view, tools, pieces),
        follower(site, work_case, view, tools, hand) {}
  MillParts(const MillParts&) = delete;
  MillParts& operator=(const MillParts&) = delete;

  MillCase work_case;
  WornHeadset headset;
  Pointer pointer;
  MillView view;
  MillNames names;
  MillSide side;
  MillTools tools;
  PieceCarrier pieces;
  MillHand hand;
  StepFollower follower;
};

}  // namespace burr::app
