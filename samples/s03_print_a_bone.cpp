// s03_print_a_bone - makes a mesh for a 3D printer from a bone: a ring, meshed, measured, written
// as STL.
#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "burr/base/progress.h"
#include "burr/io/write/write_mesh.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/surface/mesher.h"
#include "burr/volume/volume_of.h"

int main() {
  using namespace burr;
  const double ring = 10e-3, tube = 3e-3;  // [m]
  const auto bone =
      phantom::bone_from_distance(phantom::cube_grid(30e-3, 100), {}, phantom::torus(ring, tube));

  NoProgress quiet;
  const auto mesh = surface::whole_surface(*bone, 2, quiet);
  if (!mesh) {
    fmt::print("{}\n", mesh.error().text);
    return 1;
  }
  // volume inside the triangles, by Gauss's theorem
  double inside = 0;
  const auto& points = mesh->vertices;
  for (std::size_t t = 0; t < mesh->triangles.size(); t += 3) {
    const math::Vec3 a = points[mesh->triangles[t]].p.cast<double>(),
                     b = points[mesh->triangles[t + 1]].p.cast<double>(),
                     c = points[mesh->triangles[t + 2]].p.cast<double>();
    inside += a.dot(b.cross(c)) / 6;
  }
  const double truth = 2 * std::pow(std::numbers::pi, 2) * ring * tube * tube;
  fmt::print("ring of {:.2f} mm3: field says {:.2f}, mesh of {} triangles says {:.2f}\n",
             truth * 1e9, volume::volume_of(*bone) * 1e9, mesh->triangles.size() / 3, inside * 1e9);

  const Status written =
      io::write_mesh(*mesh, bone->tissues(), "ring.stl", io::Frame::print, quiet);
  fmt::print("{}\n", written ? "ring.stl written" : written.error().text);
  return written && std::abs(inside / truth - 1) < 0.005 ? 0 : 1;
}
