#include "burr/surface/mesher.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>

#include "burr/base/check.h"
#include "burr/math/sums.h"
#include "burr/rt/thread.h"
#include "burr/surface/cases.h"
#include "burr/surface/tissues_behind.h"

namespace burr::surface {
namespace {

using volume::Bone;
using volume::BrickField;
using volume::BrickIndex;
using volume::Field;
using volume::kBrickEdge;
using volume::kIso;

constexpr int kCells = kPatchEdge;     // along each axis of a patch
constexpr int kSamples = kCells + 1;   // voxels at the corners of its cells
constexpr int kApron = kSamples + 2;   // plus one on each side, for gradients
constexpr int kRow = 20;               // memory of a row of kApron, a multiple of 4
constexpr int kBricks = 4;             // along each axis, that contain these voxels
constexpr int kTries = 32;             // to copy one brick, before giving way to the servo
constexpr float kCorner = 1.0F / 256;  // vertices stay this far from voxel centres  [voxel]

constexpr int kMostVertices = 3 * kSamples * kSamples * kCells;
constexpr int kMostIndices = 3 * kMostTriangles * kCells * kCells * kCells;
constexpr int kIds = kSamples * kSamples * kSamples;  // of the edges along one axis, by low end

// An edge of the voxel grid inside a patch, in the order in which vertices are made.
struct EdgeKey {
  int x, y, z, axis;
  [[nodiscard]] std::uint16_t packed() const {
    return static_cast<std::uint16_t>(((z * kSamples + y) * 3 + axis) * kSamples + x);
  }
  static EdgeKey unpacked(std::uint16_t key) {
    return {key % kSamples, key / kSamples / 3 % kSamples, key / kSamples / 3 / kSamples,
            key / kSamples % 3};
  }
};

// the top bit of each of 4 voxels, as 4 bits
std::uint32_t solid4(const Field* voxel) {
  std::uint64_t four = 0;
  std::memcpy(&four, voxel, sizeof four);
  four = (four >> 15) & 0x0001000100010001ULL;
  return static_cast<std::uint32_t>((four * 0x0001000200040008ULL) >> 48) & 15U;
}
static_assert(kIso == 0x8000, "the top bit says solid");

}  // namespace

struct Mesher::Work {
  explicit Work(const volume::Bone& from)
      : bone(from), behind(from, shine_through(from.grid().voxel), kShineSteps) {
    const volume::Grid& grid = bone.grid();
    patches = (grid.size.array() + 1 + kCells - 1) / kCells;
    const math::Mat3 axes = grid.frame.q.toRotationMatrix();
    step = axes * grid.voxel;
    turn = axes.cast<float>();
    origin = grid.frame.p;
    std::size_t e = 0;
    for (const CellEdge& edge : cell_edges())
      id_offset[e++] = edge.axis * kIds + (edge.z * kSamples + edge.y) * kSamples + edge.x;
  }

  bool run(int patch);
  bool gather(const math::Ijk& first);
  void find_solid();
  void make_vertices(const math::Ijk& first);
  template <int axis>
  void make_vertex(int x, int y, int z, const math::Ijk& first);
  void make_triangles();

  const volume::Bone& bone;
  TissuesBehind behind;
  bool soft_near = false;  // in reach of this patch
  math::Ijk patches = {0, 0, 0};
  math::Mat3 step;  // columns: world step of one voxel along i, j, k [m]
  Eigen::Matrix3f turn;
  math::Vec3 origin;
  std::array<int, kCellEdges> id_offset{};

