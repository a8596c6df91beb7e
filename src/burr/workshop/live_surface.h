// workshop/live_surface.h - keeps the surface in the picture up to date while a bone is milled,
// within the time of a frame. The window, full_load_run and the bench of frames all use it.
//
//     LiveSurface live(session, worker, scene, renderer.software());   // before the session starts
//     each frame:   live.update();                // patches, coarse blocks, what may be skipped
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

// Puts a finished patch into the scene.
void put_skin(render::Scene& scene, const surface::Skin& skin);

class LiveSurface {
 public:
  // software: the processor draws. governor: how much of the picture may be left out.
  LiveSurface(sim::Session& session, surface::Worker& worker, render::Scene& scene, bool software,
              const render::GovernorSettings& governor = {});
  // For a bone that no servo cuts: nothing is delayed.
  LiveSurface(const volume::Bone& bone, surface::Worker& worker, render::Scene& scene,
              bool software, const render::GovernorSettings& governor = {});

  // Puts finished patches into the scene, as many as fit into a frame. Patches and coarse blocks
  // wait while the machine cannot keep up with the hand. eye: a headset's camera, used instead of
  // the scene's.
  void update(const render::Camera* eye = nullptr);
  // What the tool does to the look of the bone (render/wound.h). Call it before update().
  void see(const render::Wound::Tick& tick) { wound_.see(tick); }
  void see_beside(const render::Wound::Tick& tick) { wound_.see_beside(tick); }
  void suck(const math::Vec3& mouth, double radius, double seconds) {
    wound_.suck(mouth, radius, seconds);
  }
  void see(const Traces::Changes& changes) { changes.show(wound_); }
  void look_plain();
  // Call it after the frame. took_s: how long the frame took  [s]; redrawn: share of the picture
  // that was drawn again, 0..1.
  void drawn(double took_s, double redrawn);

  [[nodiscard]] render::FrameGovernor& governor() { return governor_; }
  [[nodiscard]] render::Coarsening& coarsening() { return coarse_; }
  // The patches of the last update; their meshes have been given back to the worker.
  [[nodiscard]] const std::vector<surface::Skin>& skins() const { return skins_; }
  [[nodiscard]] double now() const;  // time since construction  [s]

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
