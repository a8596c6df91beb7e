// apps/burr/window/replay/playback.h - plays a recording: restores the bone at any moment, on a
// thread of its own, while the window goes on.
//
//     auto opened = open_recorded(file, state, progress);       // seconds: as a Loading wants it
//     Playback playback(*opened);
//     each frame:   playback.want(t);
//                   if (playback.take(shown)) ...               // what the bone is now
//                   if (playback.behind()) "..."
//
// Only the newest request is carried out: a user who drags along the time line does not wait for
// the moments in between. The thread is the only writer of the bone; the surface worker follows the
// changes as in milling. Thread: main, except where stated.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/renew.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/record/timeline.h"
#include "burr/render/scene.h"
#include "burr/sim/session_words.h"
#include "burr/surface/worker.h"
#include "burr/volume/bone.h"
#include "burr/workshop/out_piece.h"
#include "burr/workshop/traces.h"
#include "window/parts/film_job.h"

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/recipe.h"

namespace burr::app {

// Members are destroyed in reverse order of declaration; keep this order.
struct Recorded {
  Recorded() = default;
  Recorded(Recorded&&) noexcept = default;
  Recorded& operator=(Recorded&& other) noexcept { return base::renew(*this, other); }
  ~Recorded() = default;

  std::string title;  // one line, without the name of a patient
  std::unique_ptr<record::Player> player;
  sim::Recorded settings;
  record::Timeline timeline;
  std::vector<std::string> notices;  // sentences about what is missing
  std::unique_ptr<volume::Bone> bone;
  std::unique_ptr<surface::Worker> worker;
  FilmSource film;      // source for a film of it
  render::Scene scene;  // with the surface at the start, and a view of the work
};

// The name ends in ".mcap", in upper or lower case.
[[nodiscard]] bool is_recording(const std::string& path);

// state: folder of the kept sessions, which know where their scan is. given: the volume options of
// `burr replay`. Error: not a recording, an empty recording, or its bone cannot be found.
[[nodiscard]] Result<Recorded> open_recorded(const std::string& file,
                                             const std::filesystem::path& state,
                                             const scenario::BoneRecipe& given, Progress& progress);

class Playback {
 public:
  struct Shown {
    double t = 0;                         // the requested moment  [s]
    tick::TickRow row;                    // the last tick before that moment
    std::optional<tick::TickRow> second;  // of the other hand
    workshop::OutPiece piece;             // of bone that was out of the bone then
    std::string trouble;                  // "": the bone is as it was then; otherwise why not
    workshop::Traces::Changes changes;    // since the last take()
  };

  // `recorded` must outlive this object. Its player and bone are used by this object's thread.
  explicit Playback(Recorded& recorded);
  ~Playback();
  Playback(const Playback&) = delete;
  Playback& operator=(const Playback&) = delete;

  void want(double t_s);
  // Gets the newest result; false: there is nothing new.
  [[nodiscard]] bool take(Shown& shown);
  // Gets the last tick before the moment that is being restored, which is known long before its bone.
  // False: nothing new, or the tick cannot be read.
  struct Early {
    double t = -1;  // [s]
    tick::TickRow row;
  };
  [[nodiscard]] bool take_early(Early& early);
  // The last request is not done yet.
  [[nodiscard]] bool behind() const;

 private:
  void work();

  record::Player& player_;
  volume::Bone& bone_;
  workshop::Traces traces_;
  workshop::OutPieces pieces_;
  mutable std::mutex mutex_;
  std::condition_variable wanted_changed_;
  double wanted_ = 0;
  bool asked_ = false, working_ = false, fresh_ = false, end_ = false;
  Shown newest_;
  Early early_;
  bool early_fresh_ = false;
  std::jthread thread_;  // last: starts after the other members, ends before them
};

}  // namespace burr::app
