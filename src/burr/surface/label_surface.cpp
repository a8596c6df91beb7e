#include "burr/surface/label_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "burr/surface/mesher.h"

namespace burr::surface {

using math::Ijk;
using math::Vec3f;
using volume::kBrickEdge;
using volume::kBrickVoxels;

namespace {

// half width of the filter, and one each for corners and stairs that are closed before [voxel]
constexpr int kApron = 4;
constexpr int kEdge = kBrickEdge + 2 * kApron;  // of a brick with its apron
constexpr float kSure = 0.12F;                  // least distance of a voxel from one half
constexpr int kRounds = 40;                     // of smoothing
constexpr float kIn = 0.5F, kOut = -0.52F;      // its steps: shrinking, then growing again
constexpr float kFarthest = 0.5F;               // that a vertex may move [voxel]
constexpr double kThin = 2.5;                   // a strand thinner than this [voxel] ...
constexpr float kThinFarthest = 1;  // ... follows its middle rather than its voxels [voxel]
constexpr int kNormalRounds = 10;
// A face that is nearly parallel to the voxels has terraces many voxels long, which that smoothing
// takes for its shape. Where a face is flat within about six voxels, it is smoothed again, as a net
// under tension (Gibson 1998). Flat: the mean of its normals there is nearly as long as one of them.
constexpr int kReachRounds = 60, kFlatRounds = 100;
constexpr float kFlatFarthest = 0.6F;  // that a vertex of it may move [voxel]
constexpr float kBent = 0.95F,
                kFlat = 0.985F;  // length of that mean: not smoothed, wholly smoothed

using Near = std::array<float, static_cast<std::size_t>(kEdge* kEdge* kEdge)>;

// Bricks that hold the label, and their neighbours: only there the filter gives anything.
std::vector<volume::BrickIndex> bricks_at(const volume::Bone& bone, volume::TissueId tissue) {
  const Ijk& all = bone.bricks();
  std::vector<std::uint8_t> near(static_cast<std::size_t>(bone.brick_count()));
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::TissueId* labels = bone.brick_tissue(brick);
    if (labels == nullptr ||
        std::find(labels, labels + kBrickVoxels, tissue) == labels + kBrickVoxels)
      continue;
    const Ijk at = bone.brick_ijk(brick) / kBrickEdge;
    const Ijk low = (at.array() - 1).max(0), high = (at.array() + 1).min(all.array() - 1);
    for (int k = low.z(); k <= high.z(); ++k)
      for (int j = low.y(); j <= high.y(); ++j)
        for (int i = low.x(); i <= high.x(); ++i)
          near[static_cast<std::size_t>(bone.brick_at(i, j, k))] = 1;
  }
  std::vector<volume::BrickIndex> bricks;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
    if (near[static_cast<std::size_t>(brick)] != 0) bricks.push_back(brick);
  return bricks;
}

// 1 where the label is, 0 elsewhere, in a brick and around it; the border of the grid goes on.
void gather(const volume::Bone& bone, volume::TissueId tissue, const Ijk& first, Near& near) {
  const Ijk last = bone.grid().size.array() - 1;
  std::size_t n = 0;
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      for (int x = 0; x < kEdge; ++x, ++n) {
        const Ijk at = (first + Ijk(x, y, z)).array().max(0).min(last.array());
        const volume::TissueId* labels = bone.brick_tissue(
            bone.brick_at(at.x() / kBrickEdge, at.y() / kBrickEdge, at.z() / kBrickEdge));
        const int inside = at.x() % kBrickEdge +
                           kBrickEdge * (at.y() % kBrickEdge + kBrickEdge * (at.z() % kBrickEdge));
        near[n] = labels != nullptr && labels[inside] == tissue ? 1.0F : 0.0F;
      }
}

// Fills the corner beside two voxels that touch only by an edge, so that a thin sheet of stairs is
// one sheet. A solid's stairs have no such corner.
void close_stairs(Near& near) {
  constexpr std::array<int, 3> kSteps = {1, kEdge, kEdge * kEdge};
  const Near was = near;
  for (int z = 1; z < kEdge - 1; ++z)
    for (int y = 1; y < kEdge - 1; ++y)
      for (int x = 1; x < kEdge - 1; ++x) {
        const int n = (z * kEdge + y) * kEdge + x;
        const auto label = [&](int by) { return was[static_cast<std::size_t>(n + by)] > 0; };
        for (int way = 0; way < 12 && !label(0); ++way) {
          const int first = way / 4, second = (first + 1) % 3;
          const int a = (way & 1) != 0 ? kSteps[static_cast<std::size_t>(first)]
                                       : -kSteps[static_cast<std::size_t>(first)],
                    b = (way & 2) != 0 ? kSteps[static_cast<std::size_t>(second)]
                                       : -kSteps[static_cast<std::size_t>(second)];
          if (label(a) && label(b) && !label(a + b)) near[static_cast<std::size_t>(n)] = 1;
        }
      }
}

// The same where two voxels touch only by a corner, as in a strand one voxel thick that runs askew:
// the two voxels between them that come first along x and y.
void close_corners(Near& near) {
  const Near was = near;
  for (int z = 1; z < kEdge - 1; ++z)
    for (int y = 1; y < kEdge - 1; ++y)
      for (int x = 1; x < kEdge - 1; ++x) {
        const int n = (z * kEdge + y) * kEdge + x;
        const auto label = [&](int by) { return was[static_cast<std::size_t>(n + by)] > 0; };
        if (!label(0)) continue;
        for (int way = 0; way < 4; ++way) {
          const int dx = (way & 1) != 0 ? 1 : -1, dy = ((way & 2) != 0 ? 1 : -1) * kEdge,
                    dz = kEdge * kEdge;
          const bool alone = label(dx + dy + dz) && !label(dx) && !label(dy) && !label(dz) &&
                             !label(dx + dy) && !label(dx + dz) && !label(dy + dz);
          if (!alone) continue;
          near[static_cast<std::size_t>(n + dx)] = 1;
          near[static_cast<std::size_t>(n + dx + dy)] = 1;
        }
      }
}

// One pass of the filter along an axis. The outermost voxels along it are not used afterwards.
void filter(Near& near, std::size_t step) {
  const std::size_t reach = 2 * step;
  Near out = near;
  for (std::size_t n = reach; n + reach < near.size(); ++n)
    out[n] =
        (near[n - reach] + near[n + reach] + 4 * (near[n - step] + near[n + step]) + 6 * near[n]) /
        16;
  near = out;
}

void fill(const volume::Bone& bone, volume::TissueId tissue, volume::BrickIndex brick,
          volume::Bone& smooth) {
  static constexpr std::array<volume::TissueId, kBrickVoxels> kNothing{};
  thread_local Near near, sharp;
  const Ijk first = bone.brick_ijk(brick) - Ijk::Constant(kApron);
  gather(bone, tissue, first, near);
  close_corners(near);
  close_stairs(near);
  sharp = near;
  for (const std::size_t step :
       {std::size_t{1}, static_cast<std::size_t>(kEdge), static_cast<std::size_t>(kEdge * kEdge)})
    filter(near, step);
  volume::BrickField field;
  std::size_t out = 0;
  for (int z = 0; z < kBrickEdge; ++z)
    for (int y = 0; y < kBrickEdge; ++y)
      for (int x = 0; x < kBrickEdge; ++x) {
        const auto n =
            static_cast<std::size_t>(((z + kApron) * kEdge + y + kApron) * kEdge + x + kApron);
        const float share =
            sharp[n] > 0 ? std::max(near[n], 0.5F + kSure) : std::min(near[n], 0.5F - kSure);
        field.voxel[out++] = static_cast<volume::Field>(share * 65535.0F);
      }
  smooth.build_brick(brick, field.voxel, kNothing.data());
}

// The neighbours of each vertex, one after the other.
struct Around {
  std::vector<std::uint32_t> first,
      all;  // (vertices + 1), those of vertex v: first[v] .. first[v+1]
};

// In a closed mesh the neighbours of a vertex are the next corners of its triangles.
Around around(const Mesh& mesh) {
  Around out;
  out.first.assign(mesh.vertices.size() + 1, 0);
  for (const std::uint32_t v : mesh.triangles) ++out.first[v + 1];
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) out.first[v + 1] += out.first[v];
  out.all.resize(mesh.triangles.size());
  std::vector<std::uint32_t> at(out.first.begin(), out.first.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c)
      out.all[at[mesh.triangles[t + c]]++] = mesh.triangles[t + (c + 1) % 3];
  return out;
}

