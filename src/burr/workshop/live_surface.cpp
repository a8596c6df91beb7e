#include "burr/workshop/live_surface.h"

namespace burr::workshop {
namespace {

constexpr int kPatchesPerFrame = 256;  // sent to the GPU; more wait for the next frame

}  // namespace

void put_skin(render::Scene& scene, const surface::Skin& skin) {
  if (skin.mesh == nullptr) return;
  render::set_patch(scene, skin.patch, *skin.mesh);
}

LiveSurface::LiveSurface(sim::Session& session, surface::Worker& worker, render::Scene& scene,
                         bool software, const render::GovernorSettings& governor)
    : LiveSurface(session.bone(), worker, scene, software, governor) {
  session_ = &session;
}

LiveSurface::LiveSurface(const volume::Bone& bone, surface::Worker& worker, render::Scene& scene,
                         bool software, const render::GovernorSettings& governor)
    : worker_(worker),
      scene_(scene),
      coarse_(worker.patches(), bone.grid().voxel),
      governor_(software, governor),
      wound_(bone.grid().voxel, render::bleeding_of(bone.tissues())) {}

tick::Shed LiveSurface::shed() const {
  return session_ != nullptr ? session_->shed() : tick::Shed::none;
}

double LiveSurface::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
}

void LiveSurface::update(const render::Camera* eye) {
  worker_.hold_back(shed() >= tick::Shed::mesh);
  skins_.clear();
  surface::Skin skin;
  for (int i = 0; i < kPatchesPerFrame && worker_.take(skin); ++i) {
    put_skin(scene_, skin);
    wound_.stain(scene_, skin.patch);
    worker_.give_back(skin);
    skins_.push_back(skin);
  }
  coarse_.hold_back(shed() >= tick::Shed::picture);
  coarse_.update(scene_, now());
  scene_.quality = governor_.begin(eye != nullptr ? *eye : scene_.camera, now());
  wound_.renew(scene_, now());
}

void LiveSurface::look_plain() {
  if (!wound_.any()) return;
  wound_.forget();
  wound_.stain(scene_);
}

void LiveSurface::drawn(double took_s, double redrawn) { governor_.end(took_s, redrawn, now()); }

}  // namespace burr::workshop
