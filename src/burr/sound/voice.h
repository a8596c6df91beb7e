// sound/voice.h - a synth behind a door: one thread sets what is to be heard, another, which must
// not wait, makes the samples.
//
// When nothing was set for a while - the program has stopped, or is busy - the sound fades, and
// comes back by itself. It begins silent.
// Guarantee: update(), update_second(), on(), loudness() and make() are wait-free and allocate no memory.
// Thread: update() and update_second() one; make() one other, that of the audio; on() and loudness() any.
#pragma once

#include <atomic>
#include <span>

#include "burr/rt/latest.h"
#include "burr/sound/sound_state.h"
#include "burr/sound/synth.h"

namespace burr::sound {

struct VoiceSettings {
  SynthSettings synth;
  double silent_after = 0.2;  // time without update() until it fades [s]
};

class Voice {
 public:
  explicit Voice(const VoiceSettings& settings = {});

  void update(const SoundState& now) BURR_RT { door_.publish(now); }
  // State of the tool in the second hand; its sound is added to that of the first tool. Before the
  // first call the second tool makes no sound.
  void update_second(const SoundState& now) BURR_RT { second_door_.publish(now); }
  void on(bool wanted) BURR_RT { on_.store(wanted, std::memory_order_relaxed); }
  [[nodiscard]] bool is_on() const BURR_RT { return on_.load(std::memory_order_relaxed); }
  void loudness(double wanted) BURR_RT { loudness_.store(wanted, std::memory_order_relaxed); }

  void make(std::span<float> samples) BURR_RT;

 private:
  Synth synth_;
  double silent_after_;
  double since_update_;  // time since the last update() [s]
  rt::Latest<SoundState> door_, second_door_;
  Synth second_;
  bool has_second_ = false;
  std::atomic<bool> on_ = true;
  std::atomic<double> loudness_ = 1;
};

}  // namespace burr::sound
