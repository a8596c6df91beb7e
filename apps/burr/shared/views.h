// apps/burr/shared/views.h - the views of a bone as pictures: 3D, slices, microscope, endoscope;
// cut open, and for two eyes.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/render/scene.h"
#include "burr/volume/bone.h"
#include "burr/volume/greys.h"
#include "shared/picture_size.h"

namespace CLI {
class App;
}

namespace burr::app {

// The options as typed.
struct ViewOptions {
  std::string view;            // empty: work, or as the session was seen
  std::string clip;            // axial, coronal or sagittal: cut open in that plane; empty: whole
  std::string stereo = "off";  // side-by-side, anaglyph, interleaved
  // the microscope is sharp that far beyond (above 0) or before the work; without it, everywhere [mm]
  std::optional<double> focus_mm = {};
  double height_mm = 0;    // height of the picture at the work; 0: a value that suits the view
  bool labels = true;      // colours of tissues
  double see_through = 0;  // transparency of the bone [%]
  // for slices: the scan's values, in this window; not an option on the command line
  std::shared_ptr<const volume::Greys> greys;
  double window = 0, grey_level = 0;
  // likewise not on the command line: where a microscope sees soft tissue around the work
  std::optional<render::Opening> opening = {};
};

// The scene is drawn from where a session looked: from this camera, with the light and the soft
// tissue of a microscope if it is one. The surface must be in the scene; fresh: the drape is made anew.
void look_as_seen(render::Scene& scene, const render::Camera& camera, const ViewOptions& options);

// Adds --view --clip --stereo --focus-mm --height-mm --no-labels --see-through.
void add_view_options(CLI::App& command, ViewOptions& options);

[[nodiscard]] bool shows_slice(const ViewOptions& options);

// Sets camera, clip plane and mask of a 3D view, for a film. Its surface must be in the scene. Errors: Trouble::usage for a view that is not 3D, or for two eyes.
[[nodiscard]] Status set_view(render::Scene& scene, const math::Vec3& at, const math::Vec3& ahead,
                              const ViewOptions& options);

// Writes a PNG of the scene, whose camera looks at the work, and of its bone, which must be at
// rest. at: position of the work; ahead: direction of the tool [m], any length.
[[nodiscard]] Status draw_view(render::Scene scene, volume::Bone& bone, const math::Vec3& at,
                               const math::Vec3& ahead, const ViewOptions& options,
                               PictureSize size, const std::string& file);

}  // namespace burr::app
