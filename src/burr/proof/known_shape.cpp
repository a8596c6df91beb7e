#include "burr/proof/known_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "burr/base/printable.h"

namespace burr::proof {
namespace {

using math::Vec3;

constexpr double kNothing = -1e9;  // deeper outside than any point lies [mm]

double deepest_in(const std::vector<DepthMm>& shapes, const Vec3& p) {
  double most = kNothing;
  for (const DepthMm& one : shapes) most = std::max(most, one(p));
  return most;
}

// The place at a share of a curve's length.
Vec3 place_at(const std::vector<Vec3>& curve, double share) {
  double length = 0;
  for (std::size_t n = 1; n < curve.size(); ++n) length += (curve[n] - curve[n - 1]).norm();
  double left = share * length;
  for (std::size_t n = 1; n < curve.size(); ++n) {
    const double step = (curve[n] - curve[n - 1]).norm();
    if (step > 0 && left <= step) return curve[n - 1] + left / step * (curve[n] - curve[n - 1]);
    left -= step;
  }
  return curve.back();
}

// Reads the words of one shape. After a mistake every further word is zero, and `wrong` says the first.
class ShapeWords {
 public:
  ShapeWords(const std::string& text, const Places& places)
      : text_(text), words_(text), places_(places) {}

  bool next(std::string& word) { return static_cast<bool>(words_ >> word); }
  double number(const char* what) {
    std::string word;
    if (!next(word)) return fail(fmt::format("gives no {}; add a number", what)), 0;
    double x = 0;
    std::istringstream from(word);
    if (!(from >> x) || !from.eof() || !std::isfinite(x))
      fail(fmt::format("has \"{}\" as its {}; give a number", base::printable(word), what));
    return x;
  }
  double above_zero(const char* what) {
    const double x = number(what);
    if (wrong_.empty() && x <= 0) fail(fmt::format("has a {} of {}; give one above 0", what, x));
    return x;
  }
  Vec3 numbers(const char* what) {
    const double x = number(what), y = number(what), z = number(what);
    return {x, y, z};
  }
  // least: points that the landmark must have
  const PlaceMm& landmark(std::size_t least) {
    static const PlaceMm kNone{{Vec3::Zero(), Vec3::UnitX()}, Vec3::UnitX()};
    std::string name;
    if (!next(name)) return fail("gives no landmark; add its name"), kNone;
    std::replace(name.begin(), name.end(), '_', ' ');
    const auto found = places_.find(name);
    if (found == places_.end())
      return fail(fmt::format("names \"{}\", which is no landmark of the case; give one of them",
                              base::printable(name))),
             kNone;
    if (found->second.points.size() < least)
      return fail(fmt::format("names \"{}\", which is no curve; give a landmark of two points",
                              base::printable(name))),
             kNone;
    return found->second;
  }
  const Vec3& normal(const PlaceMm& place) {
    static const Vec3 kUp = Vec3::UnitZ();
    if (place.normal) return *place.normal;
    return fail("names a landmark without a normal; give one that is a plane"), kUp;
  }
  Vec3 point() {
    const auto before = words_.tellg();
    std::string kind;
    next(kind);
    if (kind == "at") {
      const PlaceMm& place = landmark(1);
      return place.points.front() + numbers("point");
    }
    if (kind == "of") {
      const PlaceMm& place = landmark(1);
      const double share = number("share");
      return place_at(place.points, share) + numbers("point");
    }
    if (kind == "on") {
      const PlaceMm& place = landmark(2);
      const Vec3 by = numbers("point");
      return frame_of(place.points.front(), place.points.back()).at(by.x(), by.y(), by.z());
    }
    words_.clear();
    words_.seekg(before);
    return numbers("point");
  }
  void fail(const std::string& why) {
    if (wrong_.empty()) wrong_ = fmt::format("the shape \"{}\" {}", base::printable(text_), why);
  }
  [[nodiscard]] const std::string& wrong() const { return wrong_; }

