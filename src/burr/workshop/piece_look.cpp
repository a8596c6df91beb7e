#include "burr/workshop/piece_look.h"

#include <utility>

#include "burr/render/soft_scene.h"
#include "burr/surface/mesher.h"

namespace burr::workshop {
namespace {

using math::Pose;
using math::Vec3;

constexpr std::size_t kMostColours = 256;

// The mesh at another place, in one colour.
std::shared_ptr<const render::CoarseMesh> moved(const render::CoarseMesh& mesh, const Pose& by,
                                                volume::TissueId colour) {
  auto out = std::make_shared<render::CoarseMesh>(mesh);
  for (render::SkinVertex& vertex : out->vertices) {
    const Vec3 n = by.q * render::normal_of(vertex).cast<double>();
    vertex.p = (by * vertex.p.cast<double>()).cast<float>();
    vertex.rest = render::folded(n.cast<float>(), colour);
    vertex.under = 0;
  }
  return out;
}

}  // namespace

std::shared_ptr<const render::CoarseMesh> mesh_of_piece(const volume::Bone& piece) {
  NoProgress quiet;
  const auto surface = surface::whole_surface(piece, 1, quiet);
  if (!surface) return nullptr;
  render::JoinedMesh all;
  all.add(render::SkinMesh(*surface));
  if (all.triangles.empty()) return nullptr;
  auto mesh = std::make_shared<render::CoarseMesh>();
  mesh->vertices = std::move(all.vertices);
  mesh->levels = {{0, std::move(all.triangles)}};
  return mesh;
}

void PieceLook::take_away(render::Scene& scene) const {
  if (drawn_ == nullptr) return;
  std::erase_if(scene.soft,
                [this](const render::SoftStructure& one) { return one.mesh == drawn_; });
}

void PieceLook::put(render::Scene& scene, const std::shared_ptr<const render::CoarseMesh>& mesh,
                    const Pose& by, std::size_t colour) {
  take_away(scene);
  if (mesh == nullptr || colour >= kMostColours) {
    mesh_ = drawn_ = nullptr;
    return;
  }
  if (scene.tissue_colours.size() <= colour) scene.tissue_colours.resize(colour + 1);
  scene.tissue_colours[colour] = kColour;
  const auto id = static_cast<volume::TissueId>(colour);
  if (mesh != mesh_ || by.p != by_.p || by.q.coeffs() != by_.q.coeffs() || colour != colour_)
    drawn_ = moved(*mesh, by, id);
  mesh_ = mesh;
  by_ = by;
  colour_ = colour;
  render::SoftStructure piece;
  piece.tissue = id;
  piece.mesh = drawn_;
  for (const render::SkinVertex& vertex : drawn_->vertices)
    piece.box.extend(vertex.p.cast<double>());
  scene.soft.push_back(std::move(piece));
}

}  // namespace burr::workshop