// Moves each value a share of the way to the mean of its neighbours.
void towards_mean(const Around& near, float share, std::vector<Vec3f>& values,
                  std::vector<Vec3f>& means) {
  for (std::size_t v = 0; v < values.size(); ++v) {
    Vec3f sum = Vec3f::Zero();
    for (std::uint32_t n = near.first[v]; n < near.first[v + 1]; ++n) sum += values[near.all[n]];
    means[v] = sum / static_cast<float>(std::max(1U, near.first[v + 1] - near.first[v]));
  }
  for (std::size_t v = 0; v < values.size(); ++v) values[v] += share * (means[v] - values[v]);
}

// The diameter of a long round body with this volume and area [m].
double thickness(const Mesh& mesh) {
  const math::Vec3 origin = mesh.vertices.front().p.cast<double>();
  double volume = 0, area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const auto at = [&](std::size_t c) -> math::Vec3 {
      return mesh.vertices[mesh.triangles[t + c]].p.cast<double>() - origin;
    };
    const math::Vec3 across = (at(1) - at(0)).cross(at(2) - at(0));
    volume += at(0).dot(across) / 6;
    area += across.norm() / 2;
  }
  return area > 0 ? 4 * volume / area : 0;
}

// The normals of a mesh with its vertices at these places.
std::vector<Vec3f> normals_at(const Mesh& mesh, const std::vector<Vec3f>& p) {
  std::vector<Vec3f> normals(p.size(), Vec3f::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::uint32_t* c = &mesh.triangles[t];
    const Vec3f area = (p[c[1]] - p[c[0]]).cross(p[c[2]] - p[c[0]]);
    for (int i = 0; i < 3; ++i) normals[c[i]] += area;
  }
  for (std::size_t v = 0; v < p.size(); ++v)
    if (const float length = normals[v].norm(); length > 0)
      normals[v] /= length;
    else
      normals[v] = mesh.vertices[v].n;
  return normals;
}

