#include "workshop/live_bone.h"

namespace burr::app {
namespace {

constexpr int kPatchesPerFrame = 256;  // sent to the GPU; more wait for the next frame

}  // namespace

void put_skin(render::Scene& scene, const surface::Skin& skin) {
  if (skin.mesh == nullptr) return;
  render::set_patch(scene, skin.patch, *skin.mesh);
}

LiveBone::LiveBone(sim::Session& session, surface::Worker& worker, render::Scene& scene,
                   bool software)
    : LiveBone(session.bone(), worker, scene, software) {
  session_ = &session;
}

LiveBone::LiveBone(const volume::Bone& bone, surface::Worker& worker, render::Scene& scene,
                   bool software)
    : worker_(worker),
      scene_(scene),
      coarse_(worker.patches(), bone.grid().voxel),
      governor_(software),
      wound_(bone.grid().voxel, render::bleeding_of(bone.tissues())) {}

tick::Load LiveBone::load() const {
  return session_ != nullptr ? session_->load() : tick::Load::none;
}

double LiveBone::now() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun_).count();
}

void LiveBone::update(const render::Camera* eye) {
  worker_.hold_back(load() >= tick::Load::mesh);
  skins_.clear();
  surface::Skin skin;
  for (int i = 0; i < kPatchesPerFrame && worker_.take(skin); ++i) {
    put_skin(scene_, skin);
    wound_.dress(scene_, skin.patch);
    worker_.give_back(skin);
    skins_.push_back(skin);
  }
  coarse_.hold_back(load() >= tick::Load::picture);
  coarse_.update(scene_, now());
  scene_.quality = governor_.begin(eye != nullptr ? *eye : scene_.camera, now());
  wound_.renew(scene_, now());
}

void LiveBone::look_plain() {
  if (!wound_.any()) return;
  wound_.forget();
  wound_.dress(scene_);
}

void LiveBone::drawn(double took_s, double redrawn) { governor_.end(took_s, redrawn, now()); }

}  // namespace burr::app
