#include "burr/sound/speaker.h"

#include <SDL2/SDL.h>
#include <dlfcn.h>
#include <fmt/core.h>

#include <cmath>
#include <span>

namespace burr::sound {
namespace {

void says_nothing(const char*, int, const char*, int, const char*, ...) {}

// Where there is no sound card, ALSA's library prints eight lines to stderr; our own message is
// enough. SDL loads the library at run time, and so does this.
void quieten_alsa() {
  using SetHandler = int (*)(decltype(&says_nothing));
  void* alsa = dlopen("libasound.so.2", RTLD_NOW | RTLD_LOCAL);  // not closed: the handler belongs
                                                                 // to it
  if (alsa == nullptr) return;
  const auto set = reinterpret_cast<SetHandler>(dlsym(alsa, "snd_lib_error_set_handler"));
  if (set != nullptr) set(&says_nothing);
}

}  // namespace

Result<std::unique_ptr<Speaker>> Speaker::open(const SpeakerSettings& settings) {
  const auto none = [](const char* why) {
    return error(Trouble::io, fmt::format("no sound: {}; check the system's sound settings",
                                          *why != '\0' ? why : "no sound device was found"));
  };
  SDL_SetMainReady();
  SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // Ctrl-C is handled by the program
  SDL_SetHint(SDL_HINT_APP_NAME, "burr");
  quieten_alsa();
  if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) return none(SDL_GetError());

  std::unique_ptr<Speaker> speaker(new Speaker(settings));
  SDL_AudioSpec wanted = {};
  wanted.freq = static_cast<int>(std::lround(settings.voice.synth.rate_hz));
  wanted.format = AUDIO_F32SYS;
  wanted.channels = 1;
  wanted.samples = static_cast<Uint16>(settings.samples);
  wanted.callback = &Speaker::fill;
  wanted.userdata = speaker.get();
  speaker->device_ = SDL_OpenAudioDevice(nullptr, 0, &wanted, nullptr, 0);
  if (speaker->device_ == 0) {
    const Error problem = none(SDL_GetError());
    SDL_QuitSubSystem(SDL_INIT_AUDIO);
    return problem;
  }
  const char* driver = SDL_GetCurrentAudioDriver();
  speaker->driver_ = driver != nullptr ? driver : "";
  SDL_PauseAudioDevice(speaker->device_, 0);
  return speaker;
}

Speaker::~Speaker() {
  if (device_ == 0) return;
  SDL_CloseAudioDevice(device_);  // returns when fill() can no longer be called
  SDL_QuitSubSystem(SDL_INIT_AUDIO);
}

// Runs on SDL's thread.
void Speaker::fill(void* speaker, std::uint8_t* bytes, int count) {
  auto& self = *static_cast<Speaker*>(speaker);
  const std::span<float> samples(static_cast<float*>(static_cast<void*>(bytes)),
                                 static_cast<std::size_t>(count) / sizeof(float));
  self.voice_.make(samples);
  self.made_.fetch_add(samples.size(), std::memory_order_release);
}

}  // namespace burr::sound
