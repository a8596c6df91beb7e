#include "window/mill/loudspeaker.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace burr::app {
namespace {

constexpr int kQuietest = -16;  // -48 dB
constexpr double kStep = 3;     // [dB]

}  // namespace

Loudspeaker::Loudspeaker(const tick::ServoSettings& settings,
                         workshop::SoundTracker::ToSpare to_spare, double warn_below,
                         const tool::ShapedTool* second)
    : hearing_(settings, std::move(to_spare), second), warn_below_(warn_below) {
  open();
}

void Loudspeaker::open() {
  speaker_.reset();
  auto opened = sound::Speaker::open();
  trouble_ = opened ? "" : opened.error().text + ", or switch sound off with --no-sound";
  if (!opened) return;
  speaker_ = std::move(*opened);
  speaker_->voice().loudness(loudness());
}

double Loudspeaker::loudness() const { return std::pow(10, kStep * steps_ / 20); }

void Loudspeaker::update(const tick::TickRow& newest, const tick::TickRow* second) {
  sound::SoundState now = hearing_.update(newest, second);
  now.injured = injured_;
  if (!injured_ && !(now.to_spare < warn_below_))
    now.to_spare = std::numeric_limits<double>::infinity();
  if (!speaker_) return;
  speaker_->voice().update(now);
  if (hearing_.second() != nullptr) speaker_->voice().update_second(*hearing_.second());
}

void Loudspeaker::toggle() {
  if (is_on())
    speaker_->voice().on(false);
  else
    open();
}

double Loudspeaker::louder(int steps) {
  steps_ = std::clamp(steps_ + steps, kQuietest, 0);
  if (speaker_) speaker_->voice().loudness(loudness());
  return kStep * steps_;
}

}  // namespace burr::app
