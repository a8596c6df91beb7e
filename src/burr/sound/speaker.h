// sound/speaker.h - the computer's loudspeaker, by SDL: a thread of SDL asks the voice for samples.
//
//     auto speaker = Speaker::open();
//     if (!speaker) ...                 // no sound on this computer; everything else works
//     (*speaker)->voice().update(now);  // about sixty times a second
//
// Environment: SDL_AUDIODRIVER chooses SDL's driver; "dummy" plays nothing, "disk" writes to the
// file SDL_DISKAUDIOFILE, raw 32-bit floats at `rate_hz`.
// Thread: open and destroy on one; the rest as voice.h says. One channel; SDL converts it to the
// device's format. Errors: no device, one sentence.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/sound/voice.h"

namespace burr::sound {

struct SpeakerSettings {
  VoiceSettings voice;
  int samples = 512;  // per request of SDL: 11 ms of delay at 48 kHz; a power of two
};

class Speaker {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Speaker>> open(const SpeakerSettings& settings = {});
  ~Speaker();
  Speaker(const Speaker&) = delete;
  Speaker& operator=(const Speaker&) = delete;

  [[nodiscard]] Voice& voice() { return voice_; }
  [[nodiscard]] const std::string& driver() const { return driver_; }  // SDL's: "pulseaudio" ...
  // Samples that the device has taken so far; any thread.
  [[nodiscard]] std::uint64_t made() const { return made_.load(std::memory_order_acquire); }

 private:
  explicit Speaker(const SpeakerSettings& settings) : voice_(settings.voice) {}
  static void fill(void* speaker, std::uint8_t* bytes, int count);

  Voice voice_;
  std::atomic<std::uint64_t> made_ = 0;
  std::string driver_;
  std::uint32_t device_ = 0;  // 0: none open
};

}  // namespace burr::sound
