// What the page's sound thread calls (pages/mill/sound_worklet.js): rows of the ticks in, samples out. The
// synthesis is the window's own. A module of its own, since a sound thread can load nothing.
//
//     sound_open(48000, 1000), sound_loudness(0.3)
//     then: a tick::TickRow into sound_row(), sound_update(); sound_make(128) gives samples
//
// One thread. Pointers hold until the next call of the same function.
#include <emscripten.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "burr/sound/synth.h"
#include "burr/tick/rows.h"
#include "burr/tick/servo.h"
#include "burr/workshop/sound_tracker.h"
#include "burr/workshop/tool_places.h"
#include "burr/workshop/work_view.h"

// The page has the round burr alone; these are asked about other tools only. In place of
// workshop/tool_places.cpp and work_view.cpp, which know how to draw them.
namespace burr::workshop {
std::vector<math::Vec3> places_on(const tool::Tool& /*tool*/, std::size_t /*count*/) { return {}; }
math::Pose pose_of_tool(const tick::TickRow& /*row*/) { return {}; }
}  // namespace burr::workshop

namespace {

using namespace burr;

struct Sound {
  Sound(double rate_hz, const tick::ServoSettings& servo)
      : synth({.rate_hz = rate_hz}), tracker(servo) {}
  sound::Synth synth;
  workshop::SoundTracker tracker;
  tick::TickRow row;
  double to_spare = std::numeric_limits<double>::infinity();  // [m]
  bool injured = false;
  std::vector<float> samples;
};

std::unique_ptr<Sound> now;

}  // namespace

extern "C" {

// rate_hz: of the samples; ticks_hz: of the ticks.
EMSCRIPTEN_KEEPALIVE void sound_open(double rate_hz, double ticks_hz) {
  tick::ServoSettings servo;
  servo.rate_hz = ticks_hz;
  now = std::make_unique<Sound>(rate_hz, servo);
}
EMSCRIPTEN_KEEPALIVE void sound_loudness(double wanted) { now->synth.loudness(wanted); }
EMSCRIPTEN_KEEPALIVE void* sound_row() { return &now->row; }
EMSCRIPTEN_KEEPALIVE int sound_row_size() { return sizeof(tick::TickRow); }
// From the burr's surface to what must not be cut, where the warning may sound; infinity: it may not. injured: the burr
// is in it.
EMSCRIPTEN_KEEPALIVE void sound_near(double to_spare, int injured) {
  now->to_spare = to_spare;
  now->injured = injured != 0;
}
EMSCRIPTEN_KEEPALIVE void sound_update() {
  sound::SoundState state = now->tracker.update(now->row);
  state.to_spare = now->to_spare;
  state.injured = now->injured;
  now->synth.update(state);
}
EMSCRIPTEN_KEEPALIVE const float* sound_make(int count) {
  now->samples.resize(static_cast<std::size_t>(std::max(0, count)));
  now->synth.make(now->samples);
  return now->samples.data();
}

}  // extern "C"
