#include "shared/views.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "burr/render/microscope.h"
#include "burr/render/picture.h"
#include "burr/render/slice.h"
#include "burr/render/stereo.h"

namespace burr::app {
namespace {

using math::Vec3;
using render::Plane;

const std::vector<std::pair<std::string, Plane>> kPlanes = {
    {"axial", Plane::axial}, {"coronal", Plane::coronal}, {"sagittal", Plane::sagittal}};
const std::vector<std::pair<std::string, render::Stereo>> kStereo = {
    {"off", render::Stereo::off},
    {"side-by-side", render::Stereo::side_by_side},
    {"anaglyph", render::Stereo::anaglyph},
    {"interleaved", render::Stereo::interleaved}};

template <class T>
std::optional<T> named(const std::vector<std::pair<std::string, T>>& all, const std::string& name) {
  for (const auto& [one, value] : all)
    if (one == name) return value;
  return std::nullopt;
}

template <class T>
std::vector<std::string> names_of(const std::vector<std::pair<std::string, T>>& all) {
  std::vector<std::string> names;
  for (const auto& one : all) names.push_back(one.first);
  return names;
}

// direction to the viewer of that slice
Vec3 towards_eye(Plane plane) { return render::right_of(plane).cross(render::up_of(plane)); }

}  // namespace

void add_view_options(CLI::App& command, ViewOptions& options) {
  std::vector<std::string> views = {"work", "whole", "microscope", "endoscope"};
  for (const std::string& plane : names_of(kPlanes)) views.push_back(plane);
  command
      .add_option("--view", options.view,
                  "the view (default: as the session was seen; where no view is recorded: work)")
      ->check(CLI::IsMember(views));
  command
      .add_option("--clip", options.clip,
                  "cut the bone open at the work: axial, coronal or sagittal")
      ->check(CLI::IsMember(names_of(kPlanes)));
  command.add_option("--stereo", options.stereo, "a picture for two eyes")
      ->check(CLI::IsMember(names_of(kStereo)))
      ->capture_default_str();
  command
      .add_option("--focus-mm", options.focus_mm,
                  "depth of field of --view microscope: it is sharp this far beyond (above 0) or "
                  "before the "
                  "work; without it everything is sharp")
      ->check(CLI::Range(-30.0, 30.0));
  command
      .add_option("--height-mm", options.height_mm,
                  "height of the part of the bone that the picture shows")
      ->check(CLI::Range(0.1, 2000.0));
  command.add_flag("!--no-labels", options.labels, "all tissues in the colour of bone");
  command.add_option("--see-through", options.see_through, "transparency of the bone [%]")
      ->check(CLI::Range(0.0, 100.0));
}

namespace {

constexpr double kDark = 0.7;  // of the vignette, as in the window

void under_microscope(render::Scene& scene, const ViewOptions& options) {
  render::light_coaxially(scene.look);
  // see-through bone and a section are looked at without what hides them
  if (options.opening && scene.drape == nullptr && scene.look.opacity >= 1 && !scene.clip)
    scene.drape = render::drape_over(scene, *options.opening);
}

void look(render::Scene& scene, const Vec3& at, const Vec3& ahead, const ViewOptions& options,
          double aspect) {
  if (!options.labels) scene.tissue_colours = render::as_bone(scene.tissue_colours);
  scene.look.opacity = 1 - options.see_through / 100;
  render::Camera& camera = scene.camera;
  if (const auto plane = named(kPlanes, options.clip)) {
    const Vec3 n = towards_eye(*plane);
    scene.clip = render::ClipPlane{at, n};
    // a section seen from its edge or from behind would not be visible
    constexpr double kFlattest = 0.5;
    if (camera.backward().dot(n) < kFlattest)
      camera = render::view_of_work(camera.target, n, camera.view_height());
  }

  if (options.view == "whole")
    camera = render::whole_view(scene, camera.azimuth, camera.elevation, aspect);
  if (options.view == "microscope") {
    const bool into_case = options.opening && !scene.clip;
    const Vec3 outward = into_case ? options.opening->outward : camera.backward();
    camera = render::microscope_view(at, outward, render::kFields[render::kFirstField]);
    scene.vignette = kDark;
    under_microscope(scene, options);
  }
  if (options.view == "endoscope") {
    constexpr double kBack = 6e-3;  // distance of its tip behind the burr's
    camera = render::endoscope_view(at - kBack * ahead.normalized(), ahead);
    scene.burr.visible = false;  // the view is from the tool itself
    scene.round = true;
    scene.scale_bar = false;
    render::light_coaxially(scene.look);
  }
  if (options.focus_mm) scene.focus = render::microscope_focus(camera, 1e-3 * *options.focus_mm);
  if (options.height_mm > 0 && options.view == "microscope")
    render::set_field(camera, 1e-3 * options.height_mm);
  else if (options.height_mm > 0)
    camera.distance = 0.5e-3 * options.height_mm / std::tan(camera.field_of_view / 2);
}

}  // namespace

void look_as_seen(render::Scene& scene, const render::Camera& camera, const ViewOptions& options) {
  scene.camera = camera;
  const bool microscope = render::is_microscope(camera);
  const render::Look plain;
  scene.vignette = microscope ? kDark : 0;
  if (microscope) {
    under_microscope(scene, options);
  } else {
    scene.drape = nullptr;
    scene.look.key = plain.key;
    scene.look.fill = plain.fill;
    scene.look.ambient = plain.ambient;
    scene.look.background_top = plain.background_top;
    scene.look.background_bottom = plain.background_bottom;
  }
}

namespace {

// Only a microscope has depth of field; nobody should wonder why nothing is unsharp.
Status focus_fits(const ViewOptions& options) {
  if (!options.focus_mm || options.view == "microscope") return fine();
  return error(
      Trouble::usage,
      "--focus-mm: only --view microscope has depth of field; add it, or leave --focus-mm out");
}

}  // namespace

bool shows_slice(const ViewOptions& options) { return named(kPlanes, options.view).has_value(); }

Status set_view(render::Scene& scene, const Vec3& at, const Vec3& ahead,
                const ViewOptions& options) {
  if (const Status fits = focus_fits(options); !fits) return fits;
  if (named(kPlanes, options.view) || options.view == "whole")
    return error(Trouble::usage,
                 "--view " + options.view +
                     ": a film shows the work, or looks through a microscope or endoscope; choose "
                     "one of these, or --picture");
  if (options.stereo != "off")
    return error(Trouble::usage,
                 "--stereo " + options.stereo +
                     ": a film is for one eye; leave --stereo out, or use --picture");
  look(scene, at, ahead, options, 1);
  return fine();
}

Status draw_view(render::Scene scene, volume::Bone& bone, const Vec3& at, const Vec3& ahead,
                 const ViewOptions& options, PictureSize size, const std::string& file) {
  if (const Status fits = focus_fits(options); !fits) return fits;
  if (const auto plane = named(kPlanes, options.view)) {
    render::Slice slice;
    slice.plane = *plane;
    slice.through = at;
    slice.labels = options.labels;
    if (options.greys != nullptr) {
      slice.greys = options.greys.get();
      slice.window = options.window;
      slice.level = options.grey_level;
    }
    if (options.height_mm > 0) slice.height = 1e-3 * options.height_mm;
    render::Image image{size.width, size.height, {}};
    render::Slicer(bone).draw(slice, image);
    return render::write_png(image, file);
  }
  look(scene, at, ahead, options, static_cast<double>(size.width) / size.height);
  const render::Camera camera = scene.camera;
  const auto stereo = named(kStereo, options.stereo).value_or(render::Stereo::off);
  if (stereo == render::Stereo::off)
    return render::render_png(scene, size.width, size.height, file);
  const render::Eyes eyes = render::eyes_of(camera, render::kComfortable * camera.distance);
  scene.camera = eyes.left;
  const auto left = render::render_image(scene, size.width, size.height);
  if (!left) return left.error();
  scene.camera = eyes.right;
  const auto right = render::render_image(scene, size.width, size.height);
  if (!right) return right.error();
  return render::write_png(render::join_eyes(*left, *right, stereo), file);
}

}  // namespace burr::app
