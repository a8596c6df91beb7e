// tests/scoring/known_bones.h - a built-in case whose bone is cut by distances written here, which share nothing with the
// regions and measures of burr: the right value of each item follows from the numbers in the line.
//
//     KnownBone jaw("jaw");
//     jaw.cut("cyl 0 0 5 0 0 -11.2 2 ; ball 3 0 -4 1");       // mm LPS; of several shapes all are cut
//     jaw.outcome("bed.width").value
//
// Shapes: cap, cyl x y z x y z r; ball x y z r; box cx cy cz sx sy sz; half nx ny nz d (n.p > d); tube NAME r (along the curve of
// a landmark, "_" for a space). "-" before one: kept, whatever is cut; "!": cut, whatever is kept.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/scenario/case.h"
#include "burr/scenario/open_lesson.h"
#include "burr/scoring/reference.h"
#include "burr/scoring/score.h"
#include "burr/volume/bone.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "support/data.h"

namespace burr::scoring::test {

using math::Vec3;

using DepthMm = std::function<double(const Vec3& p_mm)>;  // positive inside

inline double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double t = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - a - t * way).norm();
}

inline DepthMm cylinder(const Vec3& a, const Vec3& b, double radius) {
  return [=](const Vec3& p) {
    const Vec3 along = (b - a).normalized();
    const double t = (p - a).dot(along), length = (b - a).norm();
    return std::min({radius - (p - a - t * along).norm(), t, length - t});
  };
}

inline DepthMm tube(const std::vector<Vec3>& course_mm, double radius) {
  return [=](const Vec3& p) {
    double least = 1e9;
    for (std::size_t n = 1; n < course_mm.size(); ++n)
      least = std::min(least, to_segment(p, course_mm[n - 1], course_mm[n]));
    return radius - least;
  };
}

class KnownBone {
 public:
  explicit KnownBone(const std::string& name, double voxel_mm = 0) {
    rubric_ = *read_rubric(name);
    // without a recording nothing soft is judged, so what needs such an item is looked at alone
    for (Item& item : rubric_.items)
      if (const Item* other = rubric_.item(item.needs); other != nullptr && needs_recording(*other))
        item.needs.clear();
    work_ = *scenario::read_case(name);
    lesson_ = *scenario::place(*scenario::lesson_of(work_), workshop::landmarks_of(work_), name);
    if (voxel_mm > 0) recipe_.voxel_mm = voxel_mm;
    before_ = made();
  }

  // Cuts a new bone of the case and scores it.
  void cut(const std::string& shapes) {
    read(shapes);
    after_ = made();
    for (volume::BrickIndex brick = 0; brick < after_->brick_count(); ++brick) cut_brick(brick);
    look();
  }
  // The result that the case calls its reference.
  void cut_reference() {
    after_ = made();
    ASSERT_TRUE(cut_to_reference(*after_, *before_, lesson_, quiet_));
    look();
  }

  [[nodiscard]] const Outcome& outcome(const std::string& id) const {
    for (const Outcome& one : outcomes_)
      if (one.id == id) return one;
    throw std::out_of_range(id);
  }
  [[nodiscard]] double mm(const std::string& id) const { return *outcome(id).value * 1e3; }
  [[nodiscard]] bool met(const std::string& id) const {
    return outcome(id).verdict == Verdict::met;
  }
  [[nodiscard]] const volume::Bone& before() const { return *before_; }
  [[nodiscard]] const volume::Bone& after() const { return *after_; }
  [[nodiscard]] const scenario::CaseLesson& lesson() const { return lesson_; }

 private:
  std::unique_ptr<volume::Bone> made() {
    auto bone = workshop::open_bone(workshop::recipe_of(work_, recipe_), quiet_);
    if (!bone) throw std::runtime_error(bone.error().text);
    return std::move(bone->bone);
  }

  void look() {
    auto made = score(rubric_, lesson_, *before_, *after_, nullptr, quiet_);
    ASSERT_TRUE(made) << made.error().text;
    outcomes_ = made->outcomes;
  }

