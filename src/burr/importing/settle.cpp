#include "burr/importing/settle.h"

#include <array>
#include <bit>

namespace burr::importing {
namespace {

using volume::Field;

constexpr int kMiddle = 13;

// The neighbourhood as masks of 27 bits.
struct Masks {
  std::uint32_t faces = 0, edges = 0, all = 0;       // of the middle, without it
  std::array<std::uint32_t, 27> over_faces{};        // neighbours over a face
  std::array<std::uint32_t, 27> over_faces_edges{};  // over a face or an edge
};

constexpr Masks make_masks() {
  Masks m;
  for (int a = 0; a < 27; ++a)
    for (int b = 0; b < 27; ++b) {
      const int dx = a % 3 - b % 3, dy = a / 3 % 3 - b / 3 % 3, dz = a / 9 - b / 9;
      const int square = dx * dx + dy * dy + dz * dz;
      const bool near = dx >= -1 && dx <= 1 && dy >= -1 && dy <= 1 && dz >= -1 && dz <= 1;
      if (!near || square == 0) continue;
      const std::uint32_t bit = 1U << b;
      const auto at = static_cast<std::size_t>(a);
      if (square == 1) m.over_faces[at] |= bit;
      if (square <= 2) m.over_faces_edges[at] |= bit;
    }
  m.faces = m.over_faces[kMiddle];
  m.edges = m.over_faces_edges[kMiddle] & ~m.faces;
  m.all = ((1U << 27) - 1U) & ~(1U << kMiddle);
  return m;
}

constexpr Masks kMasks = make_masks();

// What is reached from `from` within `among`.
std::uint32_t reached(std::uint32_t from, std::uint32_t among,
                      const std::array<std::uint32_t, 27>& beside) {
  std::uint32_t found = from & among, fresh = found;
  while (fresh != 0) {
    const auto one = static_cast<std::size_t>(std::countr_zero(fresh));
    fresh &= fresh - 1;
    const std::uint32_t more = beside[one] & among & ~found;
    found |= more;
    fresh |= more;
  }
  return found;
}

// The neighbours of all voxels of a set.
std::uint32_t beside(std::uint32_t set, const std::array<std::uint32_t, 27>& of_one) {
  std::uint32_t found = 0;
  for (; set != 0; set &= set - 1) found |= of_one[static_cast<std::size_t>(std::countr_zero(set))];
  return found;
}

std::uint32_t lowest(std::uint32_t set) { return set & (~set + 1U); }

// Reads the bone where it is now.
class Sides {
 public:
  explicit Sides(const volume::Bone& bone) : bone_(bone) {}
  // bit x + 3 y + 9 z of the 27 voxels around this one
  [[nodiscard]] std::uint32_t around(const math::Ijk& v) const {
    std::uint32_t inside = 0;
    for (int z = 0, n = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x, ++n)
          if (bone_.field(v.x() + x - 1, v.y() + y - 1, v.z() + z - 1) >= volume::kIso)
            inside |= 1U << n;
    return inside;
  }

 private:
  const volume::Bone& bone_;
};

}  // namespace

bool is_simple(std::uint32_t inside) {
  // (6+, 18): pieces of bone that touch the middle over a face. They are one where they meet within three
  // steps, from a face over an edge to a corner; a longer way round leaves a hole.
  const std::uint32_t bone = inside & kMasks.all, faces = bone & kMasks.faces;
  if (faces == 0) return false;  // a grain of its own
  const std::uint32_t edges = bone & kMasks.edges & beside(faces, kMasks.over_faces),
                      corners =
                          bone & ~kMasks.edges & ~kMasks.faces & beside(edges, kMasks.over_faces);
  if ((faces & ~reached(lowest(faces), faces | edges | corners, kMasks.over_faces)) != 0)
    return false;
  // pieces of air that touch it over a face or an edge; air reaches over the corners too
  const std::uint32_t air = ~inside & kMasks.all, sides = air & (kMasks.faces | kMasks.edges);
  if (sides == 0) return false;  // a cavity of its own
  return (sides & ~reached(lowest(sides), air, kMasks.over_faces_edges)) == 0;
}

void settle(volume::Bone& bone, const std::vector<Flip>& flips) {
  const Sides sides(bone);
  // First what leaves the bone: the last voxel of a part is no simple point, so of each part at least
  // one voxel stays where it was.
  for (const bool leaves : {true, false})
    for (const Flip& flip : flips) {
      if ((flip.field < volume::kIso) != leaves || !is_simple(sides.around(flip.voxel))) continue;
      const math::Ijk brick = flip.voxel / volume::kBrickEdge,
                      in = flip.voxel - brick * volume::kBrickEdge;
      Field* field = bone.build_field(bone.brick_at(brick.x(), brick.y(), brick.z()));
      field[in.x() + volume::kBrickEdge * (in.y() + volume::kBrickEdge * in.z())] = flip.field;
    }
}

}  // namespace burr::importing
