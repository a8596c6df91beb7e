// burr picture - a bone as a PNG, without a display: any of the views.
#include <fmt/core.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "burr/render/bone_scene.h"
#include "burr/sim/motion.h"
#include "command.h"
#include "views.h"
#include "volume_options.h"

namespace burr::app {
namespace {

struct Options {
  VolumeOptions volume;
  ViewOptions view;
  PictureSize size;
  std::string out;
  std::vector<double> at_mm;
};

Status run(const Options& options) {
  auto opened = open_volume(options.volume, progress());
  if (!opened) return opened.error();
  volume::Bone& bone = *opened->bone;
  constexpr double kBurr = 2.5e-3;  // as wide as what the view is to show
  std::optional<math::Vec3> at;
  if (options.at_mm.size() == 3)
    at = 1e-3 * math::Vec3(options.at_mm[0], options.at_mm[1], options.at_mm[2]);
  auto place = sim::find_work_place(bone, kBurr, {}, {});
  if (!place) return place.error();
  if (at) place->at = *at;
  render::Scene scene = scene_of_work(bone, kBurr, place->at, -place->into);
  const Status skinned = render::skin_bone(scene, bone, 2, progress());
  if (!skinned) return skinned;
  const Status drawn = draw_view(std::move(scene), bone, place->at, place->into, options.view,
                                 options.size, options.out);
  if (!drawn) return drawn;
  fmt::print("{}: {} x {}\n", options.out, options.size.width, options.size.height);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("picture", "a bone as a PNG, in any view");
  auto options = std::make_shared<Options>();
  command->add_option("volume", options->volume.path, "file, DICOM folder, or phantom:NAME")
      ->required();
  command->add_option("--out", options->out, "F.png")->required();
  command
      ->add_option("--at", options->at_mm,
                   "X,Y,Z in mm, LPS: where to look (default: the top of the bone)")
      ->delimiter(',')
      ->expected(3);
  add_view_options(*command, options->view);
  add_picture_size(*command, options->size);
  add_volume_options(*command, options->volume);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{26, add};

}  // namespace
}  // namespace burr::app
