// STL, OBJ and PLY of a tool: the first byte chooses.
#include <algorithm>
#include <cmath>

#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  fuzz::Pieces pieces({data, size});
  const std::uint8_t which = pieces.byte();
  const std::string_view bytes = fuzz::text_of(pieces.rest());
  const auto mesh = which == 's'   ? io::read_stl(bytes)
                    : which == 'o' ? io::read_obj(bytes)
                                   : io::read_ply(bytes);
  fuzz::look_at_error(mesh);
  if (!mesh) return 0;
  fuzz::must(mesh->faces.size() <= io::kMostTriangles, "a mesh is within its limits");
  for (const auto& point : mesh->points)
    fuzz::must(std::all_of(point.begin(), point.end(), [](float x) { return std::isfinite(x); }),
               "a mesh has places");
  for (const auto& [a, b, c] : mesh->faces)
    fuzz::must(std::max({a, b, c}) < mesh->points.size() && a != b && b != c && c != a,
               "a face has three corners of the mesh");
  return 0;
}
