// The computer itself: what the tick needs, what the picture needs, and gamepads and pedals.
#include <SDL2/SDL.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <system_error>

#include "burr/render/renderer.h"
#include "burr/rt/machine.h"
#include "burr/rt/machine_check.h"
#include "burr/rt/thread.h"
#include "doctor/doctor_checks.h"
#include "shared/front_words.h"

namespace burr::app {
namespace {

std::string from_environment(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

}  // namespace

std::vector<Finding> look_at_machine(const System& system) {
  rt::MachineMeasurements seen;
  seen.machine = rt::read_machine(system.root);
  {
    rt::Thread tried({.name = "doctor", .realtime = true}, [] {});
    seen.grant = tried.grant();
  }
  std::vector<Finding> findings;
  for (const rt::CheckLine& line : rt::judge(seen).lines)
    findings.push_back({"computer", line.what, line.change.empty() ? Health::good : Health::trouble,
                        line.value, line.change});
  return findings;
}

std::vector<Finding> look_at_screen(const System&) {
  std::vector<Finding> findings;
  Finding display{"screen and sound", "display", Health::good, "", ""};
  const std::string x = from_environment("DISPLAY"), wayland = from_environment("WAYLAND_DISPLAY");
  if (x.empty() && wayland.empty()) {
    display.health = Health::absent;
    display.value = "none: neither DISPLAY nor WAYLAND_DISPLAY is set";
    display.todo =
        "use the computer's own display, or ssh -X; without a display ./run mills by itself";
  } else {
    display.value = wayland.empty() ? "X11, " + x : "Wayland, " + wayland;
  }
  findings.push_back(std::move(display));

  Finding picture{"screen and sound", "OpenGL", Health::good, "", ""};
  const auto renderer = render::Renderer::offscreen();
  if (!renderer) {
    picture.health = Health::trouble;
    picture.value = in_options(renderer.error()).text;
    picture.todo = "apt install libgl1-mesa-dri libegl1, or the driver of your graphics card";
  } else {
    picture.value = (*renderer)->gpu();
    if ((*renderer)->software())
      picture.todo = "the processor draws; a graphics card with its driver draws faster";
  }
  findings.push_back(std::move(picture));

  Finding sound{"screen and sound", "loudspeaker", Health::good, "", ""};
  if (SDL_InitSubSystem(SDL_INIT_AUDIO) != 0) {
    sound.health = Health::absent;
    sound.value = fmt::format("none ({})", SDL_GetError());
    sound.todo = "burr runs without sound; check that pipewire or pulseaudio runs";
  } else {
    const int there = SDL_GetNumAudioDevices(0);
    sound.value =
        fmt::format("{}, {} output{}", SDL_GetCurrentAudioDriver(), there, there == 1 ? "" : "s");
    if (there == 0) {
      sound.health = Health::absent;
      sound.todo = "no loudspeaker is plugged in; burr runs without sound";
    }
    SDL_QuitSubSystem(SDL_INIT_AUDIO);
  }
  findings.push_back(std::move(sound));
  return findings;
}

std::vector<Finding> look_at_pads(const System& system) {
  std::vector<Finding> findings;
  Finding pads{"other hands", "gamepads, pedals", Health::good, "", ""};
  if (SDL_InitSubSystem(SDL_INIT_JOYSTICK) != 0) {
    pads.health = Health::trouble;
    pads.value = SDL_GetError();
    pads.todo = "check that you may read /dev/input (group input)";
  } else {
    for (int n = 0; n < SDL_NumJoysticks(); ++n) {
      const char* name = SDL_JoystickNameForIndex(n);
      pads.value +=
          (pads.value.empty() ? "" : ", ") + std::string(name != nullptr ? name : "without a name");
    }
    if (pads.value.empty()) {
      pads.health = Health::absent;
      pads.value = "none is plugged in";
    }
    SDL_QuitSubSystem(SDL_INIT_JOYSTICK);
  }
  findings.push_back(std::move(pads));

  Finding cap{"other hands", "SpaceMouse", Health::absent, "", ""};
  const std::string other = from_environment("BURR_SPNAV");
  void* library = dlopen(other.empty() ? "libspnav.so.0" : other.c_str(), RTLD_NOW | RTLD_LOCAL);
  const std::string named = from_environment("SPNAV_SOCKET");
  const std::filesystem::path socket =
      named.empty() ? system.root / "var/run/spnav.sock" : std::filesystem::path(named);
  std::error_code nobody_asks;
  if (library == nullptr) {
    cap.value = dlerror();
    cap.todo = "apt install libspnav0 spacenavd, if you have one";
  } else if (!std::filesystem::exists(socket, nobody_asks)) {
    cap.value = "libspnav is installed, its service does not run";
    cap.todo = "apt install spacenavd; systemctl start spacenavd";
  } else {
    cap.health = Health::good;
    cap.value = "libspnav is installed and its service runs";
  }
  if (library != nullptr) dlclose(library);
  findings.push_back(std::move(cap));
  findings.push_back({"other hands", "mouse", Health::good, "always", ""});
  return findings;
}

}  // namespace burr::app
