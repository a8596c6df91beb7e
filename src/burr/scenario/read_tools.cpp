#include "burr/scenario/read_tools.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <utility>

#include "burr/base/check.h"
#include "burr/base/printable.h"
#include "burr/base/text_file.h"
#include "burr/scenario/rack_text.h"
#include "burr/scenario/read_texts.h"
#include "burr/scenario/toml_reader.h"

namespace burr::scenario {
namespace {

using math::Vec3;
using tool::Drive;
using tool::Role;
using tool::ShapeKind;

constexpr std::uintmax_t kLargestFile = 1U << 20;  // [byte]
constexpr double kFastest = 500'000;               // turbines reach this [1/min]
constexpr double kLargest = 200;                   // of any size in the file [mm]
constexpr double kMm = 1e-3;

// The sizes of a part as a person gives them.
struct Sizes {
  double diameter_mm = 0, behind_mm = -1, length_mm = 0, edge_mm = 0, width_mm = 0,
         half_angle_deg = 0, height_mm = -1, inner_mm = 0;
  std::optional<Vec3> size_mm;
  std::optional<double> from_mm, to_mm;
};

void read_optional(Reader& reader, std::string_view key, std::optional<double>& out) {
  if (!reader.has(key)) return;
  double value = 0;
  reader.number(key, value, -kLargest, kLargest, true);
  out = value;
}

// A cylinder, a frustum or a tube: the outer sizes less the rounding of the edge.
tool::Shape round_shape(ShapeKind kind, const Sizes& in) {
  const double edge = kMm * in.edge_mm;
  tool::Shape shape;
  shape.kind = kind;
  shape.rounding = edge;
  shape.a = 0.5 * kMm * in.diameter_mm - edge;
  shape.c = 0.5 * kMm * in.length_mm - edge;
  if (kind == ShapeKind::frustum) shape.b = 0.5 * kMm * in.behind_mm - edge;
  if (kind == ShapeKind::tube) shape.b = 0.5 * kMm * in.inner_mm + edge;
  return shape;
}

tool::Shape box_shape(const Sizes& in) {
  const double edge = kMm * in.edge_mm;
  const Vec3 half = 0.5 * kMm * *in.size_mm - Vec3::Constant(edge);
  return {ShapeKind::box, half.x(), half.y(), half.z(), edge};
}

// Its edge is at z = 0 of the part.
tool::Shape wedge_shape(const Sizes& in) {
  const double edge = kMm * in.edge_mm, length = kMm * in.length_mm;
  return {ShapeKind::wedge, length * std::tan(in.half_angle_deg * std::numbers::pi / 180),
          0.5 * kMm * in.width_mm - edge, length, edge};
}

const struct {
  std::string_view word;
  ShapeKind kind;
  std::vector<std::string_view> fields;
} kShapes[] = {
    {"ball", ShapeKind::ball, {"diameter_mm"}},
    {"capsule", ShapeKind::capsule, {"diameter_mm", "from_mm", "to_mm"}},
    {"cylinder", ShapeKind::cylinder, {"diameter_mm", "length_mm", "edge_mm", "from_mm", "to_mm"}},
    {"cone",
     ShapeKind::frustum,
     {"diameter_mm", "diameter_behind_mm", "length_mm", "edge_mm", "from_mm", "to_mm"}},
    {"flame", ShapeKind::vesica, {"diameter_mm", "length_mm", "edge_mm"}},
    {"box", ShapeKind::box, {"size_mm", "edge_mm"}},
    {"wedge", ShapeKind::wedge, {"half_angle_deg", "width_mm", "length_mm", "edge_mm"}},
    {"tube",
     ShapeKind::tube,
     {"diameter_mm", "inner_mm", "length_mm", "edge_mm", "from_mm", "to_mm"}},
    {"half shell", ShapeKind::half_shell, {"diameter_mm", "height_mm", "edge_mm"}},
    {"mesh", ShapeKind::grid, {"file", "mm_per_unit", "cell_mm"}},
};

// Where the meshes of a file come from.
struct Meshes {
  const MeshReader& read;
  const std::string& folder;
  bool turn = false;  // the tool that they belong to turns
};

std::optional<std::size_t> shape_named(Reader& reader) {
  std::string word, list;
  reader.text("shape", word, true);
  if (reader.failed()) return std::nullopt;
  for (std::size_t n = 0; n < std::size(kShapes); ++n) {
    if (kShapes[n].word == word) return n;
    list += (n == 0 ? "" : ", ") + std::string(kShapes[n].word);
  }
  reader.fail("shape",
              fmt::format("\"{}\" is not known; use one of {}", base::printable(word), list));
  return std::nullopt;
}

void read_sizes(Reader& reader, ShapeKind kind, Sizes& in) {
  const auto size = [&](std::string_view key, double& out, bool needed) {
    reader.number(key, out, 0, kLargest, needed);
  };
  if (kind != ShapeKind::box && kind != ShapeKind::wedge) size("diameter_mm", in.diameter_mm, true);
  size("edge_mm", in.edge_mm, false);
  read_optional(reader, "from_mm", in.from_mm);
  read_optional(reader, "to_mm", in.to_mm);
  if (in.from_mm.has_value() != in.to_mm.has_value())
    return reader.fail(in.from_mm ? "from_mm" : "to_mm", "needs the other end too: from_mm, to_mm");
  if (in.from_mm && !(*in.to_mm > *in.from_mm))
    return reader.fail("to_mm", "must be above from_mm");
  const bool along = in.from_mm.has_value();
  if (along) in.length_mm = *in.to_mm - *in.from_mm;
  if (kind == ShapeKind::capsule && !along)
    return reader.fail("from_mm", "is missing; give the ends of the axis, from_mm and to_mm");
  const bool has_length = kind == ShapeKind::cylinder || kind == ShapeKind::frustum ||
                          kind == ShapeKind::vesica || kind == ShapeKind::wedge ||
                          kind == ShapeKind::tube;
  if (has_length && !along) size("length_mm", in.length_mm, true);
  if (along && reader.has("length_mm"))
    return reader.fail("length_mm", "is given twice; leave it out where from_mm and to_mm are");
  if (kind == ShapeKind::frustum) size("diameter_behind_mm", in.behind_mm, true);
  if (kind == ShapeKind::tube) size("inner_mm", in.inner_mm, true);
  if (kind == ShapeKind::wedge) {
    size("width_mm", in.width_mm, true);
    reader.number("half_angle_deg", in.half_angle_deg, 0, 60, true);
  }
  if (kind == ShapeKind::half_shell)
    reader.number("height_mm", in.height_mm, -kLargest, kLargest, true);
  if (kind == ShapeKind::box) {
    reader.vector("size_mm", in.size_mm);
    if (!in.size_mm) reader.fail("size_mm", "is missing; give [x, y, z]");
  }
}

tool::Shape shape_of(ShapeKind kind, const Sizes& in) {
  const double edge = kMm * in.edge_mm;
  switch (kind) {
    case ShapeKind::ball:
      return {kind, 0, 0, 0, 0.5 * kMm * in.diameter_mm};
    case ShapeKind::capsule:
      return {kind, 0, 0, 0.5 * kMm * in.length_mm, 0.5 * kMm * in.diameter_mm};
    case ShapeKind::cylinder:
    case ShapeKind::frustum:
    case ShapeKind::tube:
      return round_shape(kind, in);
    case ShapeKind::vesica:
      return {kind, 0.5 * kMm * in.diameter_mm - edge, 0, 0.5 * kMm * in.length_mm - edge, edge};
    case ShapeKind::box:
      return box_shape(in);
    case ShapeKind::wedge:
      return wedge_shape(in);
    case ShapeKind::half_shell:
    case ShapeKind::grid:  // read_mesh_part()
      break;
  }
  return {kind, 0.5 * kMm * in.diameter_mm - edge, kMm * in.height_mm, 0, edge};
}

void read_mesh_part(Reader& reader, const Meshes& meshes, tool::Part& part) {
  std::string file;
  reader.text("file", file, true);
  MeshWish wish;
  double mm_per_unit = 1, cell_mm = 0;
  reader.number("mm_per_unit", mm_per_unit, 1e-3, 1e3);
  reader.number("cell_mm", cell_mm, 0.01, 10);
  if (reader.failed()) return;
  wish.path = (std::filesystem::path(meshes.folder) / file).string();
  wish.m_per_unit = kMm * mm_per_unit;
  wish.cell_m = kMm * cell_mm;
  wish.turns = meshes.turn;
  if (!meshes.read) return reader.fail("shape", "\"mesh\" is not possible here");
  const auto made = meshes.read(wish);
  if (!made) return reader.fail("file", made.error().text);
  part.shape = made->shape;
  part.tool_from_part.p = made->middle;
}

void read_part(Reader& reader, const Meshes& meshes, tool::Tool& out) {
  const auto which = shape_named(reader);
  if (!which) return;
  const ShapeKind kind = kShapes[*which].kind;
  std::vector<std::string_view> known = {"shape", "role", "at_mm"};
  known.insert(known.end(), kShapes[*which].fields.begin(), kShapes[*which].fields.end());
  reader.only(known);
  tool::Part part;
  reader.choice<Role>("role", part.role,
                      {{"cuts", Role::cuts}, {"rubs", Role::rubs}, {"seen", Role::seen}}, true);
  Sizes in;
  if (kind == ShapeKind::grid)
    read_mesh_part(reader, meshes, part);
  else
    read_sizes(reader, kind, in);
  std::optional<Vec3> at;
  reader.vector("at_mm", at);
  if (reader.failed()) return;
  if (kind != ShapeKind::grid) part.shape = shape_of(kind, in);
  if (at) part.tool_from_part.p += kMm * *at;
  if (in.from_mm) part.tool_from_part.p.z() += 0.5 * kMm * (*in.from_mm + *in.to_mm);
  if (!tool::is_body(part.shape))
    return reader.fail("shape",
                       "has no body: edge_mm must be less than half of each size, a flame longer "
                       "than it is wide, and a tube's inner_mm less than its diameter_mm");
  if (!tool::add_part(out, part))
    reader.fail("shape",
                fmt::format("is one part too many; a tool has at most {}", tool::Tool::kMostParts));
}

void read_drive(Reader& reader, tool::Cutter& out) {
  reader.choice<Drive>("drive", out.drive,
                       {{"turning", Drive::turning},
                        {"oscillating", Drive::oscillating},
                        {"reciprocating", Drive::reciprocating},
                        {"pushed", Drive::pushed},
                        {"struck", Drive::struck}},
                       true);
  const bool turns = out.drive == Drive::turning;
  const bool strokes = out.drive == Drive::oscillating || out.drive == Drive::reciprocating;
  const struct {
    std::string_view key;
    bool belongs;
    const char* to;
  } fields[] = {{"rpm", turns, "turning"},
                {"least_weight", turns, "turning"},
                {"strokes_per_minute", strokes, "oscillating or reciprocating"},
                {"stroke_mm", strokes, "oscillating or reciprocating"},
                {"blow_j", out.drive == Drive::struck, "struck"}};
  for (const auto& field : fields)
    if (!field.belongs && reader.has(field.key))
      reader.fail(field.key, fmt::format("belongs to drive = \"{}\"", field.to));
  double rpm = 0, per_minute = 0, stroke_mm = 0, teeth = out.teeth;
  reader.number("rpm", rpm, 0, kFastest, turns);
  reader.number("strokes_per_minute", per_minute, 0, kFastest, strokes);
  reader.number("stroke_mm", stroke_mm, 0, 50, strokes);
  reader.number("blow_j", out.blow_j, 0, 10, out.drive == Drive::struck);
  reader.number("least_weight", out.least_weight, 0, 1);
  reader.number("efficiency", out.efficiency, 0, 1);
  reader.number("teeth", teeth, 0, 1000);
  out.teeth = static_cast<int>(teeth);
  out.speed_rad_s = rpm / 60 * 2 * std::numbers::pi;
  out.cycles_hz = per_minute / 60;
  out.amplitude_m = 0.5 * kMm * stroke_mm;
  std::optional<Vec3> way;
  reader.vector("way", way);
  if (turns && way) reader.fail("way", "is only for tools that do not turn");
  if (!turns && !way) reader.fail("way", "is missing; give the direction of the stroke, [x, y, z]");
  if (!way || reader.failed()) return;
  if (!(way->norm() > 1e-6)) return reader.fail("way", "must be a direction, not [0, 0, 0]");
  out.way = way->normalized();
}

bool is_name(std::string_view name) {
  return name.size() <= 40 && std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
         });
}