  std::array<BrickField, kBricks * kBricks * kBricks> bricks;
  alignas(64) std::array<Field, kApron * kApron * kRow> field{};  // (19 x 19 x 20), x fastest
  std::array<std::uint32_t, kSamples * kSamples> solid{};         // (17 x 17) rows of 17 bits
  std::array<std::uint16_t, 3 * kIds> id{};                       // index of the vertex on an edge
  std::array<std::uint16_t, kMostVertices> key{};                 // edge of each vertex, ascending
  std::array<Vertex, kMostVertices> vertex;
  std::array<std::uint32_t, kMostIndices> triangle{};
  int vertices = 0, indices = 0;
};

// Copies the voxels of a patch and its apron. False: the servo was writing them. first: the patch's
// voxel (0,0,0) in the grid. Sets vertices = indices = 0. `field` is filled only if there may be
// surface, otherwise `solid` stays all zero.
bool Mesher::Work::gather(const math::Ijk& first) {
  static const BrickField air{};
  const math::Ijk low = (first.array() + 1) / kBrickEdge - 1;  // first is 16 p - 1
  std::array<const Field*, kBricks * kBricks * kBricks> from{};
  solid.fill(0);

  const auto index = [](int a, int b, int c) {
    return static_cast<std::size_t>(a + kBricks * (b + kBricks * c));
  };
  // of the bricks at the rim only the rows of the apron are needed
  const auto rows = [](int brick) -> Bone::Range {
    return {brick == 0 ? kBrickEdge - 2 : 0, brick == kBricks - 1 ? 1 : kBrickEdge};
  };
  const auto copy = [&](int a, int b, int c) {
    const math::Ijk at = low + math::Ijk(a, b, c);
    const Field*& to = from[index(a, b, c)];
    to = air.voxel;
    if ((at.array() < 0).any() || (at.array() >= bone.bricks().array()).any()) return true;
    const BrickIndex brick = bone.brick_at(at.x(), at.y(), at.z());
    if (bone.brick_field(brick) == nullptr) return true;
    BrickField& mine = bricks[index(a, b, c)];
    for (int i = 0; i < kTries; ++i) {
      if (!bone.copy_rows(brick, rows(b), rows(c), mine)) continue;
      to = mine.voxel;
      return true;
    }
    return false;
  };

  // the bricks of the cells' corners: if all are air or all are solid there is no surface
  std::uint64_t any = 0, all = ~0ULL;
  for (int c = 0; c < 3; ++c)
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a) {
        if (!copy(a, b, c)) return false;
        const Field* voxel = from[index(a, b, c)];
        if (voxel == air.voxel) {
          all = 0;
          continue;
        }
        if ((any & ~all & 0x8000800080008000ULL) != 0) continue;
        const Bone::Range ys = rows(b), zs = rows(c);
        for (int z = zs.first; z < zs.last; ++z)
          for (int v = 8 * (ys.first + 8 * z); v < 8 * (ys.last + 8 * z); v += 4) {
            std::uint64_t word = 0;
            std::memcpy(&word, voxel + v, sizeof word);
            any |= word;
            all &= word;
          }
      }
  constexpr std::uint64_t kTops = 0x8000800080008000ULL;
  if ((any & kTops) == 0 || (all & kTops) == kTops) return true;
  for (int c = 0; c < kBricks; ++c)
    for (int b = 0; b < kBricks; ++b)
      for (int a = 0; a < kBricks; ++a)
        if ((a == 3 || b == 3 || c == 3) && !copy(a, b, c)) return false;

  // rows of 2 + 8 + 8 + 1 voxels
  Field* row = field.data();
  for (int z = 0; z < kApron; ++z)
    for (int y = 0; y < kApron; ++y, row += kRow) {
      const int b = (y + 6) >> 3, c = (z + 6) >> 3;
      const int inside = 8 * (((y + 6) & 7) + 8 * ((z + 6) & 7));
      const Field* const* line = &from[index(0, b, c)];
      std::memcpy(row, line[0] + inside + 6, 2 * sizeof(Field));
      std::memcpy(row + 2, line[1] + inside, 8 * sizeof(Field));
      std::memcpy(row + 10, line[2] + inside, 8 * sizeof(Field));
      row[18] = line[3][inside];
    }

  // a brick may reach beyond the grid; outside the grid is air, whatever the brick holds there
  const math::Ijk end = bone.grid().size - first + math::Ijk::Ones();
  if ((end.array() < kApron).any()) {
    for (int z = 0; z < kApron; ++z)
      for (int y = 0; y < kApron; ++y) {
        Field* at = &field[static_cast<std::size_t>((z * kApron + y) * kRow)];
        const int keep = z < end.z() && y < end.y() ? std::clamp(end.x(), 0, kApron) : 0;
        std::fill(at + keep, at + kApron, Field{0});
      }
  }
  find_solid();
  return true;
}

void Mesher::Work::find_solid() {
  std::uint32_t* bits = solid.data();
  for (int z = 1; z <= kSamples; ++z)
    for (int y = 1; y <= kSamples; ++y) {
      const Field* row = &field[static_cast<std::size_t>((z * kApron + y) * kRow + 1)];
      *bits++ = solid4(row) | solid4(row + 4) << 4 | solid4(row + 8) << 8 | solid4(row + 12) << 12 |
                static_cast<std::uint32_t>(row[16] >> 15) << 16;
    }
}

