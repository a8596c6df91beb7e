#include "burr/io/read/contour_voxels.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/contour_plane.h"
#include "burr/io/read/dicom_seg_frames.h"

namespace burr::io {
namespace {

using math::Ijk;
using math::Vec3;

constexpr double kBridged =
    1.5;  // planes farther apart, in usual distances, have nothing between them
constexpr double kFlat =
    0.1;  // a contour this flat along an axis lies in a plane across it [voxel]
constexpr double kOnSlice = 0.02;  // a plane this near to a slice lies on it [slice]
constexpr double kUneven = 0.5;    // from its plane, a point of a slanting contour at most [voxel]

// Contours in parallel planes. Its frame: u, v, and n across the planes, in mm along the axes of the voxels.
struct Family {
  int axis = -1;  // of the voxels, across the planes; -1: none
  Vec3 u, v, n;
  struct Plane {
    double at = 0;  // [mm]
    std::vector<Curve> curves;
  };
  std::vector<Plane> planes;  // sorted
  double gap = 0;             // the usual distance of the planes
  double slab = 0;            // as the file states it; 0: it does not
};

// What is to be said of the structures, by their names.
struct Noted {
  std::set<std::string> open, broken, copies, between, slanting, apart, beyond;
  std::set<std::string> types;
  std::size_t open_count = 0, broken_count = 0, copy_count = 0;
};

Vec3 newell(const std::vector<Vec3>& points) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < points.size(); ++n)
    sum += (points[n] - points[0]).cross(points[(n + 1) % points.size()] - points[0]);
  return sum;
}

double middle(std::vector<double> all) {
  if (all.empty()) return 0;
  const auto half = all.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) / 2);
  std::nth_element(all.begin(), half, all.end());
  return *half;
}

// The contours of one structure, sorted into families and planes.
class Sorter {
 public:
  Sorter(const VoxelPlaces& on, const std::string& name, Noted& noted)
      : on_(on), name_(name), noted_(noted) {}

  std::vector<Family> sort(const std::vector<Contour>& contours) {
    for (const Contour& contour : contours) {
      const bool closed = contour.type == "CLOSED_PLANAR" || contour.type == "CLOSEDPLANAR_XOR" ||
                          contour.type.empty();
      if (!closed) {
        ++noted_.open_count;
        noted_.open.insert(name_);
        noted_.types.insert(base::printable(contour.type, 20));
      } else if (!take(contour)) {
        ++noted_.broken_count;
        noted_.broken.insert(name_);
      }
    }
    for (Family& family : families_) {
      std::sort(family.planes.begin(), family.planes.end(),
                [](const auto& a, const auto& b) { return a.at < b.at; });
      join(family);
    }
    return std::move(families_);
  }

