// scoring/score.h - a piece of work against a rubric: what is met, what is not, and where to look.
//
//     auto score = scoring::score(rubric, lesson, *before, *after, player.get(), progress);
//
// A pure function: the same bones, recording and rubric give the same score, to the bit. That this holds
// on other instruction sets and with other numbers of threads is tested for the measures (metrics), of
// which it is made. It gives no grade and no pass. Thread: uses two of its own.
// Cost: seconds; memory: that of metrics/cover.h and the distances to the structures, which
// the regions of `shown` keep.
#pragma once

#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/record/player.h"
#include "burr/scenario/lesson.h"
#include "burr/scoring/outcome.h"
#include "burr/scoring/rubric.h"
#include "burr/scoring/shown.h"
#include "burr/scoring/whole_work.h"
#include "burr/volume/bone.h"

namespace burr::scoring {

// True: the two bones do not decide this item; it needs the recording.
[[nodiscard]] bool needs_recording(const Item& item);

struct Score {
  std::vector<Outcome> outcomes;  // one for each item of the rubric, in its order
  Total product, process;
  NoMark no_mark;          // why neither has points, where the work is not that of the case
  double worked = 0;       // share removed of what the case says to remove
  bool unfinished = true;  // the work was not declared done
  std::string ending;      // "declared done", "time up", "broke off", or why it is not known
  Shown shown;
};

// lesson: with its landmarks placed, and check(rubric, lesson) is fine. player: nullptr without a
// recording; the items that need one are then not assessable. Error: interrupted, bones of different
// grids, or ticks that cannot be read.
[[nodiscard]] Result<Score> score(const Rubric& rubric, const scenario::CaseLesson& lesson,
                                  const volume::Bone& before, const volume::Bone& after,
                                  record::Player* player, Progress& progress);

}  // namespace burr::scoring
