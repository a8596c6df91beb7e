// scoring/shown.h - what a page shows beside the marks of a score. None of it decides a mark.
//
// Regions are functions of a point in the world (LPS, m). Thread: any. Memory: the distances that the
// regions keep, and 152 bytes per 10 ms of the session.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "burr/metrics/dwell.h"
#include "burr/metrics/economy.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/motor_load.h"
#include "burr/metrics/near.h"
#include "burr/metrics/reaction.h"
#include "burr/metrics/region.h"
#include "burr/metrics/shaft.h"
#include "burr/metrics/speed_near.h"
#include "burr/metrics/strokes.h"
#include "burr/metrics/track.h"
#include "burr/metrics/way.h"

namespace burr::scoring {

// Nearer than this a cutting burr is to be small: a rating-scale item, the numbers are defaults.
inline constexpr double kNearCut = 1e-3, kSmallBurr = 1.5e-3;  // distance, radius [m]

// A step that was declared done, for the first time.
struct DoneStep {
  double t = 0;            // [s]
  std::size_t number = 0;  // of the case's steps, from 1
  bool early = false;      // before another one that must come first
};

// Figures that a report shows beside the items. They earn points only where a rubric has an item for them.
struct Figures {
  metrics::Times times;
  metrics::Paths paths;
  metrics::Assessed<metrics::StrokeFigures> strokes = metrics::NotAssessable{"not measured"};
  metrics::Economy economy;
  metrics::Assessed<metrics::SpeedNear> speed = metrics::NotAssessable{"not measured"};
  metrics::Assessed<metrics::ShaftRest> shaft = metrics::NotAssessable{"not measured"};
  metrics::Assessed<metrics::Dwell> dwell = metrics::NotAssessable{"not measured"};
  metrics::Assessed<metrics::MotorLoad> motor = metrics::NotAssessable{"not measured"};
  metrics::Assessed<metrics::Reaction> reaction = metrics::NotAssessable{"not measured"};
};

struct Shown {
  metrics::Track track;  // the way of the burr at 100 Hz; empty without a recording
  std::vector<metrics::BurrStroke> strokes;
  std::vector<DoneStep> steps;                // in the order of time
  std::optional<Figures> figures;             // none: no recording
  std::vector<metrics::NearnessOf> nearness;  // of each structure that the steps spare
  // Of the case: bone that must go, and bone that must stay. Empty: the case does not say.
  metrics::Region remove, keep;
  std::map<std::string, metrics::Region, std::less<>> regions;  // those that the items name
};

}  // namespace burr::scoring
