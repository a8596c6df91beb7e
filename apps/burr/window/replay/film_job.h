// apps/burr/window/replay/film_job.h - makes a film of a recording in a process of its own, beside
// the window. The pictures are those of `burr replay --film`, and neither the window nor the servo
// waits for them.
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
  std::string recording;    // it may still grow: the film ends where it is now
  scenario::Recipe volume;  // of the scan; empty path: the recording finds it
  double seconds = 0;       // length so far, to report the progress of the film
  bool effects = true;      // burr replay --effects
  double fps = 25;
  PictureSize size = {};
};

// The source for a film of a running session that is recorded.
[[nodiscard]] FilmSource film_of(sim::Session& session, const std::string& recording,
                                 const scenario::Recipe& volume);

// Writes the film into a folder, which is made if needed; pictures of an older film in it are
// deleted first. Returns the number of pictures. Error: Trouble::interrupted if progress was
// cancelled; the pictures made so far are kept.
[[nodiscard]] Result<int> write_film(const FilmSource& source, const std::string& folder,
                                     Progress& progress);

// True: this folder contains a film.
[[nodiscard]] bool holds_film(const std::string& folder);

}  // namespace burr::app
