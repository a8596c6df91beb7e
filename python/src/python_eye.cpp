#include "python_eye.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "burr/render/bone_scene.h"
#include "burr/render/picture.h"
#include "burr/workshop/work_view.h"

namespace burr::python {
namespace {

// Renderers of sessions that ended on another thread: they end on that of the pictures.
struct Left {
  std::mutex mutex;
  std::vector<std::unique_ptr<render::Renderer>> all;
};
Left& left() {
  static Left* const one = new Left;  // it outlives all objects of Python
  return *one;
}

}  // namespace

void only_main_thread() {
  const py::module_ threading = py::module_::import("threading");
  if (!threading.attr("current_thread")().is(threading.attr("main_thread")()))
    raise("pictures are drawn on Python's main thread alone; call it there");
}

Eye::Eye(sim::Session& session, const math::Vec3& at, const math::Vec3& outward)
    : session_(session),
      changed_(session.bone().add_watcher()),
      mesher_(session.bone()),
      looks_(session.settings().servo.tools),
      scene_(workshop::scene_of_work(session.bone(), session.burr_radius(), at, outward)) {
  std::vector<std::unique_ptr<render::Renderer>> ended;
  {
    const std::lock_guard lock(left().mutex);
    ended.swap(left().all);
  }
  renderer_ = take(render::Renderer::offscreen());
}

Eye::~Eye() {
  if (!renderer_ || std::this_thread::get_id() == mine_) return;
  const std::lock_guard lock(left().mutex);
  left().all.push_back(std::move(renderer_));
}

render::Image Eye::look(const std::optional<tick::TickRow>& row, int width, int height,
                        Work& work) {
  check(work.run([&]() -> Status {
    std::vector<int> patches;
    changed_.take_all([&](std::size_t brick) {
      if (whole_) mesher_.patches_of_brick(static_cast<volume::BrickIndex>(brick), patches);
    });
    if (!whole_) {
      const Status skinned = render::skin_bone(scene_, session_.bone(), 2, work);
      if (!skinned) return skinned;
      whole_ = true;
    }
    std::sort(patches.begin(), patches.end());
    patches.erase(std::unique(patches.begin(), patches.end()), patches.end());
    surface::Patch mesh;
    for (const int patch : patches)
      if (mesher_.mesh_patch(patch, mesh)) render::set_patch(scene_, patch, mesh);
    return fine();
  }));
  scene_.burr.visible = false;
  if (row) {
    workshop::put_tool(scene_, *row, false);
    looks_.put(scene_, row->tool.number);
  }
  return take(work.run([&] { return renderer_->image(scene_, width, height); }));
}

py::array array_of(render::Image image, const std::string& path) {
  if (!path.empty()) check(render::write_png(image, path));
  return as_array(std::move(image.rgb), {image.height, image.width, 3});
}

py::array patch_of(const volume::Bone& bone, const math::Vec3& p, int edge) {
  if (edge < 1 || edge > 128)
    raise(fmt::format("a patch of {} voxels along an edge is not possible; use 1 to 128", edge));
  const math::Vec3 grid = bone.grid().grid_from_world(p);
  const auto first = [&](double at, int voxels) {  // far outside all is air, wherever it is
    return static_cast<int>(std::lround(std::clamp(at, -1e6, 1e6 + voxels))) - edge / 2;
  };
  const math::Ijk& size = bone.grid().size;
  const int i0 = first(grid.x(), size.x()), j0 = first(grid.y(), size.y()),
            k0 = first(grid.z(), size.z());
  std::vector<std::uint8_t> out;
  out.reserve(static_cast<std::size_t>(edge) * static_cast<std::size_t>(edge) *
              static_cast<std::size_t>(edge));
  for (int k = k0; k < k0 + edge; ++k)
    for (int j = j0; j < j0 + edge; ++j)
      for (int i = i0; i < i0 + edge; ++i) {
        const bool inside =
            i >= 0 && j >= 0 && k >= 0 && i < size.x() && j < size.y() && k < size.z();
        out.push_back(inside ? static_cast<std::uint8_t>(bone.field(i, j, k) >> 8U)
                             : std::uint8_t{0});
      }
  return as_array(std::move(out), {edge, edge, edge});
}

}  // namespace burr::python
