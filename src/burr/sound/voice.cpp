#include "burr/sound/voice.h"

#include <limits>

namespace burr::sound {

Voice::Voice(const VoiceSettings& settings)
    : synth_(settings.synth),
      silent_after_(settings.silent_after),
      since_update_(std::numeric_limits<double>::infinity()) {}

void Voice::make(std::span<float> samples) BURR_RT {
  SoundState now;
  if (door_.take(now)) {
    synth_.update(now);
    since_update_ = 0;
  }
  const bool heard = on_.load(std::memory_order_relaxed) && since_update_ <= silent_after_;
  synth_.loudness(heard ? loudness_.load(std::memory_order_relaxed) : 0);
  synth_.make(samples);
  since_update_ += static_cast<double>(samples.size()) / synth_.settings().rate_hz;
}

}  // namespace burr::sound