 private:
  bool take(const Contour& contour) {
    std::vector<Vec3> points;
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (const Vec3& point : contour.points) {
      const Vec3 q = on_.axes.transpose() * (point - on_.origin_mm);
      if (!points.empty() && q == points.back()) continue;
      points.push_back(q);
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    if (points.size() < 3 || !(high - low).allFinite() || high.cwiseAbs().maxCoeff() > 1e7 ||
        low.cwiseAbs().maxCoeff() > 1e7)
      return false;
    const Vec3 area = newell(points);
    if (!(area.norm() > 1e-9)) return false;
    Family* family = nullptr;
    for (const int axis : {2, 0, 1})
      if (family == nullptr && high[axis] - low[axis] <= kFlat * on_.spacing_mm[axis])
        family = &across(axis);
    if (family == nullptr) family = slanting(area.normalized(), points);
    if (family == nullptr) return false;
    Family::Plane plane;
    Curve curve;
    for (const Vec3& q : points) {
      plane.at += family->n.dot(q) / static_cast<double>(points.size());
      curve.push_back({family->u.dot(q), family->v.dot(q)});
    }
    plane.curves.push_back(std::move(curve));
    family->planes.push_back(std::move(plane));
    family->slab = std::max(family->slab, contour.slab_mm);
    return true;
  }

  Family& across(int axis) {
    for (Family& family : families_)
      if (family.axis == axis) return family;
    Family& made = families_.emplace_back();
    made.axis = axis;
    made.n = Vec3::Unit(axis);
    made.u = Vec3::Unit(axis == 0 ? 1 : 0);
    made.v = Vec3::Unit(axis == 2 ? 1 : 2);
    return made;
  }

  // nullptr: the points lie in no plane.
  Family* slanting(const Vec3& normal, const std::vector<Vec3>& points) {
    const double most = kUneven * on_.spacing_mm.minCoeff();
    constexpr double kParallel = 0.9994;  // 2 degrees
    const auto flat = [&](const Vec3& n) {
      double low = 1e300, high = -low;
      for (const Vec3& q : points) {
        low = std::min(low, n.dot(q));
        high = std::max(high, n.dot(q));
      }
      return high - low <= 2 * most;
    };
    for (Family& family : families_)
      if (family.axis < 0 && std::abs(family.n.dot(normal)) > kParallel && flat(family.n))
        return &family;
    if (!flat(normal)) return nullptr;
    Family& made = families_.emplace_back();
    made.n = normal;
    made.u = normal.unitOrthogonal();
    made.v = normal.cross(made.u);
    return &made;
  }

  // Contours at one place become one plane; of copies one stays.
  void join(Family& family) {
    const double across = family.axis < 0 ? on_.spacing_mm.minCoeff() : on_.spacing_mm[family.axis];
    const double same = std::min(0.05, 0.2 * across);
    std::vector<Family::Plane> out;
    for (Family::Plane& plane : family.planes) {
      if (out.empty() || plane.at - out.back().at > same) {
        out.push_back(std::move(plane));
        continue;
      }
      const auto& had = out.back().curves;
      if (std::find(had.begin(), had.end(), plane.curves.front()) != had.end()) {
        ++noted_.copy_count;
        noted_.copies.insert(name_);
        continue;
      }
      out.back().curves.push_back(std::move(plane.curves.front()));
    }
    family.planes = std::move(out);
  }

  const VoxelPlaces& on_;
  const std::string& name_;
  Noted& noted_;
  std::vector<Family> families_;
};

std::vector<double> gaps_of(const Family& family) {
  std::vector<double> out;
  for (std::size_t n = 1; n < family.planes.size(); ++n)
    out.push_back(family.planes[n].at - family.planes[n - 1].at);
  return out;
}

// Which planes a place across them lies between.
struct Between {
  std::size_t low = 0, high = 0;
  double share = 0;  // of the way from low to high
};
std::optional<Between> between(const Family& family, double at, double same) {
  const auto& planes = family.planes;
  const auto above = static_cast<std::size_t>(
      std::lower_bound(planes.begin(), planes.end(), at - same,
                       [](const Family::Plane& plane, double s) { return plane.at < s; }) -
      planes.begin());
  if (above < planes.size() && std::abs(planes[above].at - at) <= same)
    return Between{above, above, 0};
  const bool has_low = above > 0, has_high = above < planes.size();
  if (has_low && has_high) {
    const double gap = planes[above].at - planes[above - 1].at;
    if (gap <= kBridged * family.gap * (1 + 1e-6))
      return Between{above - 1, above, (at - planes[above - 1].at) / gap};
  }
  // each plane stands for a slab, which has its lower face and not its upper one
  const double half = 0.5 * family.gap, edge = 1e-6 * family.gap;
  if (has_low && at - planes[above - 1].at < half - edge) return Between{above - 1, above - 1, 0};
  if (has_high && planes[above].at - at <= half + edge) return Between{above, above, 0};
  return std::nullopt;
}

// Sets the voxels of one family in a bit for each voxel.
class Filler {
 public:
  Filler(const VoxelPlaces& on, const Family& family, SegBits& bits)
      : on_(on), family_(family), bits_(bits) {}

