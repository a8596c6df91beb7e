#include "burr/render/soft_scene.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "burr/render/soft_part.h"
#include "burr/surface/label_surface.h"

namespace burr::render {
namespace {

// Largest errors of its levels of detail [voxel]. The first is 0: versions of meshoptimizer thin a mesh
// differently, and a sheet along an edge of bone must look the same with each.
constexpr std::array kErrors = {0.0, 0.15, 0.5, 1.5};

struct Word {
  std::string_view word;
  Material material;
};

// The first word that the name contains counts. Gloss, grain, pores, milk.
constexpr std::array kSolids = {
    Word{"enamel", {0.75F, 0.05F, 0, 1}},
    Word{"caries", {0, 1, 0.4F, 0}},
    Word{"dentin", {0.25F, 0.35F, 0, 0}},
    Word{"teeth", {0.6F, 0.1F, 0, 0.6F}},
    Word{"tooth", {0.6F, 0.1F, 0, 0.6F}},
    Word{"diploe", {0.3F, 1, 1, 0}},
    Word{"trabecular", {0.3F, 1, 1, 0}},
    Word{"cancellous", {0.3F, 1, 1, 0}},
    Word{"spongy", {0.3F, 1, 1, 0}},
    Word{"mastoid bone", {0.5F, 0.5F, 0.2F, 0}},
    Word{"meatus wall", {0.35F, 0.3F, 0.2F, 0}},
    Word{"labyrinth", {0.25F, 0.1F, 0, 0.25F}},
    Word{"malleus", {0.35F, 0.2F, 0, 0.2F}},
    Word{"incus", {0.35F, 0.2F, 0, 0.2F}},
    Word{"stapes", {0.35F, 0.2F, 0, 0.2F}},
    Word{"cement", {0.1F, 0.3F, 0, 0}},
};
constexpr std::array kSofts = {
    Word{"dura", {0.95F, 0.25F, 0, 0.2F}},  Word{"nerve", {0.7F, 0.1F, 0, 0.2F}},
    Word{"chorda", {0.7F, 0.1F, 0, 0.2F}},  Word{"sinus", {0.9F, 0.15F, 0, 0.1F}},
    Word{"vein", {0.9F, 0.15F, 0, 0.1F}},   Word{"artery", {0.85F, 0.1F, 0, 0}},
    Word{"eardrum", {0.9F, 0.1F, 0, 0.6F}}, Word{"mucosa", {1, 0.3F, 0, 0.2F}},
    Word{"pulp", {0.95F, 0.3F, 0, 0}},
};
constexpr Material kBone = {0, 0.6F, 0.5F, 0}, kSoft = {0.8F, 0.15F, 0, 0.1F};

constexpr double kCover = 1e-3;     // farthest bone that counts as lying on a structure [m]
constexpr double kSmallest = 4e-6;  // piece of a structure that is seen in an opened bone [m^2]

// Whether bone lies, or lay before it was cut, on the surface here: cutting leaves labels as they
// are.
bool covered(const volume::Bone& bone, const surface::Vertex& vertex) {
  const volume::Grid& grid = bone.grid();
  const int steps = std::max(3, static_cast<int>(kCover / grid.voxel));
  const math::Vec3 p = grid.grid_from_world(vertex.p.cast<double>()),
                   n = grid.frame.q.conjugate() * vertex.n.cast<double>();
  for (int step = 1; step <= steps; ++step) {
    const math::Ijk at = (p + step * n).array().round().cast<int>();
    if (!grid.contains(at)) return false;
    if (bone.tissues()[bone.tissue(at.x(), at.y(), at.z())].kind == volume::TissueKind::solid)
      return true;
  }
  return false;
}

// In cubes of this size: so a picture that is redrawn in a corner draws what is there only.  [m]
constexpr double kCube = 12e-3;

// The triangles that lie in a cube; their vertices once each.
struct Cube {
  surface::Mesh mesh;
  std::unordered_map<std::uint32_t, std::uint32_t> place;  // by vertex of the whole mesh