  DepthMm shape(const std::string& kind, std::istream& from) const {
    const auto number = [&from] {
      double x = 0;
      from >> x;
      return x;
    };
    const auto point = [&number] {
      const double x = number(), y = number(), z = number();
      return Vec3(x, y, z);
    };
    if (kind == "cyl" || kind == "cap") {
      const Vec3 a = point(), b = point();
      const double radius = number();
      return kind == "cyl" ? cylinder(a, b, radius) : tube({a, b}, radius);
    }
    if (kind == "ball") {
      const Vec3 at = point();
      const double radius = number();
      return [=](const Vec3& p) { return radius - (p - at).norm(); };
    }
    if (kind == "box") {
      const Vec3 at = point(), size = point();
      return [=](const Vec3& p) { return (0.5 * size - (p - at).cwiseAbs()).minCoeff(); };
    }
    if (kind == "half") {
      const Vec3 normal = point();
      const double d = number();
      return [=](const Vec3& p) { return p.dot(normal) - d; };
    }
    std::string curve;
    from >> curve;
    std::replace(curve.begin(), curve.end(), '_', ' ');
    std::vector<Vec3> points;
    for (const Vec3& p : lesson_.landmark(curve)->points) points.push_back(p * 1e3);
    const double radius = number();
    return tube(points, radius);
  }

  void read(const std::string& shapes) {
    cut_.clear();
    kept_.clear();
    holes_.clear();
    std::stringstream all(shapes);
    for (std::string one; std::getline(all, one, ';');) {
      std::stringstream words(one);
      std::string kind;
      if (!(words >> kind)) continue;
      const char sign = kind.front();
      auto& list = sign == '-' ? kept_ : sign == '!' ? holes_ : cut_;
      if (sign == '-' || sign == '!') kind.erase(0, 1);
      list.push_back(shape(kind, words));
      if (!words) throw std::runtime_error("not a shape: " + one);
    }
  }

  static double deepest(const std::vector<DepthMm>& shapes, const Vec3& p_mm) {
    double most = -1e9;
    for (const DepthMm& one : shapes) most = std::max(most, one(p_mm));
    return most;
  }

  void cut_brick(volume::BrickIndex brick) {
    const volume::Field* was = after_->brick_field(brick);
    if (was == nullptr) return;
    volume::BrickField now;
    std::memcpy(now.voxel, was, sizeof now.voxel);
    const math::Ijk first = after_->brick_ijk(brick);
    const volume::Grid& grid = after_->grid();
    bool changed = false;
    for (int n = 0; n < volume::kBrickVoxels; ++n) {
      const math::Ijk at = first + math::Ijk(n & 7, (n >> 3) & 7, n >> 6);
      const Vec3 p = grid.world_from_grid(at.cast<double>()) * 1e3;
      const double depth =
          std::max(deepest(holes_, p), std::min(deepest(cut_, p), -deepest(kept_, p)));
      const volume::Field left = volume::field_from_depth(-depth / (grid.voxel * 1e3));
      changed = changed || left < now.voxel[n];
      now.voxel[n] = std::min(now.voxel[n], left);
    }
    if (changed) after_->write_brick(brick, now);
  }

  NoProgress quiet_;
  Rubric rubric_;
  scenario::Case work_;
  scenario::CaseLesson lesson_;
  scenario::BoneRecipe recipe_;
  std::unique_ptr<volume::Bone> before_, after_;
  std::vector<DepthMm> cut_, kept_, holes_;
  std::vector<Outcome> outcomes_;
};

// The shapes of a bone in the shared data, by the name that begins its line; "": it is not there.
inline std::string known_line(const std::string& file, const std::string& name) {
  std::ifstream in(burr::test::data_dir() / "known_bones" / file);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(name, 0) == 0) return line.substr(line.find('|') + 1);
  return {};
}

}  // namespace burr::scoring::test
