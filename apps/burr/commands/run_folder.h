// apps/burr/commands/run_folder.h - the folder of `burr run`: pictures, a recording and a page of figures.
//
// Thread: main. Errors: one sentence.
#pragma once

#include <filesystem>
#include <string>

#include "burr/base/result.h"
#include "burr/sim/session.h"
#include "commands/summary.h"
#include "shared/work.h"

namespace burr::app {

namespace run_folder {
inline constexpr int kWidth = 1280, kHeight = 720;  // size of the pictures
}  // namespace run_folder

struct RunOptions {
  WorkOptions work;
  std::string out, screenshot, store, live, live_token, station, cmi5;
  double seconds = 0;
  bool headless = false, no_sound = false, xr = false, force = false;
  bool mode_given = false;  // by the command line, whatever the user chose last
};

// Before the work: the files that the session writes. burr-out, which nobody named, is replaced.
[[nodiscard]] Status check_run_folder(const RunOptions& options,
                                      const std::filesystem::path& folder);
[[nodiscard]] Status make_run_folder(const std::filesystem::path& folder);

// The figures of a session that has ended. what: the bone; hand: who milled.
[[nodiscard]] Summary summary_of_run(sim::Session& session, const std::string& what,
                                     const std::string& hand);

}  // namespace burr::app
