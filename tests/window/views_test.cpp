// The four views: where a session begins, what each key shows, and that nothing covers the work.
#include "window/mill/work_views.h"

#include <cmath>
#include <random>

#include "burr/render/microscope.h"
#include "burr/scenario/open_lesson.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/opening.h"
#include "burr/workshop/seen.h"
#include "user.h"
#include "window/mill/step_light.h"

namespace burr::app {
namespace {

using math::Vec3;

std::optional<scenario::CaseLesson> placed_lesson_of(const scenario::Case& work) {
  auto read = scenario::lesson_of(work);
  if (!read) return std::nullopt;
  auto placed = scenario::place(std::move(*read), workshop::landmarks_of(work), work.name);
  return placed ? std::optional(std::move(*placed)) : std::nullopt;
}

TEST(Opening, HoldsAllThatTheStepsOfACaseLight) {
  int with = 0;
  for (const std::string& name : scenario::built_in_cases()) {
    SCOPED_TRACE(name);
    const auto work = scenario::read_case(name);
    ASSERT_TRUE(work) << work.error().text;
    const auto lesson = placed_lesson_of(*work);
    ASSERT_TRUE(lesson);
    const auto opening = workshop::opening_of(*work, &*lesson);
    if (!opening) continue;
    ++with;
    EXPECT_LT(opening->radius, 60e-3) << "hardly a wound";
    const auto off_axis = [&](const Vec3& p) {
      const Vec3 d = p - opening->centre;
      return (d - d.dot(opening->outward) * opening->outward).norm();
    };
    EXPECT_LT(off_axis(*work->at) + 5e-3, opening->radius);
    for (const scenario::Step& step : lesson->steps)
      for (const guidance::StepMark& ring : guidance::marks_of(step, *lesson, {}, nullptr).marks) {
        // a landmark that is a line may go on under the skin
        const scenario::Landmark* place = lesson->landmark(ring.name);
        if (ring.radius < 1e-3 && (place == nullptr || place->points.size() > 1)) continue;
        EXPECT_LE(off_axis(ring.at) + (ring.radius < 1e-3 ? 0 : ring.radius), opening->radius)
            << step.id << ": " << ring.name;
      }
    std::printf("%s: opening %.1f mm in radius\n", name.c_str(), 1e3 * opening->radius);
  }
  EXPECT_GE(with, 2);
}

TEST(Seen, GivesBackTheCameraThatWasRecorded) {
  const unsigned seed = 24;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<record::View> views;
  for (int n = 0; n < 300; ++n) {
    render::Camera camera =
        n % 2 == 0 ? render::microscope_view(0.1 * Vec3(any(random), any(random), any(random)),
                                             Vec3(any(random), any(random), any(random)), 16e-3)
                   : render::view_of_work(0.1 * Vec3(any(random), any(random), any(random)),
                                          Vec3(any(random), any(random), any(random)), 50e-3);
    const record::View view = workshop::view_of(camera, static_cast<std::uint64_t>(10 * n + 5));
    const render::Camera back = workshop::camera_of(view);
    EXPECT_LT((back.eye() - camera.eye()).norm(), 1e-9);
    EXPECT_LT((back.target - camera.target).norm(), 1e-9);
    EXPECT_LT((back.right() - camera.right()).norm(), 1e-6);
    EXPECT_NEAR(back.view_height(), camera.view_height(), 1e-9);
    EXPECT_EQ(render::is_microscope(back), n % 2 == 0);
    views.push_back(view);
  }
  EXPECT_EQ(workshop::view_at({}, 7), nullptr);
  EXPECT_EQ(workshop::view_at(views, 0), &views[0]);
  EXPECT_EQ(workshop::view_at(views, 14), &views[0]);
  EXPECT_EQ(workshop::view_at(views, 15), &views[1]);
  EXPECT_EQ(workshop::view_at(views, 1'000'000), &views.back());
}

class ViewsWindow : public Window {
 protected:
  static Result<WindowSession> bone() {
    WorkOptions options;
    options.volume.source = "temporal-bone";
    options.volume.voxel_mm = 0.6;
    NoProgress quiet;
    if (const Status taken = take_case(options); !taken) return taken.error();
    return open_ready(options, quiet);
  }
  void mill_case(WindowSession& ready, std::vector<Script::Step> steps) {
    Script script(std::move(steps), desk_->status_text);
    desk_->after_frame = [&script] { script.look(); };
    WindowOptions options;
    options.work_case = ready.work_case;
    options.lesson = ready.lesson;
    const auto left =
        mill(*desk_, *ready.session, ready.hands, *ready.worker, ready.scene, options);
    desk_->after_frame = {};
    ASSERT_TRUE(left) << left.error().text;
    EXPECT_TRUE(script.finished());
  }
};

TEST_F(ViewsWindow, ACaseBeginsAtItsEntryUnderTheMicroscope) {
  auto ready = bone();
  ASSERT_TRUE(ready) << ready.error().text;
  const render::Scene& scene = ready->scene;
  const auto field = [&] { return scene.camera.view_height(); };
  const auto drawn = [&](double height) { return std::abs(field() - height) < 1e-6; };
  mill_case(
      *ready,
      {{"microscope", [&] { return drawn(25e-3) && scene.drape != nullptr; },
        [&] {
          EXPECT_GT(scene.vignette, 0);
          EXPECT_NEAR((scene.camera.target - *ready->work_case->at).norm(), 0, 1e-9);
          EXPECT_GT(scene.look.key.towards.normalized().z(), 0.93) << "the lamp is beside the eye";
          turn_wheel(1);
        }},
       {"a step nearer", [&] { return drawn(20e-3); },
        [&] {
          EXPECT_FALSE(scene.focus) << "without a graphics card it is off at first";
          press(SDLK_F9, KMOD_SHIFT);
        }},
       {"depth of field",
        [&] { return scene.focus && scene.focus->distance == scene.camera.distance; },
        [] { press(SDLK_F12, KMOD_CTRL); }},
       {"sharp farther away",
        [&] { return std::abs(scene.focus->distance - scene.camera.distance - 0.5e-3) < 1e-9; },
        [] { press(SDLK_F9, KMOD_SHIFT); }},
       {"everything sharp", [&] { return !scene.focus; }, [] { turn_wheel(-3); }},
       {"wider", [&] { return drawn(42e-3); }, [] { press(SDLK_t); }},
       {"see-through: nothing covers", [&] { return scene.look.opacity < 1 && !scene.drape; },
        [] { press(SDLK_t, KMOD_SHIFT); }},
       {"back", [&] { return scene.drape != nullptr; }, [] { press(SDLK_F11); }},
       {"whole", [&] { return field() > 60e-3 && scene.drape == nullptr; },
        [&] {
          EXPECT_EQ(scene.vignette, 0);
          EXPECT_LT(scene.look.key.towards.normalized().z(), 0.9);
          press(SDLK_F9);
        }},
       {"microscope as it was left", [&] { return drawn(42e-3) && scene.drape != nullptr; },
        [] { press(SDLK_F12); }},
       {"endoscope", [&] { return scene.round && scene.camera.field_of_view > 1; },
        [&] {
          EXPECT_TRUE(scene.drape == nullptr);
          press(SDLK_F11, KMOD_SHIFT);
        }},
       {"free", [&] { return !scene.round && std::abs(scene.camera.field_of_view - 0.5) < 1e-9; },
        [] { press(SDLK_f); }},
       {"first view", [&] { return drawn(25e-3) && scene.drape != nullptr; },
        [] { close_window(); }}});
  EXPECT_TRUE(scene.drape == nullptr) << "pictures after the session have no cloth over the bone";
  EXPECT_EQ(scene.vignette, 0);
}

TEST_F(ViewsWindow, ABoneWithoutACaseBeginsWhole) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  const double bone = render::bounds(ready->scene).extent().maxCoeff();
  mill_by(*ready, {{"whole", looks(3), [&] {
                      EXPECT_GT(ready->scene.camera.view_height(), 0.7 * bone);
                      EXPECT_EQ(ready->scene.vignette, 0);
                      EXPECT_TRUE(ready->scene.drape == nullptr);
                      close_window();
                    }}});
}

}  // namespace
}  // namespace burr::app
