// apps/burr/bench/bench_vtk_frame.h - frame time of VTK for the same bone, where burr_vtk_frame was
// built (cmake/vtk_oracle.cmake) and there is a display.
#pragma once

#include <optional>

#include "burr/render/scene.h"

namespace burr::app {

// Median frame time while the bone turns in front of the scene's camera [ms]; all triangles, one
// light, no effects, back faces left out. none: not built, no display, or it failed.
[[nodiscard]] std::optional<double> vtk_frame_ms(const render::Scene& scene, int width, int height,
                                                 int frames);

}  // namespace burr::app