// Smooths the flat faces further. start: places before any smoothing.
void smoothen_flat(const Mesh& mesh, const Around& near, const std::vector<Vec3f>& start,
                   float farthest, std::vector<Vec3f>& p) {
  std::vector<Vec3f> normals = normals_at(mesh, p), means(p.size());
  for (int round = 0; round < kReachRounds; ++round) towards_mean(near, kIn, normals, means);
  struct Flat {
    std::uint32_t vertex;
    float share;
  };
  std::vector<Flat> flat;
  for (std::uint32_t v = 0; v < p.size(); ++v)
    if (const float share = (normals[v].norm() - kBent) / (kFlat - kBent); share > 0)
      flat.push_back({v, std::min(share, 1.0F)});
  for (int round = 0; round < kFlatRounds; ++round)
    for (const auto& [v, share] : flat) {  // in place: half the rounds
      Vec3f sum = Vec3f::Zero();
      for (std::uint32_t n = near.first[v]; n < near.first[v + 1]; ++n) sum += p[near.all[n]];
      sum /= static_cast<float>(near.first[v + 1] - near.first[v]);
      p[v] += share * (sum - p[v]);
      const Vec3f moved = p[v] - start[v];
      if (const float far = moved.norm(); far > farthest)
        p[v] = start[v] + moved * (farthest / far);
    }
}

void smoothen(Mesh& mesh, double voxel) {
  const Around near = around(mesh);
  // about a point of the mesh, where single precision is finest
  const Vec3f origin = mesh.vertices.front().p;
  std::vector<Vec3f> start, p, means(mesh.vertices.size());
  for (const Vertex& vertex : mesh.vertices) start.emplace_back(vertex.p - origin);
  p = start;
  const bool thin = thickness(mesh) < kThin * voxel;
  const float farthest = (thin ? kThinFarthest : kFarthest) * static_cast<float>(voxel);
  for (int round = 0; round < kRounds; ++round) {
    towards_mean(near, kIn, p, means);
    towards_mean(near, kOut, p, means);
    for (std::size_t v = 0; v < p.size(); ++v) {
      const Vec3f moved = p[v] - start[v];
      if (const float far = moved.norm(); far > farthest)
        p[v] = start[v] + moved * (farthest / far);
    }
  }
  smoothen_flat(mesh, near, start, kFlatFarthest * static_cast<float>(voxel), p);
  std::vector<Vec3f> normals = normals_at(mesh, p);
  for (int round = 0; round < kNormalRounds; ++round) towards_mean(near, 0.6F, normals, means);
  for (std::size_t v = 0; v < p.size(); ++v) {
    mesh.vertices[v].p = p[v] + origin;
    if (const float length = normals[v].norm(); length > 1e-3F)
      mesh.vertices[v].n = normals[v] / length;
  }
}

}  // namespace

std::vector<volume::TissueId> soft_tissues(const volume::Bone& bone) {
  std::array<bool, 256> there{};
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick)
    if (const volume::TissueId* labels = bone.brick_tissue(brick); labels != nullptr)
      for (int v = 0; v < kBrickVoxels; ++v) there[labels[v]] = true;
  std::vector<volume::TissueId> soft;
  for (std::size_t id = 0; id < there.size(); ++id)
    if (there[id] &&
        bone.tissues()[static_cast<volume::TissueId>(id)].kind == volume::TissueKind::soft)
      soft.push_back(static_cast<volume::TissueId>(id));
  return soft;
}

Result<Mesh> label_surface(const volume::Bone& bone, volume::TissueId tissue, Progress& progress) {
  const std::vector<volume::BrickIndex> bricks = bricks_at(bone, tissue);
  if (bricks.empty()) return Mesh{};
  volume::Bone smooth(bone.grid(), {}, bricks.size(), 0, false);
  for (const volume::BrickIndex brick : bricks) fill(bone, tissue, brick, smooth);
  smooth.pack();
  Result<Mesh> mesh = whole_surface(smooth, 1, progress);
  if (!mesh) return mesh;
  for (Vertex& vertex : mesh->vertices) vertex.tissue = tissue;
  if (!mesh->vertices.empty()) smoothen(*mesh, bone.grid().voxel);
  return mesh;
}

}  // namespace burr::surface