template <int axis>
void Mesher::Work::make_vertex(int x, int y, int z, const math::Ijk& first) {
  constexpr int kStep[3] = {1, kRow, kApron * kRow};
  const Field* a = &field[static_cast<std::size_t>(((z + 1) * kApron + y + 1) * kRow + x + 1)];
  const Field* b = a + kStep[axis];

  // where the field crosses the iso-level between the two voxels
  const auto fa = static_cast<float>(*a), fb = static_cast<float>(*b);
  const float t = std::clamp((static_cast<float>(kIso) - fa) / (fb - fa), kCorner, 1.0F - kCorner);

  // outwards is where the field decreases
  const auto difference = [](const Field* at, int by) {
    return static_cast<float>(int{at[-by]} - int{at[by]});
  };
  math::Vec3f n;
  for (int d = 0; d < 3; ++d) {
    const float na = difference(a, kStep[d]), nb = difference(b, kStep[d]);
    n[d] = na + t * (nb - na);
  }
  float length = math::squared_norm(n);
  if (!(length > 0)) {  // a single voxel: along the edge
    n = math::Vec3f::Unit(axis) * (fa < fb ? -1.0F : 1.0F);
    length = 1;
  }

  const auto i = static_cast<std::size_t>(vertices++);
  math::Vec3 p_grid = (first + math::Ijk(x, y, z)).cast<double>();
  math::Ijk voxel = first + math::Ijk(x, y, z);
  p_grid[axis] += static_cast<double>(t);
  if (fb >= fa) voxel[axis] += 1;
  vertex[i].p = (origin + step * p_grid).cast<float>();
  vertex[i].n = turn * (n / std::sqrt(length));
  vertex[i].tissue = bone.shared_tissue(voxel.x(), voxel.y(), voxel.z());
  vertex[i].beneath = 0;
  vertex[i].through = 0;
  vertex[i].wall = 0;
  if (soft_near)
    behind.look_beneath(p_grid, (n / std::sqrt(length)).template cast<double>(), vertex[i]);
  if (vertex[i].through == 0 && !behind.border_bricks.empty())
    behind.look_aside(voxel, p_grid, vertex[i]);
  key[i] = EdgeKey{x, y, z, axis}.packed();
  id[static_cast<std::size_t>(axis * kIds + (z * kSamples + y) * kSamples + x)] =
      static_cast<std::uint16_t>(i);
}

void Mesher::Work::make_vertices(const math::Ijk& first) {
  const std::uint32_t* row = solid.data();
  for (int z = 0; z < kSamples; ++z)
    for (int y = 0; y < kSamples; ++y, ++row) {
      std::uint32_t crossed = (*row ^ (*row >> 1)) & 0xFFFFU;
      for (; crossed != 0; crossed &= crossed - 1)
        make_vertex<0>(std::countr_zero(crossed), y, z, first);
      if (y < kCells)
        for (crossed = *row ^ row[1]; crossed != 0; crossed &= crossed - 1)
          make_vertex<1>(std::countr_zero(crossed), y, z, first);
      if (z < kCells)
        for (crossed = *row ^ row[kSamples]; crossed != 0; crossed &= crossed - 1)
          make_vertex<2>(std::countr_zero(crossed), y, z, first);
    }
}

void Mesher::Work::make_triangles() {
  const auto& cases = cell_cases();
  std::uint32_t* to = triangle.data();
  for (int z = 0; z < kCells; ++z)
    for (int y = 0; y < kCells; ++y) {
      const std::uint32_t* row = &solid[static_cast<std::size_t>(z * kSamples + y)];
      const std::uint32_t a = row[0], b = row[1], c = row[kSamples], d = row[kSamples + 1];
      const std::uint32_t any = a | b | c | d, all = a & b & c & d;
      std::uint32_t active = (any | any >> 1) & ~(all & all >> 1) & 0xFFFFU;
      for (; active != 0; active &= active - 1) {
        const int x = std::countr_zero(active);
        const std::uint32_t which =
            ((a >> x) & 3U) | ((b >> x) & 3U) << 2 | ((c >> x) & 3U) << 4 | ((d >> x) & 3U) << 6;
        const CellCase& cell = cases[which];
        const std::uint16_t* ids = &id[static_cast<std::size_t>((z * kSamples + y) * kSamples + x)];
        for (std::size_t e = 0; e < std::size_t{3} * cell.count; ++e)
          *to++ = ids[id_offset[cell.edge[e]]];
      }
    }
  indices = static_cast<int>(to - triangle.data());
}

