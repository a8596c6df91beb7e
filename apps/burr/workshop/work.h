// apps/burr/workshop/work.h - what is milled, where and with what: a case or a scan as the user named it,
// made ready for a session. Shared by the window's pages and `burr run` without a display.
//
// Thread: any, one at a time; takes seconds and says how far it is.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/importing/import.h"
#include "burr/math/vec3.h"
#include "burr/render/scene.h"
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "burr/surgeon/motion.h"
#include "window/hands/mouse_hand.h"
#include "workshop/arm_publisher.h"
#include "workshop/hand_device.h"
#include "workshop/open_volume.h"
#include "workshop/spared_distance.h"
#include "workshop/suction_hand.h"

namespace burr::app {

struct WorkOptions {
  scenario::Recipe volume;      // source: also a case or a .toml file, until take_case()
  bool keep_greys = false;      // of a grey scan, for slices with its own values
  double burr_mm = 0, rpm = 0;  // 0: the case's, or 5 mm and 40 000
  double seconds = 0;           // of the demonstration; 0: the case's
  HandRequest hand;             // at the window
  std::string suction;          // likewise: a second device for the other hand; empty: none
  std::string told_as;          // likewise: a CRTK arm by which others may watch; empty: nobody may
  // what only a case says
  std::string title;                   // one line; empty for a scan
  std::optional<math::Vec3> at, into;  // where it begins
  std::string motion = "pocket";
  tool::BurrKind kind = tool::BurrKind::cutting;
  std::vector<std::string> spare;  // tissues that must not be cut
  std::optional<scenario::Case> work_case;
};

// A built-in case or a .toml file says what is milled, where and with what; options given by hand
// win. Anything else is left as it is.
[[nodiscard]] Status take_case(WorkOptions& options);
// The same with a case that was read already.
void take_case(WorkOptions& options, const scenario::Case& work);

// Before take_case(): neither a built-in case, nor a phantom, nor a .toml file.
[[nodiscard]] bool names_a_scan(const WorkOptions& options);

struct Work {
  importing::Imported made;
  std::string what;  // in our words
  scenario::Recipe volume;
  surgeon::WorkPlace place;
};
// After take_case(). scan: as open_volume() wants it. Error: also a tissue that the case names and
// the bone lacks.
[[nodiscard]] Result<Work> open_work(WorkOptions options, Progress& progress,
                                     const io::Scan* scan = nullptr);

// Where the burr has less than four voxels, which cannot be felt, and a usual one has them, that
// one is taken, and a notice says so.
void fit_burr(WorkOptions& options, importing::Imported& made);

[[nodiscard]] sim::SessionSettings settings_of(const WorkOptions& options, bool realtime);

// Everything a session at the window needs, with the hand of the mouse or a haptic device. What is
// told last goes first.
struct Ready {
  std::string title, what;  // one line; what it is in our words: neither names a patient
  scenario::Recipe volume;
  importing::ImportSummary import;
  std::unique_ptr<sim::Session> session;
  Hands hands;  // the session's
  std::unique_ptr<SuctionHand> suction;
  std::unique_ptr<device::crtk::Arm> arm;
  std::unique_ptr<ArmPublisher> teller;
  std::unique_ptr<surface::Worker> worker;
  render::Scene scene;                                    // with its surface and first view
  std::shared_ptr<const volume::Greys> greys;             // of a scan
  Tissues spared;                                         // that must not be cut
  std::optional<scenario::Case> work_case;                // what is to be done
  std::unique_ptr<const SparedDistance> spared_distance;  // how far they are
};
// A hand's axes, x right, y up, z to the user, as one looks at the bone; world_from_view.
[[nodiscard]] math::Quat view_of_hand(const render::Camera& camera);

// After open_work(); its bone may be replaced before, by what an older session left.
[[nodiscard]] Result<Ready> make_ready(WorkOptions options, Work work, Progress& progress);

}  // namespace burr::app
