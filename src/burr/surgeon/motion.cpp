#include "burr/surgeon/motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "burr/base/plain_file.h"
#include "burr/base/printable.h"
#include "burr/math/elementary.h"
#include "burr/math/rotation.h"

namespace burr::surgeon {
namespace {

using device::HandPath;
using device::PathPoint;
using math::Vec3;
using volume::Bone;

constexpr double kApproach = 5e-3;     // the hand comes from this far above  [m]
constexpr double kApproachTime = 0.4;  // [s]
constexpr double kStep = 1e-3;         // between two points of a path        [s]

bool inside(const Bone& bone, const Vec3& p) {
  const math::Ijk at = (bone.grid().grid_from_world(p).array() + 0.5).floor().cast<int>();
  return bone.field(at.x(), at.y(), at.z()) >= volume::kIso;
}

// First bone along a ray through the volume, by steps of half a voxel, refined by bisection.
std::optional<Vec3> first_bone(const Bone& bone, const Vec3& from, const Vec3& direction,
                               double length) {
  const double step = 0.5 * bone.grid().voxel;
  for (double s = 0; s < length; s += step) {
    if (!inside(bone, from + s * direction)) continue;
    double air = std::max(0.0, s - step), solid = s;
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (air + solid);
      (inside(bone, from + middle * direction) ? solid : air) = middle;
    }
    return from + air * direction;
  }
  return std::nullopt;
}

// Outward normal of the surface around p: the direction from the bone's centre of mass within
// `radius` to the air's.
std::optional<Vec3> outward(const Bone& bone, const Vec3& p, double radius) {
  const double h = bone.grid().voxel;
  const Vec3 centre = bone.grid().grid_from_world(p);
  const int reach = std::clamp(static_cast<int>(std::ceil(radius / h)), 2, 40);
  const math::Ijk middle = (centre.array() + 0.5).floor().cast<int>();
  Vec3 sum = Vec3::Zero();
  for (int k = -reach; k <= reach; ++k)
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        const Vec3 d(i, j, k);
        if (d.norm() > reach) continue;
        sum -= d * static_cast<double>(bone.field(middle.x() + i, middle.y() + j, middle.z() + k));
      }
  const double size = sum.norm();
  if (size < 1e-3 * reach) return std::nullopt;
  return bone.grid().frame.q * (sum / size);
}

math::Quat handle_along(const Vec3& outward_axis) {
  return math::shortest_rotation(Vec3::UnitZ(), outward_axis);
}

}  // namespace

Result<WorkPlace> find_work_place(const Bone& bone, double burr_radius,
                                  const std::optional<Vec3>& at, const std::optional<Vec3>& into) {
  const volume::Grid& grid = bone.grid();
  const math::Aabb box = grid.bounds_grid();
  math::Aabb world;
  for (int corner = 0; corner < 8; ++corner)
    world.extend(grid.world_from_grid({(corner & 1) != 0 ? box.hi.x() : box.lo.x(),
                                       (corner & 2) != 0 ? box.hi.y() : box.lo.y(),
                                       (corner & 4) != 0 ? box.hi.z() : box.lo.z()}));
  const double diagonal = world.extent().norm();
  WorkPlace place;
  if (into.has_value()) {
    if (!(into->norm() > 1e-9))
      return error(
          Trouble::usage,
          "`into` 0,0,0 is not a direction; give the direction into the bone, for example 0,0,-1");
    place.into = into->normalized();
  }

  std::optional<Vec3> hit;
  if (at.has_value()) {
    // go back along the way in, then forward to the first bone near the place
    hit = first_bone(bone, *at - 0.02 * place.into, place.into, 0.04);
    if (!hit) {
      hit = first_bone(bone, *at - diagonal * place.into, place.into, 2 * diagonal);
    }
    if (!hit)
      return error(
          Trouble::usage,
          fmt::format(
              "there is no bone on the line through `at` {:.1f},{:.1f},{:.1f} mm; give a point in "
              "the bone (the volume reaches from {:.1f},{:.1f},{:.1f} to {:.1f},{:.1f},{:.1f} mm)",
              1e3 * at->x(), 1e3 * at->y(), 1e3 * at->z(), 1e3 * world.lo.x(), 1e3 * world.lo.y(),
              1e3 * world.lo.z(), 1e3 * world.hi.x(), 1e3 * world.hi.y(), 1e3 * world.hi.z()));
  } else {
    // straight down through the middle, otherwise along lines farther and farther from it
    const Vec3 middle = world.centre();
    const double spacing = 0.02 * std::max(world.extent().x(), world.extent().y());
    for (int ring = 0; ring <= 25 && !hit; ++ring)
      for (int spoke = 0; spoke < std::max(1, 6 * ring) && !hit; ++spoke) {
        const double angle = 2 * M_PI * spoke / std::max(1, 6 * ring);
        const Vec3 top(middle.x() + ring * spacing * math::cosine(angle),
                       middle.y() + ring * spacing * math::sine(angle), world.hi.z() + grid.voxel);
        hit = first_bone(bone, top, -Vec3::UnitZ(), world.extent().z() + 2 * grid.voxel);
      }
    if (!hit)
      return error(
          "the volume holds no solid bone; check `iso`, or the table of labels "
          "(docs/use/labels.md)");
  }
  place.at = *hit;
  if (!into.has_value()) {
    const std::optional<Vec3> normal =
        outward(bone, place.at, std::max(burr_radius, 2 * grid.voxel));
    if (normal) place.into = -*normal;
  }
  return place;
}

