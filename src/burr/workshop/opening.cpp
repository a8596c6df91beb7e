#include "burr/workshop/opening.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "burr/scenario/open_lesson.h"
#include "burr/scenario/recipe.h"
#include "burr/workshop/label_check.h"

namespace burr::workshop {

using math::Vec3;

namespace {

constexpr double kWithoutSteps = 18e-3, kSpare = 2e-3;

// "tooth" of "tooth?graded"
struct Ball {
  Vec3 at;
  double radius;
};

void add_shape(const scenario::Shape& shape, std::vector<Ball>& balls) {
  using scenario::ShapeKind;
  switch (shape.kind) {
    case ShapeKind::ball:
      balls.push_back({shape.a.at, shape.radius});
      return;
    case ShapeKind::capsule:
      balls.push_back({shape.a.at, shape.radius});
      balls.push_back({shape.b.at, shape.radius});
      return;
    case ShapeKind::box:
      balls.push_back({shape.a.at, 0.5 * shape.size.norm()});
      return;
    case ShapeKind::tube: {
      const double last = static_cast<double>(shape.points.size()) - 1;
      for (double n = std::floor(shape.from * last); n <= std::ceil(shape.to * last) && n <= last;
           ++n)
        balls.push_back({shape.points[static_cast<std::size_t>(std::max(n, 0.0))], shape.radius});
      return;
    }
    case ShapeKind::half_space:
    case ShapeKind::within:
    case ShapeKind::between:
      return;  // bounded by others
  }
}

void add_named(const std::string& name, const scenario::CaseLesson& lesson,
               std::vector<Ball>& balls) {
  if (const scenario::CaseRegion* region = lesson.region(name))
    for (const scenario::Shape& shape : region->add) add_shape(shape, balls);
  // a curve is for orientation: a line on the bone that skin may cover
  const scenario::Landmark* place = lesson.landmark(name);
  if (place != nullptr && place->points.size() == 1) balls.push_back({place->points.front(), 0});
}

}  // namespace

std::optional<render::Opening> opening_of(const scenario::Case& work,
                                          const scenario::CaseLesson* lesson) {
  if (!work.at || !work.into) return std::nullopt;
  const std::string phantom = scenario::without_variant(work.phantom);
  if (phantom == "block" || phantom == "ball" || phantom == "tooth") return std::nullopt;
  render::Opening opening{*work.at, -work.into->normalized(), kWithoutSteps};
  if (lesson == nullptr || lesson->steps.empty()) return opening;

  std::vector<Ball> balls = {{*work.at, 8e-3}};
  for (const scenario::Step& step : lesson->steps) {
    if (!step.region.empty()) add_named(step.region, *lesson, balls);
    for (const std::string& name : step.show) add_named(name, *lesson, balls);
  }
  const render::DrapeAxes axes = render::axes_of(opening);
  math::Aabb around;  // x to the right, y up
  const auto seen = [&](const Vec3& p) {
    const Vec3 d = p - *work.at;
    return Vec3(d.dot(axes.right), d.dot(axes.up), 0);
  };
  for (const Ball& ball : balls) {
    around.extend(seen(ball.at) - Vec3(ball.radius, ball.radius, 0));
    around.extend(seen(ball.at) + Vec3(ball.radius, ball.radius, 0));
  }
  const Vec3 middle = around.centre();
  opening.radius = 0;
  for (const Ball& ball : balls)
    opening.radius =
        std::max(opening.radius, (seen(ball.at) - middle).norm() + ball.radius + kSpare);
  opening.centre += middle.x() * axes.right + middle.y() * axes.up;
  return opening;
}

std::optional<render::Opening> opening_of(const scenario::Case& work) {
  auto read = scenario::lesson_of(work);
  if (!read) return std::nullopt;
  const auto lesson = scenario::place(std::move(*read), landmarks_of(work), work.name);
  return lesson ? opening_of(work, &*lesson) : std::nullopt;
}

std::optional<render::Opening> opening_of_phantom(const std::string& source) {
  const std::string phantom = scenario::without_variant(scenario::phantom_name(source));
  if (phantom.empty()) return std::nullopt;
  for (const std::string& name : scenario::built_in_cases())
    if (const auto work = scenario::read_case(name);
        work && scenario::without_variant(work->phantom) == phantom)
      return opening_of(*work);
  return std::nullopt;
}

}  // namespace burr::workshop
