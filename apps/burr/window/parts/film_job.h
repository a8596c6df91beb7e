// apps/burr/window/parts/film_job.h - makes a film of a recording in a process of its own, beside
// the window. The pictures are those of `burr replay --film`, and neither the window nor the servo
// waits for them.
//
// Thread: any.
#pragma once

#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/recipe.h"
#include "burr/sim/session.h"
#include "shared/film_file.h"

namespace burr::app {

struct FilmSource {
  std::string recording;        // it may still grow: the film ends where it is now
  scenario::BoneRecipe volume;  // of the scan; empty path: the recording finds it
  FilmPlan plan;                // until: the length so far, or less
  bool effects = true;          // burr replay --effects
  bool as_seen = true;  // the recording says where its user looked, and the film looks there
};

// The source for a film of a running session that is recorded.
[[nodiscard]] FilmSource film_of(sim::Session& session, const std::string& recording,
                                 const scenario::BoneRecipe& volume);

// Writes the film into a file (.mp4) or a folder, which is made if needed; pictures of an older film
// in a folder are deleted first. source.plan.one_file does not matter: the path decides. Returns the
// number of pictures. Error: Trouble::interrupted if progress was cancelled; pictures made so far
// are kept, of a file nothing.
[[nodiscard]] Result<int> write_film(const FilmSource& source, const std::string& path,
                                     Progress& progress);

// True: this file is there, or this folder contains the pictures of a film.
[[nodiscard]] bool holds_film(const std::string& path);

}  // namespace burr::app
