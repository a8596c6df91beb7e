// apps/burr/shared/work.h - what is milled, where and with what: a case or a scan as the user
// named it, made ready for a session. Shared by the window's pages and `burr run` without a
// display.
//
// Thread: any, one at a time; takes seconds and says how far it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/record/identity.h"
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/workshop/hand_device.h"
#include "burr/workshop/prepare.h"
#include "shared/law_choice.h"
#include "shared/tool_options.h"

namespace burr::app {

// What the sessions that this one continues did.
struct Earlier {
  double seconds = 0;
  double removed = 0;  // and not undone [m^3]
};

struct WorkOptions {
  scenario::BoneRecipe volume;  // source: also a case or a .toml file, until take_case()
  bool keep_greys = false;      // keep the values of a grey scan, for slices
  double burr_mm = 0, rpm = 0;  // 0: those of the case, or 5 mm and 40 000
  double seconds = 0;           // of the demonstration; 0: that of the case
  workshop::HandRequest hand;   // in the window
  std::string suction;          // in the window: a device for the other hand; empty: none
  std::string publish_as;       // in the window: name of the published CRTK arm; empty: none
  ToolOptions tool;             // of the rack
  LawChoice law;                // a custom law, for each session anew
  std::uint32_t bone = 0;       // another bone of the case (workshop/other_bone.h); 0: its own
  bool other_bones = false;     // each session draws the number, where the case has other bones
  haptics::Method touch = haptics::Method::constraint;
  record::Identity identity;  // mode, learner and attempt, for the recording
  // only from a case
  std::string title;                   // one line; empty for a scan
  std::optional<math::Vec3> at, into;  // where and how milling begins
  std::string motion = "pocket";
  tool::BurrKind kind = tool::BurrKind::cutting;
  std::vector<std::string> spare;  // tissues that must not be cut
  std::optional<scenario::Case> work_case;
  // only from a session that is continued
  tick::ToolMode mode = tick::ToolMode::cut;
  std::optional<bool> irrigated = {};
  Earlier earlier;
};

// If the source is a built-in case or a .toml file, fills the options from it: what is milled,
// where and with what. Options that the user gave have priority. Any other source is left as it is.
[[nodiscard]] Status take_case(WorkOptions& options);
// The same with a case that was read already.
void take_case(WorkOptions& options, const scenario::Case& work);

// True: a built-in case (a file of that name comes first), or a .toml file.
[[nodiscard]] bool names_a_case(const std::string& source);

// Call it before take_case(). True: not a built-in case, a phantom or a .toml file.
[[nodiscard]] bool names_a_scan(const WorkOptions& options);

// Call it after take_case(). Sets burr_mm of the options to the size that is used, with a notice if
// it differs (workshop/prepare.h). scan: as in workshop::open_bone(). Error: also if the case names
// a tissue that the bone does not have.
[[nodiscard]] Result<workshop::PreparedBone> open_work(WorkOptions& options, Progress& progress,
                                                       const io::Scan* scan = nullptr);

// Error: as take_tool(), and a law that cannot be opened, or is not fit for real time.
[[nodiscard]] Result<sim::SessionSettings> settings_of(const WorkOptions& options, bool realtime);

}  // namespace burr::app
