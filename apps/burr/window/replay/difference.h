// apps/burr/window/replay/difference.h - where two recordings of the same bone cut differently, in
// colour: on the bones, and in slices.
//
//     left only    gone in the left recording, bone in the right one
//     right only   the other way round
//     both         gone in both
//
// On a bone its surface is painted: bone that is still here but gone in the other recording shows the
// other one's colour, a wall of a cavity that the other one has too shows `both`. A surface that
// differs by less than 0.4 voxel counts as the same. In a slice the removed parts themselves are
// filled.
// Thread: main. The bones must be at rest while paint() reads them: call it when both views have
// settled (ReplayView::settled()). Colours: Okabe and Ito's, which colour-blind people can tell apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/render/scene.h"
#include "burr/render/slice.h"
#include "burr/volume/bone.h"

namespace burr::app {

enum class Cut : std::uint8_t { none, left_only, right_only, both };

inline constexpr render::Colour kLeftOnly = {0.34F, 0.71F, 0.91F},
                                kRightOnly = {0.90F, 0.60F, 0.00F},
                                kBothCut = {0.97F, 0.93F, 0.80F};

// Whether two grids have the same voxels.
[[nodiscard]] bool same_grid(const volume::Grid& a, const volume::Grid& b);

// What of `here`, at a point of its surface, and `there` is cut. here_is_left: `here` is the left
// recording.
[[nodiscard]] Cut cut_at(const volume::Bone& before, const volume::Bone& there,
                         const math::Vec3& surface, bool here_is_left);

// What was cut at a place in the bone.
[[nodiscard]] Cut cut_in(bool before, bool left, bool right);

class Difference {
 public:
  // before: the bone as both began; the same grid as both.
  explicit Difference(std::shared_ptr<const volume::Bone> before) : before_(std::move(before)) {}

  // Adds the three colours behind those of the tissues; no more than 253 tissues.
  [[nodiscard]] static bool add_colours(std::vector<render::Colour>& colours);

  // Paints the surfaces of both scenes; their tissue_colours end with the three colours.
  void paint(render::Scene& left, const volume::Bone& left_bone, render::Scene& right,
             const volume::Bone& right_bone);
  // Gives the patches their own colours back, unless they have changed since.
  void unpaint();
  [[nodiscard]] bool painted() const { return !kept_.empty(); }
  // How many vertices were painted: left only, right only, both.
  [[nodiscard]] const std::array<std::size_t, 4>& counts() const { return counts_; }

 private:
  struct Kept {
    render::Scene* scene;
    int patch;
    render::ScenePatch was;
    std::uint64_t version;  // of the painted patch
  };
  void paint_one(render::Scene& scene, const volume::Bone& there, bool is_left,
                 const math::Aabb& changed);

  std::shared_ptr<const volume::Bone> before_;
  std::vector<Kept> kept_;
  std::array<std::size_t, 4> counts_ = {};
};

}  // namespace burr::app
