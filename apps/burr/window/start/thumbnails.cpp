#include "window/start/thumbnails.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <system_error>
#include <utility>

#include "burr/base/new_file.h"
#include "burr/base/version.h"
#include "burr/render/bone_scene.h"
#include "shared/work.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHead = "P6\n472 270\n255\n";  // complete header of such a picture (PPM)

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

bool read_picture(const fs::path& path, render::Image& image) {
  std::ifstream file(path, std::ios::binary);
  const std::string head = kHead;
  std::string found(head.size(), ' ');
  if (!file.read(found.data(), static_cast<std::streamsize>(found.size())) || found != head)
    return false;
  image = {Thumbnails::kWidth, Thumbnails::kHeight, {}};
  image.rgb.resize(std::size_t{3} * Thumbnails::kWidth * Thumbnails::kHeight);
  return static_cast<bool>(file.read(reinterpret_cast<char*>(image.rgb.data()),
                                     static_cast<std::streamsize>(image.rgb.size())));
}

void keep_picture(const fs::path& path, const render::Image& image) {
  std::error_code nobody_asks;
  fs::create_directories(path.parent_path(), nobody_asks);
  auto file = base::NewFile::create(path.string());
  if (!file) return;  // not kept; next time it is made again
  file->write(kHead);
  file->write(image.rgb.data(), image.rgb.size());
  static_cast<void>(file->put_in_place());
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
    if (!cache_.empty() && read_picture(file(next_), image)) return put(next_++, image);
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
  if (!cache_.empty()) keep_picture(file(which), *image);
}

void Thumbnails::put(std::size_t which, const render::Image& image) {
  textures_[which].put(image.width, image.height, 3, image.rgb);
}

}  // namespace burr::app
