#include "burr/io/read/polygon.h"

#include <cmath>

#include "burr/math/vec3.h"

namespace burr::io {
namespace {

struct Flat {
  double x, y;
};

double twice_area(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners in the plane of their face, counter-clockwise.
std::vector<Flat> flattened(std::span<const std::array<float, 3>> corners) {
  const auto at = [&](std::size_t n) {
    const auto& p = corners[n % corners.size()];
    return math::Vec3(p[0], p[1], p[2]);
  };
  math::Vec3 normal = math::Vec3::Zero();  // Newell's
  for (std::size_t n = 1; n + 1 < corners.size(); ++n)
    normal += (at(n) - at(0)).cross(at(n + 1) - at(0));
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double turn = normal[axis] < 0 ? -1 : 1;
  std::vector<Flat> flat;
  flat.reserve(corners.size());
  for (const auto& p : corners)
    flat.push_back(
        {turn * double{p[static_cast<std::size_t>(u)]}, double{p[static_cast<std::size_t>(v)]}});
  return flat;
}

bool is_ear(const std::vector<Flat>& flat, const std::vector<std::size_t>& left, std::size_t n) {
  const std::size_t before = left[(n + left.size() - 1) % left.size()], here = left[n],
                    after = left[(n + 1) % left.size()];
  const Flat &a = flat[before], &b = flat[here], &c = flat[after];
  if (!(twice_area(a, b, c) > 0)) return false;
  for (const std::size_t other : left) {
    if (other == before || other == here || other == after) continue;
    const Flat& p = flat[other];
    if (twice_area(a, b, p) >= 0 && twice_area(b, c, p) >= 0 && twice_area(c, a, p) >= 0)
      return false;
  }
  return true;
}

bool convex(const std::vector<Flat>& flat) {
  const std::size_t count = flat.size();
  for (std::size_t n = 0; n < count; ++n)
    if (!(twice_area(flat[n], flat[(n + 1) % count], flat[(n + 2) % count]) > 0)) return false;
  return true;
}

}  // namespace

std::vector<std::array<std::size_t, 3>> triangles_of(
    std::span<const std::array<float, 3>> corners) {
  std::vector<std::array<std::size_t, 3>> out;
  out.reserve(corners.size() - 2);
  std::vector<std::size_t> left(corners.size());
  for (std::size_t n = 0; n < left.size(); ++n) left[n] = n;
  if (left.size() > 3) {
    const std::vector<Flat> flat = flattened(corners);
    std::size_t looked = convex(flat) ? left.size() : 0;  // corners in a row that are no ear
    for (std::size_t n = 0; left.size() > 3 && looked < left.size();) {
      n %= left.size();
      if (!is_ear(flat, left, n)) {
        ++n;
        ++looked;
        continue;
      }
      out.push_back(
          {left[(n + left.size() - 1) % left.size()], left[n], left[(n + 1) % left.size()]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(n));
      looked = 0;
    }
  }
  for (std::size_t n = 1; n + 1 < left.size(); ++n) out.push_back({left[0], left[n], left[n + 1]});
  return out;
}

}  // namespace burr::io
