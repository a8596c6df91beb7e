#include "burr/guidance/technique.h"

namespace burr::guidance {
namespace {

constexpr double kPause = 0.5;     // a shorter lift does not end a cut [s]
constexpr double kSame = 0.05e-3;  // of a diameter [m]

Technique::Cue left_band(const Technique::Moment& now, const scenario::Step* step) {
  using Cue = Technique::Cue;
  if (now.force > Technique::kForce) return Cue::gentler;
  if (step == nullptr) return Cue::none;
  if (now.tool != step->tool && (!step->tool.empty() || step->kind || step->diameter))
    return Cue::kind;
  if (!step->tool.empty()) return Cue::none;
  if (step->kind && *step->kind != now.kind) return Cue::kind;
  if (step->diameter && now.diameter < step->diameter->first - kSame) return Cue::larger;
  if (step->diameter && now.diameter > step->diameter->second + kSame) return Cue::smaller;
  return Cue::none;
}

}  // namespace

const char* Technique::name(Cue cue) {
  switch (cue) {
    case Cue::none:
      break;
    case Cue::kind:
      return "kind of burr";
    case Cue::larger:
      return "larger burr";
    case Cue::smaller:
      return "smaller burr";
    case Cue::gentler:
      return "less force";
  }
  return "none";
}

Technique::Cue Technique::look(const Moment& now, const scenario::Step* step) {
  fresh_ = false;
  if (now.cutting) {
    const Cue left = left_band(now, step);
    if (left != out_ || now.t - at_ > kPause) since_ = now.t;
    out_ = left;
    at_ = now.t;
  }
  // near a structure nothing appears; what is there goes away
  if (now.nearest < kQuietWithin) {
    said_ = Cue::none;
    return said_;
  }
  if (said_at_ && now.t - *said_at_ > kShown) said_ = Cue::none;
  if (now.cutting && out_ != Cue::none && now.t - since_ >= kOutOfBand &&
      (!said_at_ || now.t - *said_at_ >= kBetween)) {
    said_ = out_;
    said_at_ = now.t;
    fresh_ = true;
  }
  return said_;
}

}  // namespace burr::guidance
