// apps/burr/shared/window_session.h - prepared work becomes a session at the window: with its
// hand, its surface and the first view.
//
// Thread: any, one at a time; takes seconds and reports progress.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/renew.h"
#include "burr/mouse/mouse_hand.h"
#include "burr/render/scene.h"
#include "burr/scenario/lesson.h"
#include "burr/scenario/rack.h"
#include "burr/surface/worker.h"
#include "burr/workshop/allowed.h"
#include "burr/workshop/arm_publisher.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/spared_distance.h"
#include "burr/workshop/suction_hand.h"
#include "shared/left_session.h"
#include "shared/work.h"

namespace burr::app {

// Everything that a session in the window needs, with a hand: the mouse or a haptic device. Members
// are destroyed in reverse order of declaration; keep this order.
struct WindowSession {
  WindowSession() = default;
  WindowSession(WindowSession&&) noexcept = default;
  // Ends the old session as its destructor does. Member by member it would lose the bone while the
  // worker still reads it.
  WindowSession& operator=(WindowSession&& other) noexcept { return base::renew(*this, other); }
  ~WindowSession() = default;

  std::string title, what;  // title: one line; what: the bone; neither names a patient
  scenario::BoneRecipe volume;
  importing::ImportSummary import;
  std::unique_ptr<sim::Session> session;
  mouse::Hands hands;  // of the session
  std::unique_ptr<workshop::SuctionHand> suction;
  std::unique_ptr<device::crtk::Arm> arm;
  std::unique_ptr<workshop::ArmPublisher> teller;
  std::unique_ptr<surface::Worker> worker;
  render::Scene scene;                         // with its surface and first view
  std::shared_ptr<const volume::Greys> greys;  // of the scan
  workshop::Tissues spared;                    // that must not be cut
  std::optional<scenario::Case> work_case;     // the task
  std::optional<scenario::CaseLesson> lesson;  // of it, with its landmarks placed
  record::Mode mode = record::Mode::free;
  workshop::Allowed allowed;
  record::Identity identity;  // mode, learner and attempt
  Earlier earlier;
  LeftSession left;                      // by the session that this one continues
  std::vector<scenario::RackTool> rack;  // in the order of the session's list of tools
  std::unique_ptr<const workshop::SparedDistance> spared_distance;  // distances to `spared`
};
// Axes of a hand as the user sees the bone: x right, y up, z towards the user. Returns
// world_from_view.
[[nodiscard]] math::Quat view_of_hand(const render::Camera& camera);

// Call it after open_work(). Before that, the bone may be replaced by the one that an older session
// left.
[[nodiscard]] Result<WindowSession> make_window_session(const WorkOptions& options,
                                                        workshop::PreparedBone prepared,
                                                        Progress& progress);

}  // namespace burr::app
