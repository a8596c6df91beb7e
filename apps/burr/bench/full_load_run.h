// apps/burr/bench/full_load_run.h - a session with everything at once: the servo by the clock, surface
// worker, off-screen renderer, recorder, and other programs; for measuring what a machine bears.
//
// Main thread: it owns the renderer. What cannot be had (no OpenGL, no room to record) is left out
// and named, so that the rest is still measured.
#pragma once

#include <string>
#include <vector>

#include "burr/record/recorder.h"
#include "burr/rt/stats.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "workshop/open_volume.h"
#include "workshop/recording.h"
#include "workshop/work_view.h"

namespace burr::app {

struct WholeOptions {
  double seconds = 10;  // wall
  bool picture = true;  // surface worker and off-screen renderer
  std::string record;   // F.mcap; empty: none
  PictureSize size = {960, 540};
  int busy = 0;                 // threads that do nothing but take processor time
  bool waiting_beside = false;  // a loop that only waits, at the same time
  double reset_first = 0;       // when the bone is put back, in the hand's time; 0: never  [s]
  double reset_every = 0;       // ... and then so often  [s]
  double memory_every = 10;     // a row of memory so often  [s]
};

// Memory in use at one moment.
struct MemoryRow {
  double s = 0;   // since the session began
  double mb = 0;  // resident
};

struct WholeOutcome {
  sim::Outcome session;
  rt::TickSummary waiting;  // of the loop beside, if requested
  record::RecordingAccount recorded;
  std::uint64_t frames = 0, patches = 0;
  int patches_waiting_most = 0;  // of the surface, not yet made
  double longest_frame_s = 0;    // between two pictures
  std::vector<MemoryRow> memory;
  std::vector<std::string> left_out;  // sentences
};

// Runs a session that is paced by the clock. `import` and `volume` describe its bone to the
// recording. Error: interrupted, or the recording could not be finished.
[[nodiscard]] Result<WholeOutcome> run_whole(sim::Session& session, const surgeon::WorkPlace& place,
                                             const scenario::Recipe& volume,
                                             const importing::ImportSummary& import,
                                             const WholeOptions& options, Progress& progress);

// A pocket of `each` seconds, lifted, and again from the start, until `seconds` are over; with a
// reset after each the same bone is cut each time. lifted: when the burr is first off the bone [s].
struct PocketsAgain {
  device::HandPath path;
  double lifted = 0;
  double every = 0;  // one round [s]
};
[[nodiscard]] Result<PocketsAgain> pockets_again(const surgeon::WorkPlace& place,
                                                 double burr_radius, double each, double seconds);

// Resident memory of this process [MB]; 0 where the system does not say.
[[nodiscard]] double resident_mb();

// How memory changed between the second fifth and the last fifth of the rows [MB]: what came before
// is the session settling in. 0 with fewer than five rows.
[[nodiscard]] double memory_grew_mb(const std::vector<MemoryRow>& rows);

}  // namespace burr::app
