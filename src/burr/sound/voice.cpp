#include "burr/sound/voice.h"

#include <limits>

namespace burr::sound {

namespace {

// Two tools that hiss alike would sound like one that is louder.
SynthSettings other_noise(SynthSettings settings) {
  settings.seed += 1;
  return settings;
}

}  // namespace

Voice::Voice(const VoiceSettings& settings)
    : synth_(settings.synth),
      silent_after_(settings.silent_after),
      since_update_(std::numeric_limits<double>::infinity()),
      second_(other_noise(settings.synth)) {}

void Voice::make(std::span<float> samples) BURR_RT {
  SoundState now;
  if (door_.take(now)) {
    synth_.update(now);
    since_update_ = 0;
  }
  const bool heard = on_.load(std::memory_order_relaxed) && since_update_ <= silent_after_;
  if (second_door_.take(now)) {
    second_.update(now);
    has_second_ = true;
  }
  const double loud = heard ? loudness_.load(std::memory_order_relaxed) : 0;
  synth_.loudness(loud);
  synth_.make(samples);
  if (has_second_) {
    second_.loudness(loud);
    second_.mix(samples);
  }
  since_update_ += static_cast<double>(samples.size()) / synth_.settings().rate_hz;
}

}  // namespace burr::sound
