// apps/burr/commands/work.h - what is milled, where and with what: a case or a scan as the user
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
#include "burr/scenario/case.h"
#include "burr/sim/session.h"
#include "burr/workshop/hand_device.h"
#include "burr/workshop/prepare.h"

namespace burr::app {

struct WorkOptions {
  scenario::Recipe volume;      // source: also a case or a .toml file, until take_case()
  bool keep_greys = false;      // of a grey scan, for slices with its own values
  double burr_mm = 0, rpm = 0;  // 0: the case's, or 5 mm and 40 000
  double seconds = 0;           // of the demonstration; 0: the case's
  workshop::HandRequest hand;   // at the window
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

// After take_case(). burr_mm of the options becomes that of the burr that was taken, with a notice
// where it differs (workshop/prepare.h). scan: as workshop::open_bone() takes it. Error: also a
// tissue that the case names and the bone lacks.
[[nodiscard]] Result<workshop::Prepared> open_work(WorkOptions& options, Progress& progress,
                                                   const io::Scan* scan = nullptr);

[[nodiscard]] sim::SessionSettings settings_of(const WorkOptions& options, bool realtime);

}  // namespace burr::app