  void add(const surface::Mesh& all, const std::uint32_t* corner) {
    for (int c = 0; c < 3; ++c) {
      const auto next = static_cast<std::uint32_t>(mesh.vertices.size());
      const auto [at, fresh] = place.try_emplace(corner[c], next);
      if (fresh) mesh.vertices.push_back(all.vertices[corner[c]]);
      mesh.triangles.push_back(at->second);
    }
  }
};

SoftStructure structure_of(const surface::Mesh& part, bool open, double voxel) {
  SoftStructure structure;
  JoinedMesh all;
  all.add(SkinMesh(part));
  for (SkinVertex& vertex : all.vertices) {
    if (open) vertex.under |= kOpen;
    structure.box.extend(vertex.p.cast<double>());
  }
  auto errors = kErrors;
  for (double& e : errors) e *= voxel;
  structure.mesh = std::make_shared<const CoarseMesh>(coarser(std::move(all), errors));
  return structure;
}

// Marks the triangles that bone covers: all three corners, since at the rim others would stand out of
// the bone as slivers. Pieces smaller than kSmallest are left out for the same reason.
std::vector<bool> covered_triangles(const volume::Bone& bone, const surface::Mesh& mesh) {
  std::vector<bool> under_bone;
  for (const surface::Vertex& vertex : mesh.vertices) under_bone.push_back(covered(bone, vertex));
  std::vector<std::uint32_t> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto piece_of = [&root](std::uint32_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::vector<bool> triangles(mesh.triangles.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    triangles[t] = under_bone[corner[0]] && under_bone[corner[1]] && under_bone[corner[2]];
    if (!triangles[t]) continue;
    root[piece_of(corner[1])] = piece_of(corner[0]);
    root[piece_of(corner[2])] = piece_of(corner[0]);
  }
  std::vector<double> area(mesh.vertices.size(), 0);  // of the piece with this root [m^2]
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (!triangles[t]) continue;
    const std::uint32_t* corner = &mesh.triangles[3 * t];
    const auto at = [&](int c) { return mesh.vertices[corner[c]].p; };
    area[piece_of(corner[0])] +=
        static_cast<double>((at(1) - at(0)).cross(at(2) - at(0)).norm()) / 2;
  }
  for (std::size_t t = 0; t < triangles.size(); ++t)
    triangles[t] = triangles[t] && area[piece_of(mesh.triangles[3 * t])] >= kSmallest;
  return triangles;
}

// The part that bone covers, or the open part: of dura, the face towards the brain. It would hide
// bone that is cut from that side, since nothing cuts dura.
void add_part(const surface::Mesh& mesh, const std::vector<bool>& hidden, bool open, double voxel,
              volume::TissueId tissue, std::vector<SoftStructure>& out) {
  std::map<std::array<int, 3>, Cube> cubes;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::uint32_t* corner = &mesh.triangles[t];
    if (hidden[t / 3] == open) continue;
    const Eigen::Array3i at =
        (mesh.vertices[corner[0]].p.cast<double>() / kCube).array().floor().cast<int>();
    cubes[{at.x(), at.y(), at.z()}].add(mesh, corner);
  }
  for (const auto& [at, cube] : cubes) {
    out.push_back(structure_of(cube.mesh, open, voxel));
    out.back().tissue = tissue;
  }
}

}  // namespace

std::vector<Material> materials_of(const volume::TissueTable& tissues) {
  std::vector<Material> materials;
  for (const volume::Tissue& tissue : tissues.tissues) {
    std::string name = tissue.name;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto find = [&name](const auto& words, const Material& otherwise) {
      const auto at = std::find_if(words.begin(), words.end(), [&](const Word& word) {
        return name.find(word.word) != std::string::npos;
      });
      return at == words.end() ? otherwise : at->material;
    };
    materials.push_back(tissue.kind == volume::TissueKind::soft ? find(kSofts, kSoft)
                                                                : find(kSolids, kBone));
  }
  return materials;
}

Status add_soft(Scene& scene, const volume::Bone& bone, Progress& progress) {
  scene.materials = materials_of(bone.tissues());
  scene.soft.clear();
  NoProgress quiet;
  for (const volume::TissueId tissue : surface::soft_tissues(bone)) {
    if (progress.cancelled())
      return error(Trouble::interrupted, "stopped before the surface was complete");
    // marrow fills the pores of spongy bone: it is seen on their walls
    if (bone.tissues()[tissue].name.find("marrow") != std::string::npos) continue;
    const Result<surface::Mesh> mesh = surface::label_surface(bone, tissue, quiet);
    if (!mesh) return mesh.error();
    const std::vector<bool> hidden = covered_triangles(bone, *mesh);
    for (const bool open : {false, true})
      add_part(*mesh, hidden, open, bone.grid().voxel, tissue, scene.soft);
  }
  return fine();
}

}  // namespace burr::render
