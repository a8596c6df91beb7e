// apps/burr/window/mill/window_options.h - the options of the page for milling.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/record/diary.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "burr/scenario/rack.h"
#include "burr/volume/greys.h"
#include "burr/workshop/allowed.h"
#include "burr/workshop/spared_distance.h"
#include "shared/left_session.h"
#include "shared/word_names.h"
#include "shared/work.h"
#include "window/mill/loudspeaker.h"
#include "window/parts/film_job.h"
#include "window/ui/closed.h"

namespace burr::app {

struct WindowOptions {
  std::string title = {};                     // of the work, on the window's frame; empty: burr
  Earlier earlier = {};                       // counted with this session's time and volume
  LeftSession left = {};                      // by the session that this one continues
  std::vector<scenario::RackTool> rack = {};  // in the order of the session's list of tools
  double seconds = 0;                         // closes after this time; 0: when the user closes it
  std::string folder = {};                    // for pictures of the key P; empty: the start folder
  std::string screenshot = {};                // PNG of the last picture with panels; empty: none
  bool sound = true;                          // if there is a sound device
  // called often; returns a warning for the user, "" for none
  std::function<std::string()> warning = {};
  // marks this session as one to keep; false: there is nothing to keep
  std::function<bool()> keep = {};
  // what becomes of the session when it is left; none: it is lost
  std::function<words::Word()> left_as = {};
  // source for a film of the session so far; none: it is not recorded
  std::function<std::optional<FilmSource>()> film_of = {};
  const workshop::SparedDistance* spared_distance =
      nullptr;                                      // to what must not be cut; nullptr: none
  Loudspeaker* loudspeaker = nullptr;               // nullptr: no sound
  std::shared_ptr<const volume::Greys> greys = {};  // of the scan; nullptr: slices show the bone
  std::optional<scenario::Case> work_case = {};     // the task; none: no case
  std::optional<scenario::CaseLesson> lesson = {};  // of the case, its landmarks placed
  record::Mode mode = record::Mode::free;           // what the session is for
  workshop::Allowed allowed =                       // and what it offers
      workshop::allowed_in(record::Mode::free, {}, true);
  // called while the page is left: the suction beside the burr is on
  std::function<void(bool)> suction_left = {};
  bool done_ends = false;          // to declare the work done ends the session; marks follow
  record::Diary* diary = nullptr;  // of the recording; nullptr: it is not recorded
};

}  // namespace burr::app