bool Mesher::Work::run(int patch) {
  BURR_CHECK(patch >= 0 && patch < patches.prod());
  const math::Ijk at(patch % patches.x(), patch / patches.x() % patches.y(),
                     patch / patches.x() / patches.y());
  const math::Ijk first = at * kCells - math::Ijk::Ones();
  vertices = indices = 0;
  if (!gather(first)) return false;
  soft_near = behind.any_soft_near(first);
  make_vertices(first);
  if (vertices > 0) make_triangles();
  return true;
}

// Builds the tables of cases now, not at the first patch, which may be meshed inside a tick.
Mesher::Mesher(const volume::Bone& bone) : work_(std::make_unique<Work>(bone)) {
  static_cast<void>(cell_edges());
  static_cast<void>(cell_cases());
}
Mesher::~Mesher() = default;

math::Ijk Mesher::patches() const { return work_->patches; }
int Mesher::patch_count() const { return work_->patches.prod(); }

void Mesher::patches_of_brick(BrickIndex brick, std::vector<int>& out) const {
  // patch p reads the voxels 16 p - 2 .. 16 p + 16
  const math::Ijk first = work_->bone.brick_ijk(brick);
  const math::Ijk low = ((first.array() - kCells + kCells - 1) / kCells).max(0);
  const math::Ijk high =
      ((first.array() + kBrickEdge - 1 + 2) / kCells).min(work_->patches.array() - 1);
  for (int r = low.z(); r <= high.z(); ++r)
    for (int q = low.y(); q <= high.y(); ++q)
      for (int p = low.x(); p <= high.x(); ++p)
        out.push_back(p + work_->patches.x() * (q + work_->patches.y() * r));
}

bool Mesher::mesh_patch(int patch, Patch& out) {
  if (!work_->run(patch)) return false;
  out.vertices.assign(work_->vertex.begin(), work_->vertex.begin() + work_->vertices);
  out.triangles.assign(work_->triangle.begin(), work_->triangle.begin() + work_->indices);
  return true;
}

// ---- the whole surface

namespace {

// One patch, before it is merged into the whole.
struct Piece {
  Patch mesh;
  std::vector<std::uint16_t> key;     // (vertices) edge of the grid, ascending
  std::vector<std::uint32_t> index;   // (vertices) index in the whole
  std::uint32_t first = 0, mine = 0;  // its own vertices in the whole; others belong to neighbours
};

// A vertex in a patch's low planes belongs to the neighbour there. Entry per packed key: bit 0, 1,
// 2 is set if the owner is one patch lower along x, y, z.
using Owners = std::array<std::uint8_t, std::size_t{3} * kIds>;
const Owners& owners() {
  static const Owners table = [] {
    Owners made{};
    for (std::size_t packed = 0; packed < made.size(); ++packed) {
      const EdgeKey key = EdgeKey::unpacked(static_cast<std::uint16_t>(packed));
      made[packed] = static_cast<std::uint8_t>((key.axis != 0 && key.x == 0 ? 1 : 0) |
                                               (key.axis != 1 && key.y == 0 ? 2 : 0) |
                                               (key.axis != 2 && key.z == 0 ? 4 : 0));
    }
    return made;
  }();
  return table;
}

// Runs work(worker, i) for i in 0..count-1 on all threads; the caller is worker 0 and reports
// progress.
// False: cancelled.
template <class Each>
bool in_parallel(int count, int threads, Progress* progress, std::string_view stage,
                 const Each& each) {
  constexpr int kChunk = 16;
  std::atomic<int> next = 0;
  std::atomic<bool> stop = false;
  const auto work = [&](int worker) {
    for (;;) {
      const int first = next.fetch_add(kChunk, std::memory_order_relaxed);
      if (first >= count || stop.load(std::memory_order_relaxed)) return;
      for (int i = first; i < std::min(first + kChunk, count); ++i) each(worker, i);
      if (worker == 0 && progress != nullptr && (first / kChunk) % 16 == 0) {
        progress->report(static_cast<double>(first) / count, stage);
        if (progress->cancelled()) stop = true;
      }
    }
  };
  rt::on_threads(threads, work);
  if (progress != nullptr && !stop) progress->report(1, stage);
  return !stop;
}

}  // namespace