std::vector<std::string> motion_names() { return {"stroke", "plunge", "slot", "pocket", "touch"}; }

Result<HandPath> motion(std::string_view name, const WorkPlace& place, double burr_radius,
                        double seconds) {
  const std::vector<std::string> names = motion_names();
  if (std::find(names.begin(), names.end(), name) == names.end())
    return error(Trouble::usage, fmt::format("`motion` {} is not known; use one of {}", name,
                                             fmt::join(names, ", ")));
  if (!(seconds >= 1) || seconds > 36000)
    return error(Trouble::usage,
                 fmt::format("`seconds` {} is out of range; use 1 to 36000", seconds));

  const Vec3 out = -place.into;
  const Vec3 u = out.unitOrthogonal(), v = out.cross(u);
  // the handle leans 30 degrees, as a hand holds it, because the pole of a burr hardly cuts
  const math::Quat grip =
      handle_along((math::cosine(M_PI / 6) * out + math::sine(M_PI / 6) * u).normalized());
  const double work = seconds - kApproachTime;
  const double r = burr_radius;

  HandPath path;
  const auto add = [&](double t, const Vec3& offset, double pedal) {
    path.points.push_back({t, {place.at + r * out + offset, grip}, pedal});
  };
  const double pedal = name == "touch" ? 0 : 1;
  for (double t = 0; t <= seconds; t += kStep) {
    if (t < kApproachTime) {
      add(t, kApproach * (1 - t / kApproachTime) * out, pedal);
      continue;
    }
    const double s = t - kApproachTime, share = s / work;
    Vec3 offset = Vec3::Zero();
    if (name == "plunge") {
      offset = -std::min(2e-3 * s, 3 * r + 2e-3) * out;
    } else if (name == "slot") {
      const double sunk = std::min(4e-3 * s, r + 1e-3);
      offset = std::min(5e-3 * std::max(0.0, s - 0.5), 12e-3) * u - sunk * out;
    } else if (name == "pocket") {
      // circles at 30 mm/s, at most 4 mm wide, going down at a constant rate to 6 mm
      const double wide = std::min(4e-3, 1e-3 + 3e-3 * share), angle = 30e-3 / 3e-3 * s;
      offset = wide * (math::cosine(angle) - 1) * u + wide * math::sine(angle) * v -
               (1e-3 * std::min(1.0, 2 * s) + 5e-3 * share) * out;
    } else {  // stroke, touch: 1.3 strokes a second over 8 mm, 40 mm/s at most
      const double sunk = (name == "touch" ? 0.5e-3 : 1.5e-3) * std::min(1.0, 4 * s);
      offset = 4e-3 * math::sine(2 * M_PI * 1.3 * s) * u - sunk * out;
    }
    add(t, offset, pedal);
  }
  return path;
}

