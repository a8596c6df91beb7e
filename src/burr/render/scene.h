// render/scene.h - everything that can be seen, as plain data without a GPU.
//
//     Scene scene;
//     scene.tissue_colours = colours_of(bone.tissues());
//     set_patch(scene, 17, patch);                       // again whenever the bone changed there
//     scene.camera = whole_view(scene, 0, 0.3, 16.0 / 9);
//
// Frame: world (LPS). Units: m. Thread: one at a time. A copy is cheap, because the patches are
// shared.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/math/pose.h"
#include "burr/render/camera.h"
#include "burr/render/changes.h"
#include "burr/render/coarse_mesh.h"
#include "burr/render/drape.h"
#include "burr/render/focus.h"
#include "burr/render/image.h"
#include "burr/render/look.h"
#include "burr/render/quality.h"
#include "burr/render/skin_mesh.h"
#include "burr/surface/patch.h"

namespace burr::render {

// What milling left on a vertex (wound.h), of 255.
struct Stain {
  std::uint8_t fresh = 0;  // cut just now: pale and grainy
  std::uint8_t wet = 0;    // under a film of water
  std::uint8_t dust = 0;   // bone dust lies on it; with water, a paste
  std::uint8_t blood = 0;
  // Ridges that the burr's flutes left, which stay: 8 bit, how high; 24 bit, how far along its path
  // the burr was here, in steps of kAlong.
  std::uint32_t ridges = 0;
  static constexpr double kAlong = 5e-6;  // [m]
  [[nodiscard]] bool passing() const { return (fresh | wet | dust | blood) != 0; }
  [[nodiscard]] bool operator==(const Stain&) const = default;
};
static_assert(sizeof(Stain) == 8, "goes to the GPU as it is");

// One patch of surface. A renderer keeps its own copy and renews it when `version` differs.
struct ScenePatch {
  std::shared_ptr<const SkinMesh> mesh;  // nullptr: no surface here
  std::uint64_t version = 0;
  // one for each vertex; nullptr: plain bone. Sent again when the pointer changes.
  std::shared_ptr<const std::vector<Stain>> stains;
  math::Aabb box;  // around its vertices
  // Fewer triangles over the same vertices (thin_patch.h), drawn where the error is small enough; nullptr:
  // none are made. Sent again when the pointer changes.
  std::shared_ptr<const std::vector<CoarseLevel>> coarser;
};

// Several patches with fewer triangles. Drawn in place of the patches where its error is small
// enough and none of the patches has changed since (coarsening.h). A large block contains smaller
// ones.
struct SceneBlock {
  std::vector<int> patches;  // all patches that it replaces
  std::vector<int> inner;    // numbers of the (lower) blocks it is made of; empty: made of patches
  int outer = -1;            // number of the block that contains it; -1: none
  std::uint64_t now = 0;     // sum of the patches' present versions
  std::shared_ptr<const CoarseMesh> mesh;  // nullptr: none made
  std::uint64_t versions = 0;              // value of `now` when the mesh was made
};

// A soft structure (nerve, vessel, dura) with a surface of its own, whole in spite of what is cut.
struct SoftStructure {
  volume::TissueId tissue = 0;
  std::shared_ptr<const CoarseMesh> mesh;  // sent again when the pointer changes
  math::Aabb box;                          // around its vertices
};

// How a tissue looks besides its colour; 0..1 each.
struct Material {
  float gloss = 0;  // 0 dry bone .. 1 covered with water
  float grain = 0;  // fine unevenness of the colour, as bone has it
  float pores = 0;  // dark points where small vessels enter
  float milk = 0;   // light comes through its edges, as through enamel
  [[nodiscard]] bool operator==(const Material&) const = default;
};

// A tool of another shape: drawn in place of head, shaft and handpiece. Frame: of the tool [m]
struct ToolLook {
  surface::Mesh cuts, rubs;  // render/tool_mesh.h
};

// The tool in the hand: a fluted or grainy ball on a shaft, which extends along the tool's +z into a
// tapered handpiece.
struct Burr {
  bool visible = false;
  math::Pose world_from_tool;             // origin: centre of the head
  double radius = 2.5e-3;                 // of the head [m]
  double shaft_radius = 1.2e-3;           // [m]
  double shaft_length = 70e-3;            // of the lines that show the mirrored image [m]
  double turn = 0;                        // of the spindle [rad]
  bool diamond = false;                   // grains in place of flutes
  std::shared_ptr<const ToolLook> other;  // no round burr; sent again when the pointer changes
};

// A tool of any shape in the other hand; it casts no shadow of its own.
struct OtherTool {
  math::Pose world_from_tool;
  std::shared_ptr<const ToolLook> look;  // sent again when the pointer changes
};

struct Marker {
  math::Vec3 p = math::Vec3::Zero();
  double radius = 0.4e-3;  // [m]
  Colour colour = {1, 1, 1};
  bool on_top = false;  // visible through everything
};

// A line as a thin rod; with a head at b if it is an arrow.
struct Rod {
  math::Vec3 a = math::Vec3::Zero(), b = math::Vec3::Zero();
  double radius = 0.15e-3;  // [m]
  Colour colour = {1, 1, 1};
  bool arrow = false;
  bool on_top = false;
};

// Outlines of mirror mode, drawn over everything: a frame in the plane, and the burr's mirror
// image.
struct Mirrored {
  math::Pose world_from_tool;              // of the image
  std::array<math::Vec3, 4> corners = {};  // of the plane, around
  double line = 0.15e-3;                   // radius of the lines [m]
};

// Everything on the side that n points to is not drawn; a flat face closes the bone's section.
struct ClipPlane {
  math::Vec3 p = math::Vec3::Zero();
  math::Vec3 n = math::Vec3::UnitZ();  // unit
};

// A picture in the picture, with a text in its corner.
struct Inset {
  std::shared_ptr<const Image> image;  // sent again when the pointer changes
  int x = 0, y = 0, width = 0,
      height = 0;  // of the whole picture, from its top left corner [pixel]
};

struct Scene {
  std::vector<ScenePatch> patches;     // index: number of the patch, as surface/mesher.h counts
  Changes changes;                     // of the patches; kept by set_patch() and set_stains()
  std::vector<SceneBlock> blocks;      // empty: nothing is drawn coarser
  std::vector<int> block_of;           // (patches) the smallest block of each; patches beyond its
                                       // end have none
  std::vector<Colour> tissue_colours;  // index: TissueId
  std::vector<Material> materials;     // index: TissueId; those beyond its end are plain
  std::vector<SoftStructure> soft;     // see render/soft_scene.h
  Burr burr;
  std::optional<OtherTool> beside;  // of the other hand
  // Chips of bone (render/chips.h); nullptr: none. Frame: world [m]. Sent again when the pointer changes.
  std::shared_ptr<const surface::Mesh> chips;
  std::vector<Marker> markers;
  std::vector<Rod> rods;
  std::optional<Mirrored> mirrored;
  Camera camera;
  Look look;
  Quality quality;                // of a window's picture
  std::optional<ClipPlane> clip;  // of the bone
  bool round = false;             // only a circle is visible, as through a microscope or endoscope
  double vignette = 0;            // darkness in the corners, as a microscope's picture has, 0..1
  std::optional<Focus> focus;     // depth of field; nullopt: everything is sharp
  std::shared_ptr<const Drape> drape;  // around the work, drawn only; nullptr: none
  std::vector<Inset> insets;           // over it
  bool scale_bar = false;         // bottom right; its length is true at the depth of the camera's
                                  // target
  std::vector<std::string> text;  // lines, top left; ASCII
};

// the tissues' own colours, one per id
[[nodiscard]] std::vector<Colour> colours_of(const volume::TissueTable& tissues);

// Colours without labels: every tissue gets the colour of bone.
[[nodiscard]] std::vector<Colour> as_bone(std::vector<Colour> colours);

// Puts a patch at its index (extends the list if needed) and raises its version.
void set_patch(Scene& scene, int index, const surface::Patch& patch);
// The same in two steps; packed() may run on any thread.
[[nodiscard]] ScenePatch packed(const surface::Patch& patch);
void set_patch(Scene& scene, int index, ScenePatch&& patch);
// Sets the stains of a patch that exists.
void set_stains(Scene& scene, int index, std::shared_ptr<const std::vector<Stain>> stains);

// Sets the coarser levels of a patch that exists.
void set_coarser(Scene& scene, int index, std::shared_ptr<const std::vector<CoarseLevel>> levels);

// Sum of the present versions of a block's patches. Versions only grow, so equal sums mean equal
// patches.
[[nodiscard]] std::uint64_t versions_of(const Scene& scene, const SceneBlock& block);

// The box around all patches, soft structures and the drape; empty if there are none.
[[nodiscard]] math::Aabb bounds(const Scene& scene);

// A camera with all of the bone in the picture, as fit() in camera.h.
[[nodiscard]] Camera whole_view(const Scene& scene, double azimuth, double elevation,
                                double aspect);

// Marks for hand and contact: the true position of the hand, a line from it to the burr that the
// bone holds back, and the force as an arrow of `length_per_newton` [m/N]. They replace all marks
// of the scene.
void show_contact(Scene& scene, const math::Vec3& hand, const math::Vec3& proxy,
                  const math::Vec3& force, double length_per_newton = 8e-3);

}  // namespace burr::render
