// apps/burr/window/mill/make_ready.h - prepared work becomes a session at the window: with its
// hand, its surface and the first view.
//
// Thread: any, one at a time; takes seconds and reports how far it is.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/render/scene.h"
#include "burr/surface/worker.h"
#include "burr/workshop/arm_publisher.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/spared_distance.h"
#include "burr/workshop/suction_hand.h"
#include "commands/work.h"
#include "window/hands/mouse_hand.h"

namespace burr::app {

// Everything a session at the window needs, with the hand of the mouse or a haptic device. What is
// told last goes first.
struct Ready {
  std::string title, what;  // one line; what it is in our words: neither names a patient
  scenario::Recipe volume;
  importing::ImportSummary import;
  std::unique_ptr<sim::Session> session;
  Hands hands;  // the session's
  std::unique_ptr<workshop::SuctionHand> suction;
  std::unique_ptr<device::crtk::Arm> arm;
  std::unique_ptr<workshop::ArmPublisher> teller;
  std::unique_ptr<surface::Worker> worker;
  render::Scene scene;                         // with its surface and first view
  std::shared_ptr<const volume::Greys> greys;  // of a scan
  workshop::Tissues spared;                    // that must not be cut
  std::optional<scenario::Case> work_case;     // what is to be done
  std::unique_ptr<const workshop::SparedDistance> spared_distance;  // how far they are
};
// A hand's axes, x right, y up, z to the user, as one looks at the bone; world_from_view.
[[nodiscard]] math::Quat view_of_hand(const render::Camera& camera);

// After open_work(); its bone may be replaced before, by what an older session left.
[[nodiscard]] Result<Ready> make_ready(const WorkOptions& options, workshop::Prepared prepared,
                                       Progress& progress);

}  // namespace burr::app
