#include "burr/metrics/process.h"

#include <cstddef>
#include <utility>

namespace burr::metrics {

ProcessMaker::ProcessMaker(const volume::Grid& grid, double seconds,
                           const ProcessSettings& settings)
    : distances_(settings.critical),
      times_(settings.bone),
      nearness_(settings.critical),
      choice_(settings.choice),
      track_(seconds) {
  soft_.reserve(settings.soft.size());
  for (const SoftStructure& one : settings.soft) {
    soft_names_.push_back(one.name);
    soft_.emplace_back(grid, *one.voxels, *one.distance, one.worked, one.settings);
  }
  solid_.reserve(settings.solid.size());
  for (const SolidStructure& one : settings.solid) {
    solid_names_.push_back(one.name);
    solid_.emplace_back(*one.all, one.tissues, one.voxel);
  }
}

void ProcessMaker::add(const Moment& now) {
  distances_.update(now);
  times_.add(now);
  force_.add(now, distances_.least());
  nearness_.add(now, distances_);
  choice_.add(now, distances_.least());
  shaft_.add(now);
  dwell_.add(now);
  motor_.add(now);
  track_.add(now, distances_.least());
  for (IntactSoftMaker& one : soft_) one.add(now);
  for (SolidContactsMaker& one : solid_) one.add(now);
}

Process ProcessMaker::finish() {
  Process out;
  out.times = times_.finish();
  out.force = force_.finish(distances_);
  out.nearness = nearness_.finish(distances_);
  out.choice = choice_.finish(distances_);
  for (std::size_t n = 0; n < soft_.size(); ++n)
    out.soft.push_back({soft_names_[n], soft_[n].finish()});
  for (std::size_t n = 0; n < solid_.size(); ++n)
    out.solid.push_back({solid_names_[n], solid_[n].finish()});
  out.shaft = shaft_.finish();
  out.dwell = dwell_.finish();
  out.motor = motor_.finish();
  out.track = track_.finish();
  out.paths = paths_of(out.track);
  out.strokes = strokes_of(out.track);
  out.moves = moves_of(out.track);
  return out;
}

Result<Process> process_of(record::Player& player, const ProcessSettings& settings,
                           Progress& progress) {
  ProcessMaker maker(player.info().volume.grid, player.seconds(), settings);
  MomentReader reader(player);
  Moment now;
  while (reader.next(now)) {
    if (now.tick % 4096 == 0) {
      if (progress.cancelled()) return error(Trouble::interrupted, "stopped");
      progress.report(static_cast<double>(now.tick) / static_cast<double>(player.end_tick()),
                      "measuring what was done");
    }
    maker.add(now);
  }
  Process process = maker.finish();
  process.unusable = reader.account().unusable();
  process.lost_removed = reader.account().lost_removed();
  return process;
}

}  // namespace burr::metrics