void read_tool(Reader& reader, const Meshes& meshes, Rack& rack) {
  reader.only({"name", "title", "group", "source", "drive", "rpm", "strokes_per_minute",
               "stroke_mm", "blow_j", "way", "teeth", "efficiency", "least_weight", "lean_deg",
               "part"});
  RackTool out;
  reader.text("name", out.name, true);
  if (!is_name(out.name))
    reader.fail("name", "must be small letters, digits and -, at most 40 of them");
  read_texts(reader, "title", out.title, true);
  out.group = "own";
  reader.text("group", out.group);
  reader.text("source", out.source);
  read_drive(reader, out.cutter);
  double lean_deg = out.lean * 180 / std::numbers::pi;
  reader.number("lean_deg", lean_deg, 0, 90);
  out.lean = lean_deg * std::numbers::pi / 180;
  reader.each(
      "part",
      [&](Reader& inner) {
        read_part(inner, {meshes.read, meshes.folder, out.cutter.drive == Drive::turning},
                  out.tool);
      },
      static_cast<std::size_t>(tool::Tool::kMostParts));
  const auto* end = out.tool.parts.begin() + out.tool.count;
  if (std::none_of(out.tool.parts.cbegin(), end,
                   [](const tool::Part& part) { return part.role == Role::cuts; }))
    reader.fail("part", "none cuts; give at least one [[tool.part]] with role = \"cuts\"");
  if (reader.failed()) return;
  rack.put(std::move(out));
}

}  // namespace