Result<HandPath> read_path(const std::string& file) {
  if (const Status plain = base::check_plain_file(file); !plain) return plain.error();
  std::ifstream in(file);
  if (!in) return error(Trouble::io, fmt::format("{}: cannot be read; check the name", file));
  std::string line;
  if (!std::getline(in, line))
    return error(fmt::format("{}: is empty; the first line must be t,x,y,z", file));
  if (line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // a byte-order mark, as Excel writes it

  const auto split = [](std::string text) {
    std::vector<std::string> cells;
    text.erase(std::remove_if(text.begin(), text.end(),
                              [](char c) { return c == ' ' || c == '\r' || c == '\t'; }),
               text.end());
    std::size_t from = 0;
    for (std::size_t comma = text.find(','); comma != std::string::npos;
         comma = text.find(',', from)) {
      cells.push_back(text.substr(from, comma - from));
      from = comma + 1;
    }
    cells.push_back(text.substr(from));
    return cells;
  };
  const std::vector<std::string> header = split(line);
  const auto column = [&header](std::string_view name) {
    const auto found = std::find(header.begin(), header.end(), name);
    return found == header.end() ? -1 : static_cast<int>(found - header.begin());
  };
  const bool mm = column("x_mm") >= 0;
  const int t_at = column("t"), x_at = column(mm ? "x_mm" : "x"), y_at = column(mm ? "y_mm" : "y"),
            z_at = column(mm ? "z_mm" : "z");
  if (t_at < 0 || x_at < 0 || y_at < 0 || z_at < 0)
    return error(
        fmt::format("{}: the first line must name the columns t,x,y,z (metres) or "
                    "t,x_mm,y_mm,z_mm; it says \"{}\"",
                    file, base::printable(line)));
  const int q_at[4] = {column("qw"), column("qx"), column("qy"), column("qz")};
  const bool turned = q_at[0] >= 0;
  if (turned && (q_at[1] < 0 || q_at[2] < 0 || q_at[3] < 0))
    return error(
        fmt::format("{}: give all of the columns qw,qx,qy,qz or none; one is missing", file));
  const int pedal_at = column("spindle");

  HandPath path;
  for (int number = 2; std::getline(in, line); ++number) {
    if (line.empty() || line == "\r") continue;
    const std::vector<std::string> cells = split(line);
    bool good = cells.size() == header.size();
    const auto cell = [&](int at) {
      double value = 0;
      const std::string& text = cells[static_cast<std::size_t>(at)];
      const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), value);
      good = good && trouble == std::errc() && end == text.data() + text.size() &&
             std::isfinite(value);
      return value;
    };
    PathPoint point;
    if (good) {
      point.t = cell(t_at);
      point.world_from_tool.p = Vec3(cell(x_at), cell(y_at), cell(z_at)) * (mm ? 1e-3 : 1.0);
      if (turned) {
        Eigen::Vector4d q(cell(q_at[1]), cell(q_at[2]), cell(q_at[3]), cell(q_at[0]));
        good = good && q.norm() > 1e-6 && q.norm() < 1e6;
        if (good) point.world_from_tool.q.coeffs() = q.normalized();
      }
      if (pedal_at >= 0) point.pedal = std::clamp(cell(pedal_at), 0.0, 1.0);
    }
    if (!good)
      return error(fmt::format("{}: line {} does not hold {} finite numbers; correct or remove it",
                               file, number, header.size()));
    constexpr double kFarthest = 1e3, kLongest = 1e6;  // [m] [s]
    if (std::abs(point.t) > kLongest || point.world_from_tool.p.cwiseAbs().maxCoeff() > kFarthest)
      return error(
          fmt::format("{}: line {}: the time is beyond {:g} s or the position is beyond {:g} m; "
                      "check the units",
                      file, number, kLongest, kFarthest));
    if (!path.points.empty() && point.t <= path.points.back().t)
      return error(fmt::format("{}: line {}: t must increase from line to line; it is {} after {}",
                               file, number, point.t, path.points.back().t));
    path.points.push_back(point);
  }
  if (path.points.empty())
    return error(fmt::format("{}: holds no poses below its first line", file));
  const double start = path.points.front().t;
  for (PathPoint& point : path.points) point.t -= start;
  return path;
}

}  // namespace burr::surgeon
