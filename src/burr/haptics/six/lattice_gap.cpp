#include "burr/haptics/six/lattice_gap.h"

#include <algorithm>
#include <cstddef>

#include "burr/math/sums.h"
#include "burr/math/turn.h"
#include "burr/tool/shape_grid.h"

namespace burr::haptics {
namespace {

using math::Quat;
using math::Vec3;
using tool::GridPoints;

// The points of a lattice against a part.
class Look {
 public:
  Look(const PartPlace& lattice, const PartPlace& part) BURR_RT
      : part_(part),
        points_(tool::points_of(*lattice.shape.grid)),
        cell_(lattice.shape.a),
        to_part_(math::product(part.turn.conjugate(), lattice.turn)),
        offset_(part.turn.conjugate() * Vec3(lattice.middle - part.middle)) {}

  // use(place in the part's frame, distance there), for all points nearer than within().
  template <class Within, class Use>
  void each(const Within& within, const Use& use) const BURR_RT {
    for (const GridPoints::Block& group : points_.groups) {
      if (far(group) > within()) continue;
      for (int b = group.first; b < group.first + group.count; ++b) {
        const GridPoints::Block& block = points_.blocks[static_cast<std::size_t>(b)];
        if (far(block) > within()) continue;
        for (int n = block.first; n < block.first + block.count; ++n) {
          const Vec3 y = place(points_.points[static_cast<std::size_t>(n)]);
          const tool::Distance there = tool::distance(part_.shape, y);
          if (there.phi < within()) use(y, there);
        }
      }
    }
  }

 private:
  [[nodiscard]] Vec3 place(const Vec3& p) const BURR_RT {
    return to_part_ * Vec3(cell_ * p) + offset_;
  }
  // No point of it is nearer. A lattice's distance may change up to sqrt(3) times as fast as one goes.
  [[nodiscard]] double far(const GridPoints::Block& block) const BURR_RT {
    const double steepest = part_.shape.kind == tool::ShapeKind::grid ? 1.7320508075688774 : 1;
    return tool::distance(part_.shape, place(block.middle)).phi - steepest * cell_ * block.radius -
           1e-9;
  }

  const PartPlace& part_;
  const GridPoints& points_;
  double cell_;
  Quat to_part_;
  Vec3 offset_;
};

bool is_lattice(const PartPlace& part) BURR_RT { return part.shape.kind == tool::ShapeKind::grid; }

}  // namespace

int lattice_gaps(const PartPlace& a, const PartPlace& b, double within,
                 std::span<PartGap> out) BURR_RT {
  std::size_t count = 0;
  const auto look = [&](const PartPlace& lattice, const PartPlace& part,
                        bool lattice_is_a) BURR_RT {
    Look(lattice, part)
        .each([within]() BURR_RT { return within; },
              [&](const Vec3& y, const tool::Distance& there) BURR_RT {
                if (count++ >= out.size()) return;
                const Vec3 way = part.turn * there.gradient;  // from the part to the point
                const Vec3 point = part.middle + part.turn * y, on_part = point - there.phi * way;
                PartGap& gap = out[count - 1];
                gap.gap = there.phi;
                gap.normal = lattice_is_a ? way : Vec3(-way);
                gap.a = lattice_is_a ? point : on_part;
                gap.b = lattice_is_a ? on_part : point;
              });
  };
  if (is_lattice(a)) look(a, b, true);
  if (is_lattice(b)) look(b, a, false);
  return static_cast<int>(count);
}

double lattice_gap(const PartPlace& a, const PartPlace& b, double below) BURR_RT {
  double least = below;
  const auto look = [&least](const PartPlace& lattice, const PartPlace& part) BURR_RT {
    const Vec3 middle = lattice.turn.conjugate() * Vec3(part.middle - lattice.middle);
    const double inside = tool::distance(lattice.shape, middle).phi;
    if (inside < 0) least = std::min(least, inside);
    Look(lattice, part)
        .each([&least]() BURR_RT { return least; },
              [&least](const Vec3&, const tool::Distance& there)
                  BURR_RT { least = std::min(least, there.phi); });
  };
  if (is_lattice(a)) look(a, b);
  if (is_lattice(b)) look(b, a);
  return least;
}

}  // namespace burr::haptics
