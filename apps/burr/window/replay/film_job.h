// apps/burr/window/replay/film_job.h - a recording as a film, made by a burr of its own beside the window:
// the same pictures as `burr replay --film`, and neither picture nor servo waits for them.
//
// Thread: any.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/sim/session.h"
#include "commands/picture_size.h"

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/recipe.h"

namespace burr::app {

struct FilmSource {
  std::string recording;    // may still be going on: the film goes as far as it is by now
  scenario::Recipe volume;  // the scan it was made from; empty path: it is found by the recording
  double seconds = 0;       // how long it is by now, to tell how far the film is
  bool effects = true;      // burr replay --effects
  double fps = 25;
  PictureSize size = {};
};

// Of a session that goes on and is recorded.
[[nodiscard]] FilmSource film_of(sim::Session& session, const std::string& recording,
                                 const scenario::Recipe& volume);

// Into a folder, which is made; an older film in it goes first. How many pictures. Error:
// Trouble::interrupted where progress was cancelled, and the pictures made until then are kept.
[[nodiscard]] Result<int> write_film(const FilmSource& source, const std::string& folder,
                                     Progress& progress);

// There is a film in this folder.
[[nodiscard]] bool holds_film(const std::string& folder);

}  // namespace burr::app
