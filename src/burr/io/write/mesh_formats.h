// io/write/mesh_formats.h - one function per mesh format, for write_mesh.cpp only.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/write/mesh_frame.h"
#include "burr/surface/patch.h"
#include "burr/volume/tissue.h"

namespace burr::io {

// A mesh to be written: positions in millimetres in the file's frame.
struct MeshOut {
  const surface::Mesh& mesh;
  const volume::TissueTable& tissues;
  std::vector<math::Vec3f> p_mm;  // (vertices)
  Eigen::Matrix3f turn;           // for normals, from LPS
  Frame frame = Frame::lps;

  [[nodiscard]] math::Vec3f normal(std::size_t vertex) const {
    return turn * mesh.vertices[vertex].n;
  }
  [[nodiscard]] std::array<std::uint8_t, 3> colour(std::size_t vertex) const;  // sRGB
  [[nodiscard]] const char* mark() const;  // "SPACE=LPS", or "" in frame print
};

// 0..255
[[nodiscard]] std::array<std::uint8_t, 3> bytes_of(const std::array<float, 3>& colour);

// Reports progress every 64k items; false: stop.
[[nodiscard]] bool go_on(Progress& progress, std::size_t done, std::size_t of);
[[nodiscard]] Error stopped_writing(const std::string& path);

Status write_stl(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress);
Status write_ply(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress);
Status write_obj(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress);
Status write_3mf(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress);
Status write_glb(const MeshOut& out, base::NewFile& file, const std::string& path,
                 Progress& progress);

}  // namespace burr::io