  // false: stopped
  bool fill(Progress& progress) {
    set_grid();
    if (grid_.nu < 1 || grid_.nv < 1) return true;
    masks_.resize(family_.planes.size());
    return family_.axis >= 0 ? fill_slices(progress) : fill_box(progress);
  }
  [[nodiscard]] bool interpolated() const { return interpolated_; }

 private:
  // The pixels around all curves, in the scan: those of the voxels, or, of slanting planes, as fine.
  void set_grid() {
    std::array<double, 2> low = {1e300, 1e300}, high = {-1e300, -1e300};
    for (const Family::Plane& plane : family_.planes)
      for (const Curve& curve : plane.curves)
        for (const auto& point : curve)
          for (std::size_t c = 0; c < 2; ++c) {
            low[c] = std::min(low[c], point[c]);
            high[c] = std::max(high[c], point[c]);
          }
    const auto axis_of = [](const Vec3& unit) {
      Eigen::Index axis = 0;
      unit.cwiseAbs().maxCoeff(&axis);
      return axis;
    };
    const std::array<const Vec3*, 2> way = {&family_.u, &family_.v};
    std::array<double, 2> start{}, gap{};
    std::array<int, 2> count{};
    for (std::size_t c = 0; c < 2; ++c) {
      double least = 0, most = 0;  // of the scan, in pixels
      if (family_.axis >= 0) {
        gap[c] = on_.spacing_mm[axis_of(*way[c])];
        most = on_.size[axis_of(*way[c])] - 1;
      } else {
        gap[c] = on_.spacing_mm.minCoeff();
        for (int a = 0; a < 3; ++a) {  // the corners of the scan
          const double reach = (*way[c])[a] * (on_.size[a] - 1) * on_.spacing_mm[a] / gap[c];
          least += std::min(reach, 0.0);
          most += std::max(reach, 0.0);
        }
      }
      constexpr double kMargin = 2;
      const double first = std::max(std::floor(low[c] / gap[c]) - kMargin, std::floor(least)),
                   last = std::min(std::ceil(high[c] / gap[c]) + kMargin, std::ceil(most));
      start[c] = first * gap[c];
      if (last < first) return;  // nowhere in the scan
      count[c] = static_cast<int>(last - first) + 1;
      first_[c] = static_cast<int>(first);
    }
    grid_ = {start[0], start[1], gap[0], gap[1], count[0], count[1]};
  }

  const PlaneMask& mask(std::size_t plane, bool with_depth) {
    std::unique_ptr<PlaneMask>& made = masks_[plane];
    if (made == nullptr) made = std::make_unique<PlaneMask>(grid_, family_.planes[plane].curves);
    if (with_depth) made->measure_depth();
    return *made;
  }

  void set(const Ijk& ijk) {
    bits_.set(static_cast<std::uint64_t>(ijk.x()) +
              static_cast<std::uint64_t>(on_.size.x()) *
                  (static_cast<std::uint64_t>(ijk.y()) +
                   static_cast<std::uint64_t>(on_.size.y()) * static_cast<std::uint64_t>(ijk.z())));
  }

  bool fill_slices(Progress& progress) {
    const int across = family_.axis, along_u = across == 0 ? 1 : 0, along_v = across == 2 ? 1 : 2;
    const double gap = on_.spacing_mm[across];
    for (int slice = 0; slice < on_.size[across]; ++slice) {
      const auto found = between(family_, slice * gap, kOnSlice * gap);
      if (!found) continue;
      if (progress.cancelled()) return false;
      const bool two = found->low != found->high;
      interpolated_ = interpolated_ || two;
      const PlaneMask &low = mask(found->low, two), &high = mask(found->high, two);
      for (int v = 0; v < grid_.nv; ++v)
        for (int u = 0; u < grid_.nu; ++u) {
          const bool inside =
              two ? (1 - found->share) * low.depth(u, v) + found->share * high.depth(u, v) > 0
                  : low.inside(u, v);
          if (!inside) continue;
          Ijk ijk = {0, 0, 0};
          ijk[across] = slice;
          ijk[along_u] = first_[0] + u;
          ijk[along_v] = first_[1] + v;
          set(ijk);
        }
      for (std::size_t n = 0; n < found->low; ++n) masks_[n].reset();  // not needed again
    }
    return true;
  }

