// render/headset.h - a headset through OpenXR: pose of head and wand, and a picture for each eye.
//
//     auto headset = Headset::start(renderer, false);      // or one sentence why not
//     each frame:  if (auto now = headset->begin(0.02))      // waits no longer than that
//                    headset->end(scene, cameras);         // always, once begun
//                  if (headset->over()) ...               // why(): one sentence
//
// OpenXR's loader is opened at run time (libopenxr_loader.so.1, or the one in BURR_OPENXR_LOADER)
// and never linked. The runtime's own wait runs on a separate thread, so that a runtime that hangs
// stops nothing else. Frame: the room in OpenXR's LOCAL space, +y up, -z ahead of the person when
// the headset was put on. Units: m. Thread: main, with the renderer, which must outlive the
// headset.
// Errors: Trouble::io, with what to install or to switch on.
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

// The controller in a hand, or a pen (Logitech MX Ink).
struct Wand {
  bool tracked = false;       // false: the other members are old or empty
  math::Pose room_from_wand;  // points along its -z; as the runtime reports it
  double trigger = 0;         // 0..1; of a pen: how hard its middle button is squeezed
};

// How strongly the controller vibrates for a contact force [N]: 0..kMostVibration. Nothing below what a hand
// would notice, and no more above kFullForce. What is not a number is nothing.
inline constexpr double kMostVibration = 0.8, kFeltForce = 0.05, kFullForce = 3;
[[nodiscard]] double vibration_of(double force);

class Headset {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Headset>> start(Renderer& renderer, bool left_handed);
  ~Headset();
  Headset(const Headset&) = delete;
  Headset& operator=(const Headset&) = delete;

  struct Now {
    std::array<PlacedEye, 2> room_from_eye;  // left, right; in the room
    bool eyes = false;                       // the runtime knows where the eyes are and shows their
                                             // pictures
    Wand wand;
    double period = 0;  // time between two pictures of the headset [s]
  };
  // Handles the runtime's events; then returns a frame, if it wants one within wait_s.
  [[nodiscard]] std::optional<Now> begin(double wait_s);
  // Ends the frame: with the scene from these two cameras, or without a picture if eyes is false.
  void end(const Scene& scene, const std::array<Camera, 2>& cameras);

  // The controller vibrates so strongly, 0..1, until the next call, and kVibrates at most: a program that hangs
  // does not keep it on. Nothing while another program has the input of the hands. Once a frame.
  void vibrate(double amplitude);
  static constexpr double kVibrates = 0.1;  // [s]

  // What this runtime cannot do, as a sentence, once; "": nothing (more) to say.
  [[nodiscard]] std::string take_missing();

  [[nodiscard]] bool running() const;  // it wants pictures
  [[nodiscard]] bool over() const;     // it will want no more pictures
  [[nodiscard]] const std::string& why() const;
  [[nodiscard]] const std::string& name() const;  // of the runtime's system

 private:
  struct Work;
  explicit Headset(std::unique_ptr<Work> work);
  std::unique_ptr<Work> work_;
};

// An eye of the room as a camera in the world. What the middle camera looks at stands half a metre
// in front of the person, as large as it appears in the window at that time.
[[nodiscard]] Camera placed(const Camera& middle, const PlacedEye& room_from_eye);
[[nodiscard]] math::Pose placed(const Camera& middle, const math::Pose& in_room);

}  // namespace burr::render
