// render/headset.h - a headset by OpenXR: where head and wand are, and a picture for each eye.
//
//     auto headset = Headset::start(renderer, false);      // or one sentence why not
//     each frame:  if (auto now = headset->begin(0.02))    // does not wait longer
//                    headset->end(scene, cameras);         // always, once begun
//                  if (headset->over()) ...               // why(): one sentence
//
// OpenXR's loader is opened at run time (libopenxr_loader.so.1, or what BURR_OPENXR_LOADER names)
// and never linked. The runtime's own wait goes on in a thread of its own, so that a runtime that
// hangs holds nothing up. Frame: the room as OpenXR's LOCAL space has it, +y up, -z ahead of
// whoever put the headset on. Units: m. Thread: main, with the renderer, which outlives the
// headset. Errors: Trouble::io, with what to install or to switch on.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/math/pose.h"
#include "burr/render/camera.h"
#include "burr/render/renderer.h"

namespace burr::render {

// What a hand holds.
struct Wand {
  bool tracked = false;       // else the rest is old or nothing
  math::Pose room_from_wand;  // points along its -z; as the runtime says it, whatever that is
  double trigger = 0;         // 0..1
};

class Headset {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Headset>> start(Renderer& renderer, bool left_handed);
  ~Headset();
  Headset(const Headset&) = delete;
  Headset& operator=(const Headset&) = delete;

  struct Now {
    std::array<PlacedEye, 2> room_from_eye;  // left, right; in the room
    bool eyes = false;                       // the runtime knows where they are, and shows them
    Wand wand;
    double period = 0;  // of the headset's pictures  [s]
  };
  // What the runtime has to say; then a frame, if it wants one within wait_s.
  [[nodiscard]] std::optional<Now> begin(double wait_s);
  // Ends it: with the scene from these two cameras, or without a picture if there are no eyes.
  void end(const Scene& scene, const std::array<Camera, 2>& cameras);

  [[nodiscard]] bool running() const;  // it wants pictures
  [[nodiscard]] bool over() const;     // there will be no more
  [[nodiscard]] const std::string& why() const;
  [[nodiscard]] const std::string& name() const;  // of the runtime's system

 private:
  struct Work;
  explicit Headset(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

// An eye of the room as a camera in the world: what the middle camera looks at stands an arm's
// length (half a metre) before whoever wears the headset, as large as it is in the window then.
[[nodiscard]] Camera placed(const Camera& middle, const PlacedEye& room_from_eye);
[[nodiscard]] math::Pose placed(const Camera& middle, const math::Pose& in_room);

}  // namespace burr::render
