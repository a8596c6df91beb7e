// burr picture - draws a bone to a PNG, without a display, in any of the views.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "burr/render/bone_scene.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/opening.h"
#include "burr/workshop/work_view.h"
#include "shared/outputs.h"
#include "shared/picture_size.h"
#include "shared/subcommand.h"
#include "shared/views.h"
#include "shared/volume_words.h"

namespace burr::app {
namespace {

struct Options {
  scenario::BoneRecipe volume;
  ViewOptions view;
  PictureSize size;
  std::string out;
  std::vector<double> at_mm, greys;
};

// The view, with the scan's values in it if that was requested.
Result<ViewOptions> view_of(const Options& options,
                            std::shared_ptr<const volume::Greys> of_the_scan) {
  ViewOptions view = options.view;
  if (options.greys.empty()) return view;
  if (!shows_slice(view))
    return error(Trouble::usage,
                 "--greys: only slices show grey values; add --view axial, coronal or sagittal");
  if (!(options.greys[0] > 0))
    return error(Trouble::usage,
                 fmt::format("--greys: a window of {} shows nothing; width and level are needed, "
                             "as in 4000,700",
                             options.greys[0]));
  if (of_the_scan == nullptr)
    return error(Trouble::usage, "--greys: " + options.volume.source +
                                     " has no grey values: it is a formula or a label map");
  view.greys = std::move(of_the_scan);
  view.window = options.greys[0];
  view.grey_level = options.greys[1];
  return view;
}

Status run(const Options& options) {
  const Status possible =
      check_outputs({options.volume.source, options.volume.labels, options.volume.materials},
                    {{"--out", options.out, {".png"}}});
  if (!possible) return possible;
  base::OneBar bar(progress(), workshop::steps_to_picture(options.volume));
  auto opened = workshop::open_bone(options.volume, bar, nullptr, !options.greys.empty());
  if (!opened) return opened.error();
  const auto view = view_of(options, opened->greys);
  if (!view) return view.error();
  volume::Bone& bone = *opened->bone;
  constexpr double kBurr = 2.5e-3;  // the width that the view is to show
  std::optional<math::Vec3> at;
  if (options.at_mm.size() == 3)
    at = 1e-3 * math::Vec3(options.at_mm[0], options.at_mm[1], options.at_mm[2]);
  auto place = surgeon::find_work_place(bone, kBurr, {}, {});
  if (!place) return place.error();
  if (at) place->at = *at;
  render::Scene scene = workshop::scene_of_work(bone, kBurr, place->at, -place->into);
  const Status skinned = render::skin_bone(scene, bone, 2, bar);
  if (!skinned) return skinned;
  ViewOptions shown = *view;
  if (!at) shown.opening = workshop::opening_of_phantom(options.volume.source);
  const Status drawn =
      draw_view(std::move(scene), bone, place->at, place->into, shown, options.size, options.out);
  if (!drawn) return drawn;
  fmt::print("{}: {} x {}\n", options.out, options.size.width, options.size.height);
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("picture", "draw a bone as a PNG, in any view");
  auto options = std::make_shared<Options>();
  command->add_option("volume", options->volume.source, "file, DICOM folder, or phantom:NAME")
      ->required();
  command->add_option("--out", options->out, "F.png")->required();
  command
      ->add_option("--at", options->at_mm,
                   "X,Y,Z in mm, LPS: where to look (default: the top of the bone)")
      ->delimiter(',')
      ->expected(3);
  add_view_options(*command, options->view);
  command
      ->add_option(
          "--greys", options->greys,
          "W,L: slices show the scan's grey values, with window W and level L, as in 4000,700")
      ->delimiter(',')
      ->expected(2);
  add_picture_size(*command, options->size);
  add_volume_options(*command, options->volume);
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{26, add};

}  // namespace
}  // namespace burr::app
