// apps/burr/window/mill/window_options.h - what the page of the mill is opened with, and how it was left.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "burr/scenario/case.h"
#include "burr/volume/greys.h"
#include "burr/workshop/spared_distance.h"
#include "window/mill/loudspeaker.h"
#include "window/replay/film_job.h"

namespace burr::app {

struct WindowOptions {
  double seconds = 0;           // closes by itself after so long; 0: when the user closes it
  std::string folder = {};      // where P leaves pictures; empty: where the program was started
  std::string screenshot = {};  // a PNG of the window, panels and all, as it was last; empty: none
  bool sound = true;            // if there is a loudspeaker
  // asked often; what the user must be told, "" for nothing
  std::function<std::string()> warning = {};
  // the user wants this session kept for good; false: there is nothing to keep
  std::function<bool()> keep = {};
  // the session's recording as it is now, for a film; none: it is not recorded
  std::function<std::optional<FilmSource>()> film_of = {};
  const workshop::SparedDistance* spared_distance =
      nullptr;                                      // what must not be cut; nullptr: nothing
  Loudspeaker* loudspeaker = nullptr;               // nullptr: no sound
  std::shared_ptr<const volume::Greys> greys = {};  // of the scan; none: slices show the bone
  std::optional<scenario::Case> work_case = {};     // what is to be done; none: no case
};

// How the page was left.
enum class Left {
  page,    // the user is done with this bone
  window,  // ... with burr, or the time is over
};

}  // namespace burr::app
