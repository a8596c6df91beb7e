// school/study/interval.h - the two ends of an interval, in the unit of what was estimated.
#pragma once

namespace burr::school::study {

struct Interval {
  double low = 0, high = 0;
};

}  // namespace burr::school::study
