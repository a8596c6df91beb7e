// guidance/technique.h - when to say one sentence about the technique, and which.
//
// The sentence appears after 2 s of cutting with a tool that does not suit the step, or with too much
// force. It appears at most once in 20 s, and never while the burr is nearer than 1 mm to a structure to
// spare, where it could startle. The case gives the tool of the step; nobody has calibrated the force.
// Thread: any, one at a time. Units: SI; times are those of the session.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "burr/scenario/lesson.h"
#include "burr/tool/burr_tool.h"

namespace burr::guidance {

class Technique {
 public:
  enum class Cue { none, kind, larger, smaller, gentler };
  [[nodiscard]] static const char* name(Cue cue);         // for the recording
  static constexpr double kOutOfBand = 2, kBetween = 20;  // [s]
  static constexpr double kShown = 6;                     // [s]
  static constexpr double kQuietWithin = 1e-3;            // [m]
  static constexpr double kForce = 3;  // [N] default: nobody has compared it with people

  struct Moment {
    double t = 0;  // [s]
    bool cutting = false;
    double force = 0;                                          // [N]
    double nearest = std::numeric_limits<double>::infinity();  // to what must be spared [m]
    double diameter = 0;                                       // of the burr [m]
    tool::BurrKind kind = tool::BurrKind::cutting;
    std::string tool;  // of the rack; empty: the round burr
  };

  // step: the current one; nullptr: none. Returns what is to be read now; fresh() is true in the
  // first moment of it.
  Cue look(const Moment& moment, const scenario::Step* step);
  [[nodiscard]] bool fresh() const { return fresh_; }

 private:
  Cue out_ = Cue::none;        // the band that is left now
  double since_ = 0, at_ = 0;  // when it was left; the last moment of cutting
  Cue said_ = Cue::none;
  std::optional<double> said_at_;
  bool fresh_ = false;
};

}  // namespace burr::guidance