 private:
  std::string text_;
  std::istringstream words_;
  const Places& places_;
  std::string wrong_;
};

DepthMm long_shape(const std::string& kind, ShapeWords& words) {
  const Vec3 a = words.point(), b = words.point();
  const double radius = words.above_zero("radius");
  if (words.wrong().empty() && (b - a).norm() < 1e-9)
    words.fail("begins where it ends; give two points");
  return kind == "cyl" ? cylinder(a, b, radius) : tube({a, b}, radius);
}

DepthMm flat_shape(const std::string& kind, ShapeWords& words) {
  if (kind == "half") {
    const Vec3 normal = words.numbers("normal");
    const double d = words.number("distance");
    if (words.wrong().empty() && normal.norm() < 1e-9)
      words.fail("has a normal without length; give a direction");
    return half_space(normal.normalized(), d / std::max(1e-9, normal.norm()));
  }
  const PlaceMm& place = words.landmark(1);
  const Vec3 normal = words.normal(place);
  const double d = normal.dot(place.points.front()), from = d + words.number("distance");
  if (kind == "plane") return half_space(normal, from);
  const double to = d + words.number("distance");
  return [=](const Vec3& p) { return std::min(p.dot(normal) - from, to - p.dot(normal)); };
}

DepthMm read_shape(const std::string& kind, ShapeWords& words) {
  if (kind == "cyl" || kind == "cap") return long_shape(kind, words);
  if (kind == "half" || kind == "plane" || kind == "slab") return flat_shape(kind, words);
  if (kind == "ball") {
    const Vec3 at = words.point();
    return ball(at, words.above_zero("radius"));
  }
  if (kind == "box") {
    const Vec3 at = words.point();
    const double x = words.above_zero("edge"), y = words.above_zero("edge");
    return box(at, {x, y, words.above_zero("edge")});
  }
  if (kind == "tube") {
    const PlaceMm& place = words.landmark(2);
    return tube(place.points, words.above_zero("radius"));
  }
  words.fail(fmt::format(
      "begins with \"{}\", which is no shape; use cyl, cap, ball, box, half, plane, slab or tube",
      base::printable(kind)));
  return {};
}

// One or several shapes with "&" between them, without the sign.
Result<DepthMm> read_all_of(const std::string& text, const Places& places) {
  std::vector<DepthMm> all;
  std::istringstream parts(text + '&');  // so that what stands behind the last one counts, too
  for (std::string part; std::getline(parts, part, '&');) {
    ShapeWords words(part, places);
    std::string kind, more;
    if (!words.next(kind)) words.fail("is empty; give a shape on both sides of \"&\"");
    DepthMm depth;
    if (words.wrong().empty()) depth = read_shape(kind, words);
    if (words.wrong().empty() && words.next(more))
      words.fail(
          fmt::format("has \"{}\" too much; leave it out, or write \";\" before the next shape",
                      base::printable(more)));
    if (!words.wrong().empty()) return error(words.wrong());
    all.push_back(std::move(depth));
  }
  if (all.size() == 1) return all.front();
  return DepthMm([all = std::move(all)](const Vec3& p) {
    double least = -kNothing;
    for (const DepthMm& one : all) least = std::min(least, one(p));
    return least;
  });
}

}  // namespace

Places places_of(const scenario::CaseLesson& lesson) {
  Places places;
  for (const scenario::Landmark& one : lesson.landmarks) {
    if (one.points.empty()) continue;
    PlaceMm place;
    for (const Vec3& p : one.points) place.points.push_back(p * 1e3);
    if (one.normal) place.normal = one.normal->normalized();
    places[one.name] = std::move(place);
  }
  return places;
}

Frame frame_of(const Vec3& from_mm, const Vec3& to_mm) {
  Frame frame;
  frame.from = from_mm;
  frame.along = (to_mm - from_mm).normalized();
  const Vec3 side = std::abs(frame.along.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  frame.u = (side - side.dot(frame.along) * frame.along).normalized();
  frame.v = frame.u.cross(frame.along);
  return frame;
}

double to_segment_mm(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double square = way.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(way) / square, 0.0, 1.0) : 0;
  return (p - a - t * way).norm();
}

DepthMm cylinder(const Vec3& a, const Vec3& b, double radius) {
  const Vec3 along = (b - a).normalized();
  const double length = (b - a).norm();
  return [=](const Vec3& p) {
    const double t = (p - a).dot(along);
    return std::min({radius - (p - a - t * along).norm(), t, length - t});
  };
}

DepthMm ball(const Vec3& at, double radius) {
  return [=](const Vec3& p) { return radius - (p - at).norm(); };
}

DepthMm box(const Vec3& middle, const Vec3& size) {
  return [=](const Vec3& p) { return (0.5 * size - (p - middle).cwiseAbs()).minCoeff(); };
}

DepthMm half_space(const Vec3& unit_normal, double d) {
  return [=](const Vec3& p) { return p.dot(unit_normal) - d; };
}

DepthMm tube(std::vector<Vec3> course, double radius) {
  return [course = std::move(course), radius](const Vec3& p) {
    double least = -kNothing;
    for (std::size_t n = 1; n < course.size(); ++n)
      least = std::min(least, to_segment_mm(p, course[n - 1], course[n]));
    return radius - least;
  };
}

double Work::gone(const Vec3& p_mm) const {
  return std::max(deepest_in(holes, p_mm),
                  std::min(deepest_in(cut, p_mm), -deepest_in(kept, p_mm)));
}

double Work::grown(const Vec3& p_mm) const { return deepest_in(added, p_mm); }

Result<Work> read_work(std::string_view text, const Places& places) {
  Work work;
  std::istringstream all{std::string(text)};
  for (std::string one; std::getline(all, one, ';');) {
    const std::size_t first = one.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) continue;
    const char sign = one[first];
    auto& list = sign == '-'   ? work.kept
                 : sign == '!' ? work.holes
                 : sign == '+' ? work.added
                               : work.cut;
    const bool signs = sign == '-' || sign == '!' || sign == '+';
    auto depth = read_all_of(one.substr(first + (signs ? 1 : 0)), places);
    if (!depth) return depth.error();
    list.push_back(std::move(*depth));
  }
  return work;
}

}  // namespace burr::proof
