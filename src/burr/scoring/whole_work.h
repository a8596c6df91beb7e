// scoring/whole_work.h - whether a bone is the work of its case at all: if not there is no mark, whatever the items say.
//
// Items are about parts. Most of a rubric can be met by doing one part well, or by cutting away what is in
// the way, or all. So a score has no points where
//
//     a part is not done       less than metrics::kLeastWork of a region that the reference of the case removes
//                              or fills
//     bone is gone elsewhere   what was removed farther than kBeside from all these regions is more than
//                              kMostElsewhere of the bone in them
//     bone is added elsewhere  the same of what was added, farther than that from the regions to fill
//
// What the reference leaves over a structure belongs to no part. A case without a reference has no such rule.
// Scripted surgeons, the careless ones too, have at most 0.3 % of the plan elsewhere. Thread: any.
#pragma once

#include <string>

namespace burr::scoring {

inline constexpr double kBeside = 2e-3;        // [m]
inline constexpr double kMostElsewhere = 0.1;  // of the bone in the plan

struct NoMark {
  enum class Why { none, part, gone, added };
  Why why = Why::none;
  std::string part;      // the region that was not done
  double share = 0;      // done of that part; or of the plan, what is gone or added elsewhere
  double elsewhere = 0;  // [m^3]

  [[nodiscard]] explicit operator bool() const { return why != Why::none; }
  bool operator==(const NoMark&) const = default;
};

// "of the part "second groove" 3 % is done, less than 20 %"; empty: there may be a mark.
[[nodiscard]] std::string text_of(const NoMark& none);

class Workpiece;
// Where the work was stopped (Workpiece::stopped) the answer does not count.
[[nodiscard]] NoMark why_no_mark(Workpiece& scene);

}  // namespace burr::scoring
