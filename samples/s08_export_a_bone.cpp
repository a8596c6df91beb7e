// s08_export_a_bone - a bone becomes a mesh for a printer: a ring, written as STL and read back.
//
// Prints the volume by formula, by the field and by the triangles of the file, and compares.
#include <burr/base/progress.h>
#include <burr/io/export_part.h>
#include <burr/phantom/build.h>
#include <burr/phantom/shapes.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <numbers>

namespace {

// Volume inside the triangles of a binary STL file, by Gauss' theorem [mm^3].
double volume_of_stl(const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::uint32_t triangles = 0;
  file.seekg(80);  // header
  file.read(reinterpret_cast<char*>(&triangles), sizeof triangles);
  double six_volumes = 0;
  for (std::uint32_t t = 0; t < triangles && file; ++t) {
    float normal_and_corners[12];
    file.read(reinterpret_cast<char*>(normal_and_corners), sizeof normal_and_corners);
    file.seekg(2, std::ios::cur);  // attribute
    const auto corner = [&](int n) {
      const float* at = normal_and_corners + 3 + 3 * n;
      return burr::math::Vec3(at[0], at[1], at[2]);
    };
    six_volumes += corner(0).dot(corner(1).cross(corner(2)));
  }
  return file ? six_volumes / 6 : 0;
}

}  // namespace

int main() {
  using namespace burr;
  const double ring = 10e-3, tube = 3e-3;  // [m]
  const auto bone =
      phantom::bone_from_distance(phantom::cube_grid(30e-3, 100), {}, phantom::torus(ring, tube));

  NoProgress quiet;
  const auto written =
      io::export_part(*bone, *bone, "ring.stl", {.frame = io::Frame::print}, quiet);
  if (!written) {
    std::printf("%s\n", written.error().text.c_str());
    return 1;
  }
  const double truth = 2 * std::pow(std::numbers::pi, 2) * ring * tube * tube * 1e9;  // [mm^3]
  const double inside = volume_of_stl("ring.stl");
  std::printf("ring of %.2f mm3: the field says %.2f, the %zu triangles of ring.stl say %.2f\n",
              truth, written->volume * 1e9, written->triangles, inside);
  return std::abs(inside / truth - 1) < 0.005 ? 0 : 1;
}