void read_tool_list(Reader& reader, std::string_view key, const MeshReader& meshes,
                    const std::string& folder, Rack& rack) {
  reader.each(key, [&](Reader& inner) { read_tool(inner, {meshes, folder}, rack); });
}

const Rack& built_in_rack() {
  static const Rack rack = [] {
    auto read = parse_rack(built_in_rack_text(), "tools.toml", {});
    BURR_CHECK(read.ok());
    return std::move(*read);
  }();
  return rack;
}

Result<Rack> read_rack(const std::string& path, const MeshReader& meshes) {
  const auto text =
      base::text_of_file(path, kLargestFile, "a list of tools; check that this is the right file");
  if (!text) return text.error();
  return parse_rack(*text, path, built_in_rack(), meshes,
                    std::filesystem::path(path).parent_path().string());
}

Result<Rack> parse_rack(std::string_view text, std::string_view file, const Rack& base,
                        const MeshReader& meshes, const std::string& folder) {
  const auto table = parse_toml(text, file);
  if (!table) return table.error();
  Rack out = base;
  std::optional<Error> wrong;
  Reader reader(*table, std::string(file), "", wrong);
  reader.only({"tool"});
  if (!reader.has("tool")) reader.fail("tool", "is missing; give at least one [[tool]]");
  read_tool_list(reader, "tool", meshes, folder, out);
  if (wrong) return *wrong;
  return out;
}

}  // namespace burr::scenario
