// python/src/python_eye.h - pictures of a session, drawn off-screen in this process.
//
// The surface is made once and then mended where the bone changed, so a picture in each step of an
// environment is possible. Thread: Python's main thread alone (SDL), while the session stands.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "burr/base/progress.h"
#include "burr/render/image.h"
#include "burr/render/renderer.h"
#include "burr/render/scene.h"
#include "burr/rt/changed_bits.h"
#include "burr/sim/session.h"
#include "burr/surface/mesher.h"
#include "burr/tick/rows.h"
#include "burr/workshop/tool_looks.h"
#include "common.h"

namespace burr::python {

class Eye {
 public:
  // at, outward: where work begins, and the way to the one who looks.
  Eye(sim::Session& session, const math::Vec3& at, const math::Vec3& outward);
  ~Eye();  // any thread
  Eye(const Eye&) = delete;
  Eye& operator=(const Eye&) = delete;

  // row: of the newest tick; none: no tool is drawn. Raises where nothing can be drawn.
  [[nodiscard]] render::Image look(const std::optional<tick::TickRow>& row, int width, int height,
                                   Work& work);

 private:
  sim::Session& session_;
  rt::ChangedBits& changed_;
  surface::Mesher mesher_;
  workshop::ToolLooks looks_;
  render::Scene scene_;
  // Its own: a renderer knows patches by number and version, and those of two scenes are the same.
  std::unique_ptr<render::Renderer> renderer_;
  std::thread::id mine_ = std::this_thread::get_id();
  bool whole_ = false;
};

// (height, width, 3) uint8; path: a .png too, or empty.
[[nodiscard]] py::array array_of(render::Image image, const std::string& path);
// Raises on any other thread than Python's main thread.
void only_main_thread();

// The field round a point: (edge, edge, edge) uint8, z, y, x; 0 air, 128 the surface, 255 solid.
[[nodiscard]] py::array patch_of(const volume::Bone& bone, const math::Vec3& p, int edge);

}  // namespace burr::python