  // Looks at every voxel that may be inside.
  bool fill_box(Progress& progress) {
    const double half = family_.gap, start = family_.planes.front().at - half,
                 end = family_.planes.back().at + half;
    const double u1 = grid_.u0 + (grid_.nu - 1) * grid_.du,
                 v1 = grid_.v0 + (grid_.nv - 1) * grid_.dv;
    Vec3 low = Vec3::Constant(1e300), high = -low;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 q = family_.u * ((corner & 1) != 0 ? u1 : grid_.u0) +
                     family_.v * ((corner & 2) != 0 ? v1 : grid_.v0) +
                     family_.n * ((corner & 4) != 0 ? end : start);
      low = low.cwiseMin(q);
      high = high.cwiseMax(q);
    }
    Ijk from, to;
    for (int a = 0; a < 3; ++a) {
      const double last = on_.size[a] - 1;
      from[a] = static_cast<int>(std::clamp(std::floor(low[a] / on_.spacing_mm[a]), 0.0, last));
      to[a] = static_cast<int>(std::clamp(std::ceil(high[a] / on_.spacing_mm[a]), 0.0, last));
    }
    for (int k = from.z(); k <= to.z(); ++k) {
      if (progress.cancelled()) return false;
      for (int j = from.y(); j <= to.y(); ++j)
        for (int i = from.x(); i <= to.x(); ++i) {
          const Vec3 q = on_.spacing_mm.cwiseProduct(Vec3(i, j, k));
          const auto found = between(family_, family_.n.dot(q), 0);
          if (!found) continue;
          const double u = family_.u.dot(q), v = family_.v.dot(q);
          double depth = mask(found->low, true).depth_at(u, v);
          if (found->low != found->high)
            depth =
                (1 - found->share) * depth + found->share * mask(found->high, true).depth_at(u, v);
          if (depth > 0) set({i, j, k});
        }
    }
    return true;
  }

  const VoxelPlaces& on_;
  const Family& family_;
  SegBits& bits_;
  PlaneGrid grid_;
  std::array<int, 2> first_{};  // of the grid, in voxels
  std::vector<std::unique_ptr<PlaneMask>> masks_;
  bool interpolated_ = false;
};

// Whether curves reach beyond the scan by more than half a voxel.
bool beyond(const Family& family, const VoxelPlaces& on) {
  for (const Family::Plane& plane : family.planes)
    for (const Curve& curve : plane.curves)
      for (const auto& point : curve) {
        const Vec3 q = family.u * point[0] + family.v * point[1] + family.n * plane.at;
        const Vec3 at = q.cwiseQuotient(on.spacing_mm);
        if ((at.array() < -1).any() || (at.array() > on.size.cast<double>().array()).any())
          return true;
      }
  return false;
}

std::string list_of(const std::set<std::string>& names) {
  constexpr std::size_t kNamed = 8;
  std::string out;
  std::size_t n = 0;
  for (const std::string& name : names) {
    if (n++ == kNamed) break;
    out += (out.empty() ? "" : ", ") + name;
  }
  return names.size() > kNamed ? fmt::format("{} and {} more", out, names.size() - kNamed) : out;
}

