#include "commands/run_folder.h"

#include <fmt/core.h>

#include <numbers>
#include <system_error>
#include <vector>

#include "shared/outputs.h"
#include "window/mill/window.h"

namespace burr::app {

Status check_run_folder(const RunOptions& options, const std::filesystem::path& folder) {
  std::vector<Output> outputs;
  for (const char* name :
       {"before.png", "working.png", "after.png", "session.mcap", "summary.html"})
    outputs.push_back({"--out", (folder / name).string(), {}});
  return check_outputs(
      {options.work.volume.source, options.work.volume.labels, options.work.volume.materials},
      outputs, options.force || options.out.empty());
}

Status make_run_folder(const std::filesystem::path& folder) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (!trouble) return fine();
  return error(Trouble::io, fmt::format("{}: cannot make this folder ({}); choose another --out",
                                        folder.string(), trouble.message()));
}

Summary summary_of_run(sim::Session& session, const std::string& what, const std::string& hand) {
  const sim::Outcome outcome = session.outcome();
  const sim::SessionSettings& settings = session.settings();
  Summary summary;
  summary.what = what;
  summary.hand = hand;
  summary.size = session.bone().grid().size;
  summary.voxel = session.bone().grid().voxel;
  summary.burr_radius = session.burr_radius();
  summary.rpm = settings.servo.spindle_rad_s * 60 / (2 * std::numbers::pi);
  summary.seconds = outcome.seconds;
  summary.rate_hz = settings.servo.rate_hz;
  summary.ticks = outcome.ticks;
  summary.realtime = settings.realtime;
  summary.removed = outcome.ledger.removed;
  summary.asked = outcome.ledger.asked;
  summary.not_cut = outcome.ledger.not_cut;
  summary.added = outcome.ledger.added;
  summary.peak_force = outcome.peak_force;
  summary.mean_force = outcome.mean_force;
  summary.p50_us = outcome.timing.p50_us;
  summary.p99_us = outcome.timing.p99_us;
  summary.p999_us = outcome.timing.p999_us;
  summary.max_us = outcome.timing.max_us;
  summary.late = outcome.timing.late;
  summary.missed = outcome.timing.missed;
  summary.flags = flag_words(outcome.flags);
  summary.bone_hash = session.bone().content_hash();
  summary.tissues = losses(*session.bone_before(), session.bone());
  return summary;
}

}  // namespace burr::app
