// A mesh from behind the fence: what the reader answered is checked here.
#include "burr/io/read/read_mesh.h"

#include <unistd.h>

#include <cmath>
#include <cstddef>

#include "burr/base/progress.h"
#include "burr/io/sandbox/fence_asker.h"

namespace burr::io {
namespace {

// Fills `to` from `at` of the loan, which is as large as said.
template <class T>
bool copied(const FenceAsker::Loan& loan, std::uint64_t at, std::vector<T>& to) {
  auto* place = reinterpret_cast<std::byte*>(to.data());
  std::size_t left = to.size() * sizeof(T);
  while (left > 0) {
    const ssize_t got = ::pread(loan.memory.get(), place, left, static_cast<off_t>(at));
    if (got <= 0) return false;
    place += got;
    at += static_cast<std::uint64_t>(got);
    left -= static_cast<std::size_t>(got);
  }
  return true;
}

bool sound(const TriangleMesh& mesh) {
  for (const auto& point : mesh.points)
    for (const float x : point)
      if (!std::isfinite(x)) return false;
  for (const auto& [a, b, c] : mesh.faces)
    if (a >= mesh.points.size() || b >= mesh.points.size() || c >= mesh.points.size()) return false;
  return true;
}

}  // namespace

Result<TriangleMesh> read_mesh(const std::string& path) {
  NoProgress nobody;
  FenceAsker asker(path);
  if (Status status = asker.ask({.path = path, .options = {}, .mesh = true}, nobody); !status)
    return status.error();
  const FenceMessage& last = asker.last();
  TriangleMesh mesh;
  if (last.kind != FenceMessage::mesh) {
    const std::vector<std::uint8_t> letter = asker.letter();
    FenceOutcome outcome;
    if (letter.empty() || !unpack(letter, outcome) || outcome.scan.ok()) return asker.lies();
    return outcome.scan.error();
  }
  const FenceAsker::Loan* loan = asker.loan(last.loan);
  const bool counted = last.value >= 1 && last.value <= double{kMostTriangles} && last.bytes >= 3 &&
                       last.bytes <= 3 * kMostTriangles;
  if (loan == nullptr || !counted) return asker.lies();
  mesh.points.resize(static_cast<std::size_t>(last.bytes));
  mesh.faces.resize(static_cast<std::size_t>(last.value));
  const std::uint64_t faces_at = mesh.points.size() * sizeof mesh.points[0];
  if (!copied(*loan, 0, mesh.points) || !copied(*loan, faces_at, mesh.faces) || !sound(mesh))
    return asker.lies();
  return mesh;
}

}  // namespace burr::io