Result<Mesh> whole_surface(const volume::Bone& bone, int threads, Progress& progress) {
  threads = std::max(threads, 1);
  std::vector<std::unique_ptr<Mesher>> meshers;
  for (int i = 0; i < threads; ++i) meshers.push_back(std::make_unique<Mesher>(bone));
  const math::Ijk patches = meshers.front()->patches();
  const int count = patches.prod();
  const Owners& owner = owners();

  // mesh each patch separately
  std::vector<std::unique_ptr<Piece>> pieces(static_cast<std::size_t>(count));
  std::atomic<bool> at_rest = true;
  const bool done = in_parallel(count, threads, &progress, "meshing", [&](int worker, int patch) {
    Mesher::Work& work = *meshers[static_cast<std::size_t>(worker)]->work_;
    if (!work.run(patch)) at_rest = false;
    if (work.vertices == 0) return;
    auto piece = std::make_unique<Piece>();
    piece->mesh.vertices.assign(work.vertex.begin(), work.vertex.begin() + work.vertices);
    piece->mesh.triangles.assign(work.triangle.begin(), work.triangle.begin() + work.indices);
    piece->key.assign(work.key.begin(), work.key.begin() + work.vertices);
    for (const std::uint16_t key : piece->key) piece->mine += owner[key] == 0 ? 1U : 0U;
    pieces[static_cast<std::size_t>(patch)] = std::move(piece);
  });
  if (!done) return error(Trouble::interrupted, "stopped while computing the surface");
  if (!at_rest)
    return error(Trouble::internal, "the bone was cut while its whole surface was computed");

  // the place of each piece in the whole
  std::vector<int> full;
  std::size_t vertices = 0, triangles = 0;
  std::vector<std::size_t> first_index;
  for (int patch = 0; patch < count; ++patch) {
    Piece* piece = pieces[static_cast<std::size_t>(patch)].get();
    if (piece == nullptr) continue;
    full.push_back(patch);
    first_index.push_back(triangles);
    piece->first = static_cast<std::uint32_t>(vertices);
    vertices += piece->mine;
    triangles += piece->mesh.triangles.size();
    if (vertices > 0xFFFFFFFFULL)
      return error(
          "the surface has more than 4 billion vertices; use a larger `voxel_mm` or a smaller "
          "`region`");
  }
  Mesh mesh;
  mesh.vertices.resize(vertices);
  mesh.triangles.resize(triangles);

  // copy own vertices first; then the neighbours' can be looked up, then come the triangles
  const int n = static_cast<int>(full.size());
  const auto piece_at = [&](int patch) { return pieces[static_cast<std::size_t>(patch)].get(); };
  in_parallel(n, threads, nullptr, "", [&](int, int i) {
    Piece& piece = *piece_at(full[static_cast<std::size_t>(i)]);
    piece.index.resize(piece.key.size());
    std::uint32_t next = piece.first;
    for (std::size_t v = 0; v < piece.key.size(); ++v) {
      if (owner[piece.key[v]] != 0) continue;
      mesh.vertices[next] = piece.mesh.vertices[v];
      piece.index[v] = next++;
    }
  });
  in_parallel(n, threads, nullptr, "", [&](int, int i) {
    const int patch = full[static_cast<std::size_t>(i)];
    Piece& piece = *piece_at(patch);
    for (std::size_t v = 0; v < piece.key.size(); ++v) {
      const int lower = owner[piece.key[v]];
      if (lower == 0) continue;
      const math::Ijk by(lower & 1, (lower >> 1) & 1, lower >> 2);
      EdgeKey key = EdgeKey::unpacked(piece.key[v]);
      key.x += kCells * by.x();
      key.y += kCells * by.y();
      key.z += kCells * by.z();
      const Piece* from = piece_at(patch - by.x() - patches.x() * (by.y() + patches.y() * by.z()));
      BURR_CHECK(from != nullptr);
      const auto found = std::lower_bound(from->key.begin(), from->key.end(), key.packed());
      BURR_CHECK(found != from->key.end() && *found == key.packed());
      piece.index[v] = from->index[static_cast<std::size_t>(found - from->key.begin())];
    }
    std::uint32_t* out = &mesh.triangles[first_index[static_cast<std::size_t>(i)]];
    for (const std::uint32_t v : piece.mesh.triangles) *out++ = piece.index[v];
  });
  return mesh;
}

}  // namespace burr::surface