void tell(const Noted& noted, double slices_mm, Scan& scan) {
  const auto contours = [](std::size_t n) {
    return n == 1 ? std::string("One contour") : fmt::format("{} contours", n);
  };
  const auto say = [&](const std::set<std::string>& names, std::string text) {
    if (!names.empty()) scan.notices.push_back(std::move(text));
  };
  say(noted.open,
      fmt::format("{} of {} {} no inside ({}) and {} left out.", contours(noted.open_count),
                  list_of(noted.open), noted.open_count == 1 ? "has" : "have", list_of(noted.types),
                  noted.open_count == 1 ? "was" : "were"));
  say(noted.broken,
      fmt::format("{} of {} {} fewer than three points, no area or no plane, and {} left out.",
                  contours(noted.broken_count), list_of(noted.broken),
                  noted.broken_count == 1 ? "has" : "have",
                  noted.broken_count == 1 ? "was" : "were"));
  say(noted.copies,
      fmt::format("{} of {} {} of another one and {} once.", contours(noted.copy_count),
                  list_of(noted.copies), noted.copy_count == 1 ? "is a copy" : "are copies",
                  noted.copy_count == 1 ? "counts" : "count"));
  say(noted.between,
      fmt::format("The contours of {} do not lie on all slices of the scan, which are {:.3g} mm "
                  "apart: between them the shape is interpolated.",
                  list_of(noted.between), slices_mm));
  say(noted.slanting, fmt::format("The contours of {} lie in planes across the slices of the scan.",
                                  list_of(noted.slanting)));
  say(noted.apart, fmt::format("Contours of {} lie more than 1.5 times as far apart as the others: "
                               "nothing was filled in between them.",
                               list_of(noted.apart)));
  say(noted.beyond,
      fmt::format("Contours of {} reach beyond the scan: what lies outside of it was left out.",
                  list_of(noted.beyond)));
}

// The usual distance of the planes of a family; usual: of all structures.
double gap_of(const Family& family, double usual, const VoxelPlaces& on) {
  const std::vector<double> gaps = gaps_of(family);
  if (gaps.size() > 1) return middle(gaps);
  const double voxel = family.axis >= 0 ? on.spacing_mm[family.axis] : on.spacing_mm.minCoeff();
  if (gaps.empty() && family.slab > 0) return family.slab;
  if (usual > 0) return usual;
  return gaps.empty() ? voxel : gaps.front();
}

}  // namespace

Result<std::vector<LooseStructure>> voxels_of_contours(const ContourSet& set, const VoxelPlaces& on,
                                                       Scan& scan, Progress& progress) {
  Noted noted;
  std::vector<std::vector<Family>> families;
  std::vector<double> gaps;
  for (const ContouredStructure& one : set.structures) {
    const std::string name = base::printable(one.label.name);
    families.push_back(Sorter(on, name, noted).sort(one.contours));
    for (const Family& family : families.back())
      for (const double gap : gaps_of(family)) gaps.push_back(gap);
  }
  const double usual = middle(gaps);
  std::vector<LooseStructure> out;
  for (std::size_t n = 0; n < families.size(); ++n) {
    const std::string name = base::printable(set.structures[n].label.name);
    LooseStructure made;
    made.label = set.structures[n].label;
    made.places = on;
    const auto voxels = static_cast<std::uint64_t>(on.size.x()) *
                        static_cast<std::uint64_t>(on.size.y()) *
                        static_cast<std::uint64_t>(on.size.z());
    SegBits bits(families[n].empty() ? 0 : voxels);
    for (Family& family : families[n]) {
      family.gap = gap_of(family, usual, on);
      Filler filler(on, family, bits);
      if (!filler.fill(progress)) return error(Trouble::interrupted, "reading was stopped");
      if (family.axis != 2) noted.slanting.insert(name);
      if (filler.interpolated()) noted.between.insert(name);
      if (beyond(family, on)) noted.beyond.insert(name);
      for (const double gap : gaps_of(family))
        if (gap > kBridged * family.gap * (1 + 1e-6)) noted.apart.insert(name);
    }
    if (!families[n].empty()) bits.each(0, voxels, [&](std::size_t voxel) { made.add(voxel); });
    out.push_back(std::move(made));
    progress.report(static_cast<double>(n + 1) / static_cast<double>(families.size()),
                    "filling contours");
  }
  tell(noted, on.spacing_mm.z(), scan);
  return out;
}

}  // namespace burr::io
