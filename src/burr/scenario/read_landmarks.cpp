// [[landmark]] and [[region]] of a case.
#include <cmath>
#include <numbers>

#include "burr/scenario/read_lesson.h"
#include "burr/scenario/read_texts.h"

namespace burr::scenario {
namespace {

constexpr double kMm = 1e-3;
constexpr double kLargest = 500;  // of a radius or an edge [mm]

void read_landmark(Reader& reader, Landmark& out) {
  reader.only({"name", "title", "at_mm", "points_mm", "normal"});
  out.line = reader.line();
  reader.text("name", out.name, true);
  read_texts(reader, "title", out.title);
  std::optional<math::Vec3> at;
  reader.vector("at_mm", at);
  reader.vectors("points_mm", out.points);
  if (at) out.points.insert(out.points.begin(), *at);
  for (math::Vec3& point : out.points) point *= kMm;
  const bool names_only = !at && !reader.has("points_mm") && !out.title.empty();
  if (at.has_value() == reader.has("points_mm") && !names_only)
    reader.fail("at_mm",
                "give at_mm = [x, y, z] for a point, points_mm for a curve, or a title for a "
                "landmark of the bone");
  if (reader.has("points_mm") && out.points.size() < 2)
    reader.fail("points_mm", "must have at least two points; use at_mm for one");
  reader.vector("normal", out.normal);
  if (!out.normal) return;
  if (out.normal->norm() < 1e-6) return reader.fail("normal", "must be a direction, not [0, 0, 0]");
  if (!at) return reader.fail("normal", "belongs to a plane; give at_mm, a point in it");
  out.normal->normalize();
}

// [x, y, z] in mm, or the name of a landmark
void read_place(Reader& reader, std::string_view key, Place& out) {
  if (!reader.has(key)) return reader.fail(key, "is missing; give [x, y, z] or a landmark's name");
  if (reader.is_text(key)) return reader.text(key, out.landmark);
  std::optional<math::Vec3> at;
  reader.vector(key, at);
  if (at) out.at = *at * kMm;
}

void read_length(Reader& reader, std::string_view key, double& out) {
  double mm = 0;
  reader.number(key, mm, 0, kLargest, true);
  out = mm * kMm;
}

void read_tube(Reader& reader, Shape& out) {
  reader.text("along", out.curve);
  reader.vectors("points_mm", out.points);
  for (math::Vec3& point : out.points) point *= kMm;
  if (out.curve.empty() == out.points.empty())
    reader.fail("along", "give along = \"CURVE\", a landmark, or points_mm");
  if (!out.points.empty() && out.points.size() < 2)
    reader.fail("points_mm", "must have at least two points");
  read_length(reader, "radius_mm", out.radius);
  reader.number("from", out.from, -1e-9, 1);
  reader.number("to", out.to, 0, 1);
  if (out.from >= out.to) reader.fail("from", "must be below \"to\"; both are parts of the length");
}

void read_shape(Reader& reader, Shape& out) {
  using Kind = ShapeKind;
  out.line = reader.line();
  reader.choice<Kind>("shape", out.kind,
                      {{"ball", Kind::ball},
                       {"capsule", Kind::capsule},
                       {"box", Kind::box},
                       {"half-space", Kind::half_space},
                       {"tube", Kind::tube},
                       {"within", Kind::within},
                       {"between", Kind::between}},
                      true);
  switch (out.kind) {
    case Kind::ball:
      reader.only({"shape", "at", "radius_mm"});
      read_place(reader, "at", out.a);
      return read_length(reader, "radius_mm", out.radius);
    case Kind::capsule:
      reader.only({"shape", "from", "to", "radius_mm"});
      read_place(reader, "from", out.a);
      read_place(reader, "to", out.b);
      return read_length(reader, "radius_mm", out.radius);
    case Kind::box: {
      reader.only({"shape", "at", "size_mm"});
      read_place(reader, "at", out.a);
      std::optional<math::Vec3> size;
      reader.vector("size_mm", size);
      if (!size || !(size->minCoeff() > 0))
        return reader.fail("size_mm", "must be the three edges, each above 0, [10, 10, 5]");
      out.size = *size * kMm;
      return;
    }
    case Kind::half_space: {
      reader.only({"shape", "at", "normal"});
      read_place(reader, "at", out.a);
      std::optional<math::Vec3> normal;
      reader.vector("normal", normal);
      if (!normal || normal->norm() < 1e-6)
        return reader.fail("normal", "must be the direction into the half-space, not [0, 0, 0]");
      out.normal = normal->normalized();
      return;
    }
    case Kind::tube:
      reader.only({"shape", "along", "points_mm", "radius_mm", "from", "to"});
      return read_tube(reader, out);
    case Kind::within:
      reader.only({"shape", "structure", "radius_mm"});
      reader.text("structure", out.structure, true);
      return read_length(reader, "radius_mm", out.radius);
    case Kind::between:
      reader.only({"shape", "structure", "other", "radius_mm"});
      reader.text("structure", out.structure, true);
      reader.text("other", out.other, true);
      return read_length(reader, "radius_mm", out.radius);
  }
}

// Where the case wants a piece.
void read_piece(Reader& reader, PlannedPiece& out) {
  constexpr double kFarthest = 200, kRound = 180;  // [mm], [degrees]
  reader.only({"title", "near", "by_mm", "turn_deg"});
  out.line = reader.line();
  read_texts(reader, "title", out.title);
  read_place(reader, "near", out.near);
  std::optional<math::Vec3> by, turn;
  reader.vector("by_mm", by);
  reader.vector("turn_deg", turn);
  if (!by && !turn)
    return reader.fail("by_mm",
                       "is missing; give by_mm = [x, y, z], turn_deg = [x, y, z], or both");
  if (by && !(by->norm() <= kFarthest))
    return reader.fail("by_mm", "must not be longer than 200 mm");
  if (turn && !(turn->norm() <= kRound))
    return reader.fail("turn_deg",
                       "is an axis as long as the angle, and must not be longer than 180 degrees");
  if (by) out.by = *by * kMm;
  if (turn) out.turn = *turn * (std::numbers::pi / kRound);
}

}  // namespace

void read_pieces(Reader& reader, CaseLesson& out) {
  reader.each("piece", [&](Reader& inner) { read_piece(inner, out.pieces.emplace_back()); });
}

void read_landmarks(Reader& reader, CaseLesson& out) {
  reader.each("landmark",
              [&](Reader& inner) { read_landmark(inner, out.landmarks.emplace_back()); });
}

void read_regions(Reader& reader, CaseLesson& out) {
  reader.each("region", [&](Reader& inner) {
    CaseRegion& region = out.regions.emplace_back();
    region.line = inner.line();
    inner.only({"name", "title", "add", "take"});
    inner.text("name", region.name, true);
    read_texts(inner, "title", region.title);
    inner.each("add", [&](Reader& shape) { read_shape(shape, region.add.emplace_back()); });
    inner.each("take", [&](Reader& shape) { read_shape(shape, region.take.emplace_back()); });
    if (region.add.empty())
      inner.fail("add", "is missing; give at least one shape, add = [{ shape = \"ball\", ... }]");
  });
}

}  // namespace burr::scenario
