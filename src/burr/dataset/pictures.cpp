#include "burr/dataset/pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "burr/dataset/eye.h"
#include "burr/dataset/hdf5_file.h"
#include "burr/render/bone_scene.h"
#include "burr/render/soft_scene.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/work_view.h"

namespace burr::dataset {

Pictures::Pictures(record::Player& player, const Options& options, double field_of_view)
    : player_(player),
      options_(options),
      field_of_view_(field_of_view),
      looks_(player.info().tools),
      pieces_(player),
      raster_(options.width, options.height) {}

Result<std::unique_ptr<Pictures>> Pictures::make(record::Player& player, const volume::Bone& before,
                                                 const Options& options, double field_of_view,
                                                 Progress& progress) {
  std::unique_ptr<Pictures> made(new Pictures(player, options, field_of_view));
  auto renderer = render::Renderer::offscreen();
  if (!renderer) return renderer.error();
  made->renderer_ = std::move(*renderer);
  made->bone_ = volume::copy_of(before);
  render::Scene& scene = made->scene_;
  scene.tissue_colours = render::colours_of(before.tissues());
  if (const Status soft = render::add_soft(scene, *made->bone_, progress); !soft)
    return soft.error();
  made->worker_ = std::make_unique<surface::Worker>(*made->bone_, 1);
  const Status skinned = made->worker_->first(
      progress, [&scene](const surface::Skin& skin) { workshop::put_skin(scene, skin); });
  if (!skinned) return skinned.error();
  return made;
}

Status Pictures::set_scene(double t, const record::Step& step) {
  Status there = player_.bone_at(t, *bone_);
  if (!there) return there;
  worker_->settle([this](const surface::Skin& skin) { workshop::put_skin(scene_, skin); });
  workshop::put_tool(scene_, step.row, false);
  looks_.put(scene_, step.row.tool.number);
  second_.put(scene_, step.second ? &*step.second : nullptr,
              record::tool_of(player_.info().second));
  const auto piece = pieces_.at(step.row, t, *bone_);
  if (!piece) return piece.error();
  piece_.put(scene_, piece->mesh, piece->by, bone_->tissues().tissues.size());
  return fine();
}

Status Pictures::draw_eye(const record::View& view, double right, std::vector<std::uint8_t>& out) {
  const double aspect = static_cast<double>(options_.width) / options_.height;
  scene_.camera = camera_of(view, field_of_view_, aspect, right);
  auto image = renderer_->image(scene_, options_.width, options_.height);
  if (!image) return image.error();
  out = std::move(image->rgb);
  for (std::size_t n = 0; n + 2 < out.size(); n += 3) std::swap(out[n], out[n + 2]);
  return fine();
}

Result<SamplePictures> Pictures::draw(double t, const record::Step& step,
                                      const record::View& view) {
  Status going = set_scene(t, step);
  if (going) going = draw_eye(view, -options_.baseline / 2, left_);
  if (going) going = draw_eye(view, options_.baseline / 2, right_);
  if (!going) return going.error();
  raster_.draw(scene_, view, field_of_view_);
  depth_.resize(raster_.depth().size());
  std::transform(raster_.depth().begin(), raster_.depth().end(), depth_.begin(), half_of);
  labels_.clear();
  for (const std::uint16_t label : raster_.labels()) {
    render::Colour colour = {0, 0, 0};
    if (label == Raster::kTool) colour = {1, 1, 1};
    if (label < scene_.tissue_colours.size()) colour = scene_.tissue_colours[label];
    for (const int channel : {2, 1, 0})
      labels_.push_back(byte_of(colour[static_cast<std::size_t>(channel)]));
  }
  return SamplePictures{left_, right_, labels_, depth_};
}

}  // namespace burr::dataset
