// scoring/shown.h - what a page shows beside the marks of a score. None of it decides a mark.
//
// Regions are functions of a point in the world (LPS, m). Thread: any. Memory: the distances that the
// regions keep, and 152 bytes per 10 ms of the session.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "burr/metrics/near.h"
#include "burr/metrics/region.h"
#include "burr/metrics/track.h"

namespace burr::scoring {

struct Shown {
  metrics::Track track;  // the way of the burr at 100 Hz; empty without a recording
  std::vector<metrics::NearnessOf> nearness;  // of each structure that the steps spare
  // Of the case: bone that must go, and bone that must stay. Empty: the case does not say.
  metrics::Region remove, keep;
  std::map<std::string, metrics::Region, std::less<>> regions;  // those that the items name
};

}  // namespace burr::scoring
