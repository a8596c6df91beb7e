// workshop/live_surface.h - what keeps the picture of a bone true and quick while it is milled: the
// same for the window, a whole session without one, and the bench of frames.
//
//     LiveSurface live(session, worker, scene, renderer.software());   // before the session starts
//     each frame:   live.update();                // patches, coarse blocks, what may be left out
//                   renderer.show(scene);
//                   live.drawn(took_s, renderer.figures().redrawn);
//
// Thread: main.
#pragma once

#include <chrono>
#include <vector>

#include "burr/render/coarsening.h"
#include "burr/render/governor.h"
#include "burr/render/scene.h"
#include "burr/render/wound.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "burr/workshop/traces.h"

namespace burr::workshop {

// A made patch into the scene.
void put_skin(render::Scene& scene, const surface::Skin& skin);

class LiveSurface {
 public:
  LiveSurface(sim::Session& session, surface::Worker& worker, render::Scene& scene, bool software);
  // A bone that no servo cuts: nothing is held back.
  LiveSurface(const volume::Bone& bone, surface::Worker& worker, render::Scene& scene,
              bool software);

  // Patches that are ready go into the scene, as many as a frame bears; surface and coarse blocks
  // are held back where the machine does not keep up with the hand. eye: that looks in place of the
  // scene's camera, a headset's.
  void update(const render::Camera* eye = nullptr);
  // What the tool does to the look of the bone; before update(). nothing: the bone as ever.
  void see(const render::Wound::Tick& tick) { wound_.see(tick); }
  void suck(const math::Vec3& mouth, double radius, double seconds) {
    wound_.suck(mouth, radius, seconds);
  }
  void see(const Traces::StatusLine& told) { told.show(wound_); }
  void look_plain();
  // After the frame: how long it took, how much of the picture was drawn anew.
  void drawn(double took_s, double redrawn);

  [[nodiscard]] render::FrameGovernor& governor() { return governor_; }
  [[nodiscard]] render::Coarsening& coarsening() { return coarse_; }
  // Of the last update; their meshes are given back.
  [[nodiscard]] const std::vector<surface::Skin>& skins() const { return skins_; }
  [[nodiscard]] double now() const;  // since it was made [s]

 private:
  [[nodiscard]] tick::Shed shed() const;

  sim::Session* session_ = nullptr;
  surface::Worker& worker_;
  render::Scene& scene_;
  render::Coarsening coarse_;
  render::FrameGovernor governor_;
  render::Wound wound_;
  std::vector<surface::Skin> skins_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
};

}  // namespace burr::workshop
