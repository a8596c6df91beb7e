// apps/burr/bench/full_load_run.h - a session with full load: the servo in real time, surface
// worker, off-screen renderer, recorder, and other programs; to measure what a machine can do.
//
// Main thread, because it owns the renderer. What is not possible (no OpenGL, no space to record)
// is left out and named, so that the rest is still measured.
#pragma once

#include <string>
#include <vector>

#include "burr/importing/import.h"
#include "burr/record/recorder.h"
#include "burr/rt/stats.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "shared/picture_size.h"

namespace burr::app {

struct WholeOptions {
  double seconds = 10;  // wall time
  bool picture = true;  // surface worker and off-screen renderer
  std::string record;   // F.mcap; empty: none
  PictureSize size = {960, 540};
  int busy = 0;                 // number of threads that only use processor time
  bool waiting_beside = false;  // a loop that only waits, during the same time
  double reset_first = 0;       // when the bone is restored, in the hand's time; 0: never [s]
  double reset_every = 0;       // ... and then again after this time [s]
  double memory_every = 10;     // time between two rows of memory [s]
};

// Memory in use at one moment.
struct MemoryRow {
  double s = 0;   // since the session started
  double mb = 0;  // resident
};

struct WholeOutcome {
  sim::Outcome session;
  rt::TickSummary waiting;  // of the loop that only waits, if requested
  record::RecordingStats recorded;
  std::uint64_t frames = 0, patches = 0;
  int patches_waiting_most = 0;  // patches of the surface that were not made yet, largest number
  double longest_frame_s = 0;    // between two pictures
  std::vector<MemoryRow> memory;
  std::vector<std::string> left_out;  // sentences
};

// Runs a session in real time. `import` and `volume` describe its bone in the recording. Error:
// interrupted, or the recording could not be finished.
[[nodiscard]] Result<WholeOutcome> run_whole(sim::Session& session, const surgeon::WorkPlace& place,
                                             const scenario::BoneRecipe& volume,
                                             const importing::ImportSummary& import,
                                             const WholeOptions& options, Progress& progress);

// A path of pockets, `each` seconds long, with a lift between them, until `seconds` are over; if
// the bone is restored after each, every pocket cuts the same bone. lifted: when the burr is off
// the bone for the first time [s].
struct PocketsAgain {
  device::HandPath path;
  double lifted = 0;
  double every = 0;  // one round [s]
};
[[nodiscard]] Result<PocketsAgain> pockets_again(const surgeon::WorkPlace& place,
                                                 double burr_radius, double each, double seconds);

// Resident memory of this process [MB]; 0 where the system does not report it.
[[nodiscard]] double resident_mb();

// Change of memory from the second fifth to the last fifth of the rows [MB]; in the first fifth the
// session is still starting. 0 with fewer than five rows.
[[nodiscard]] double memory_grew_mb(const std::vector<MemoryRow>& rows);

}  // namespace burr::app
