#include "window/start/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "burr/base/version.h"
#include "burr/render/bone_scene.h"
#include "shared/work.h"
#include "window/parts/small_picture.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

// The bone of a case, with voxels large enough to be made in a moment, seen from the work place.
Result<render::Scene> scene_of(const std::string& name, Progress& progress) {
  WorkOptions options;
  options.volume.source = name;
  const Status taken = take_case(options);
  if (!taken) return taken.error();
  options.volume.voxel_mm *= 2;
  auto work = open_work(options, progress);
  if (!work) return work.error();
  render::Scene scene;
  scene.tissue_colours = render::colours_of(work->bone->tissues());
  const Status skinned = render::skin_bone(scene, *work->bone, 1, progress);
  if (!skinned) return skinned.error();
  const render::Camera near = render::view_of_work(work->place.at, -work->place.into, 0.1);
  scene.camera = render::whole_view(scene, near.azimuth, near.elevation,
                                    static_cast<double>(Thumbnails::kWidth) / Thumbnails::kHeight);
  scene.look = render::still_look();
  return scene;
}

}  // namespace

Thumbnails::Thumbnails(fs::path cache, std::vector<std::string> cases)
    : cache_(std::move(cache)), cases_(std::move(cases)), textures_(cases_.size()) {}

void Thumbnails::forget() {
  for (Texture& texture : textures_) texture.forget();
  next_ = 0;
  loading_.reset();
}

fs::path Thumbnails::file(std::size_t which) const {
  return cache_.empty() ? fs::path()
                        : cache_ / fmt::format("case_{}_{}.ppm", cases_[which], base::version());
}

void Thumbnails::step(render::Renderer& renderer) {
  if (finished()) return;
  if (loading_ == nullptr) {
    render::Image image;
    if (!cache_.empty() && read_small_picture(file(next_), image) && image.width == kWidth &&
        image.height == kHeight)
      return put(next_++, image);
    loading_ = std::make_unique<Loading<render::Scene>>(
        [name = cases_[next_]](Progress& progress) { return scene_of(name, progress); });
    return;
  }
  if (!loading_->finished()) return;
  const Result<render::Scene> scene = loading_->take();
  loading_.reset();
  const std::size_t which = next_++;
  if (!scene) return;  // the card of the case is then shown without a picture
  const auto image = renderer.image(*scene, kWidth, kHeight);
  if (!image) return;
  put(which, *image);
  if (!cache_.empty()) keep_small_picture(file(which), *image);
}

void Thumbnails::put(std::size_t which, const render::Image& image) {
  textures_[which].put(image.width, image.height, 3, image.rgb);
}

}  // namespace burr::app
