// apps/burr/window/replay/playback.h - a recording opened to be watched: its bone made what it was at any
// moment, on a thread of its own, while the window goes on.
//
//     auto opened = open_recorded(file, state, progress);       // seconds: as a Loading wants it
//     Playback playback(*opened);
//     each frame:   playback.want(t);
//                   if (playback.take(shown)) ...               // what the bone is now
//                   if (playback.behind()) "..."
//
// Only the newest request counts: who scrubs does not wait for the moments passed over. The thread is
// the bone's one writer; the surface worker looks on as it does while milling.
// Thread: main, except where said.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/record/timeline.h"
#include "burr/render/scene.h"
#include "burr/sim/session_words.h"
#include "burr/surface/worker.h"
#include "burr/volume/bone.h"
#include "burr/workshop/traces.h"
#include "window/replay/film_job.h"

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/recipe.h"

namespace burr::app {

// What is told last goes first.
struct Recorded {
  std::string title;  // one line that names no patient
  std::unique_ptr<record::Player> player;
  sim::Recorded settings;
  record::Timeline timeline;
  std::vector<std::string> notices;  // what is missing of it
  std::unique_ptr<volume::Bone> bone;
  std::unique_ptr<surface::Worker> worker;
  FilmSource film;      // of it
  render::Scene scene;  // with the surface at the start, and a view of the work
};

// ".mcap", in any case of letters.
[[nodiscard]] bool is_recording(const std::string& path);

// state: where sessions keep themselves; one of those knows where its scan lies. given: as typed
// for `burr replay`. Error: not a recording, nothing in it, or its bone is not to be found.
[[nodiscard]] Result<Recorded> open_recorded(const std::string& file,
                                             const std::filesystem::path& state,
                                             const scenario::Recipe& given, Progress& progress);

class Playback {
 public:
  struct Shown {
    double t = 0;                       // the moment that was wanted  [s]
    tick::TickRow row;                  // the last tick then
    std::string trouble;                // "": the bone is as it was then; else why not
    workshop::Traces::StatusLine told;  // since what was taken before
  };

  // It outlives the playback; its player and bone belong to the playback's thread.
  explicit Playback(Recorded& recorded);
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  void want(double t_s);
  // The newest; false: nothing new.
  [[nodiscard]] bool take(Shown& shown);
  // What was wanted last is not there yet.
  [[nodiscard]] bool behind() const;

 private:
  void work();

  record::Player& player_;
  volume::Bone& bone_;
  workshop::Traces traces_;
  mutable std::mutex mutex_;
  std::condition_variable wanted_changed_;
  double wanted_ = 0;
  bool asked_ = false, working_ = false, fresh_ = false, end_ = false;
  Shown newest_;
  std::jthread thread_;  // last: begins when all else is there, ends before it
};

}  // namespace burr::app
