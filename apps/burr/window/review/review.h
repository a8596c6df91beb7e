// apps/burr/window/review/review.h - the end of a case in the window: the learner marks himself, then
// sees what the machine found, and may look at the evidence in the recording.
//
//     declared done --> own marks (into the recording) --> the recording is closed --> review()
//
// The marks are made on a thread of their own. Thread: main.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/record/diary.h"
#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "window/ui/closed.h"
#include "window/ui/desk.h"

namespace burr::app {

// True: there is a rubric for this case, so the work on it can be marked.
[[nodiscard]] bool has_marks(const scenario::Case& work);

// What ReviewOptions::rubric needs for this case; empty: there is none.
[[nodiscard]] std::string rubric_for(const scenario::Case& work);

// The learner's own marks become events of the recording, at this tick. false: the user closed the
// window. seconds: the page closes after this time; 0: never.
[[nodiscard]] Result<bool> ask_self_marks(Desk& desk, const scenario::Case& work,
                                          record::Diary& diary, std::uint64_t tick, double seconds);

// A moment of the recording that the learner wants to see.
struct ReviewMoment {
  scenario::BoneRecipe volume;      // where the bone is, if the recording does not find it
  double at = 0;                    // [s]
  std::optional<math::Vec3> place;  // of the evidence, world; none: it has no place
  math::Vec3 towards =
      math::Vec3::UnitZ();  // from there to the surgeon's eye; unit vector, with a place
  std::string note;         // shown beside it
};
// Shows it until the user leaves: Closed::page or Closed::window. trouble: why it cannot be shown, for
// the user. Error: as of review().
using ShowMoment = std::function<Result<Closed>(const ReviewMoment& moment, std::string& trouble)>;

struct ReviewOptions {
  std::string file;  // the recording, complete
  std::string title;
  std::string rubric = {};  // built in, or a .toml file; empty: the built-in one of the case
  scenario::BoneRecipe volume = {};  // where the bone is, if the recording does not find it
  bool marks = true;                 // may be shown (workshop/allowed.h)
  bool repeats = false;              // offers to do the case again
  double seconds = 0;                // closes after this time; 0: never
  std::string folder = {};           // for pictures of the replay
  std::string screenshot = {};       // PNG of the last picture; empty: none
  ShowMoment show = {};              // the page that plays recordings, which this one does not know
};

// Until the user leaves: Closed::page, Closed::again or Closed::window. The full report is written
// beside the recording, with the ending .html. options.show must be set.
[[nodiscard]] Result<Closed> review(Desk& desk, const ReviewOptions& options);

}  // namespace burr::app
