// A headset with a runtime that enforces OpenXR's specification; its pictures are compared with
// geometry and with the renderer's own pictures.
#include "burr/render/headset.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "render/formula_surfaces.h"
#include "render/gpu.h"
#include "render/openxr/worn.h"

namespace burr::render {
namespace {

using math::Vec3;
using test::FakeXr;
using test::Worn;

// a small blue ball where the middle camera looks, and a larger one of bone to the left behind it
Scene two_balls() {
  Scene scene;
  scene.look.background_top = scene.look.background_bottom = {1, 1, 1};
  scene.look.plain = true;
  scene.tissue_colours = {{1, 1, 1}, {0, 0, 1}, {1, 0, 0}};
  scene.camera.target = {0.01, 0.02, 0.03};
  scene.camera.azimuth = 0.4;
  scene.camera.elevation = 0.2;
  scene.camera.distance = 0.2;
  const Camera& c = scene.camera;
  set_patch(scene, 0, test::ball(c.target, 0.004, 24, 1));
  set_patch(scene, 1, test::ball(c.target - 0.06 * c.backward() - 0.03 * c.right(), 0.008, 24, 2));
  return scene;
}

class OnTheHead {
 public:
  OnTheHead(Headset& headset, const Scene& scene) : headset_(headset), scene_(scene) {}

  // runs frames until it holds; false: it never does
  bool until(const std::function<bool()>& holds) {
    for (int n = 0; n < 400; ++n) {
      frame();
      if (holds()) return true;
    }
    return false;
  }
  bool frame() {
    const auto now = headset_.begin(0.05);
    if (!now) return false;
    now_ = *now;
    for (std::size_t eye = 0; eye < 2; ++eye)
      cameras_[eye] = placed(scene_.camera, now->room_from_eye[eye]);
    headset_.end(scene_, cameras_);
    return true;
  }
  // waits for this many more frames with pictures
  bool pictures(Worn& worn, int more) {
    const int from = worn.xr().with_pictures;
    return until([&] { return worn.xr().with_pictures >= from + more; });
  }
  [[nodiscard]] const Headset::Now& now() const { return now_; }
  [[nodiscard]] const std::array<Camera, 2>& cameras() const { return cameras_; }

 private:
  Headset& headset_;
  const Scene& scene_;
  Headset::Now now_;
  std::array<Camera, 2> cameras_;
};

// middle of the blue (or red) pixels, from the top left [pixel]
Eigen::Vector2d middle_of(const FakeXr::Picture& picture, std::size_t channel) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      const std::uint8_t* rgb =
          &picture
               .rgba[static_cast<std::size_t>(4 * ((picture.height - 1 - y) * picture.width + x))];
      if (rgb[channel] < 2 * rgb[2 - channel] + 20) continue;
      sum += Eigen::Vector2d(x + 0.5, y + 0.5);
      ++count;
    }
  return sum / count;
}

// the position of a point of the room in an eye's picture, from the angles that the runtime gave
Eigen::Vector2d seen(const FakeXr& xr, std::size_t eye, const XrPosef& pose, const Vec3& p) {
  const math::Quat q(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                     pose.orientation.z);
  const Vec3 v = q.conjugate() * (p - Vec3(pose.position.x, pose.position.y, pose.position.z));
  const XrFovf& fov = xr.fov[eye];
  const double l = std::tan(fov.angleLeft), r = std::tan(fov.angleRight);
  const double d = std::tan(fov.angleDown), u = std::tan(fov.angleUp);
  return {(v.x() / -v.z() - l) / (r - l) * xr.width, (u - v.y() / -v.z()) / (u - d) * xr.height};
}
// the balls of two_balls() in the room: half a metre ahead for 0.2 m
const Vec3 kBlue(0, 0, -0.5), kRed(-0.03 * 2.5, 0, -0.5 - 0.06 * 2.5);

// the largest difference of a colour
int worst(const FakeXr::Picture& picture, const Image& image) {
  int most = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        most = std::max(
            most,
            std::abs(int{picture.rgba[static_cast<std::size_t>(
                         4 * ((image.height - 1 - y) * image.width + x) + c)]} -
                     int{image.rgb[static_cast<std::size_t>(3 * (y * image.width + x) + c)]}));
  return most;
}

#define PUT_ON(headset)                                           \
  auto headset##_or_why = Headset::start(gpu, false);             \
  ASSERT_TRUE(headset##_or_why) << headset##_or_why.error().text; \
  Headset& headset = **headset##_or_why

// ---- missing runtime or headset

TEST(NoHeadset, IsSaidInOneSentenceWithTheRemedy) {
  BURR_NEEDS_GPU(gpu);
  const auto why = [&gpu] {
    const auto headset = Headset::start(gpu, false);
    return headset ? std::string("there is one") : headset.error().text;
  };
  ::setenv("BURR_OPENXR_LOADER", "/nowhere/libopenxr_loader.so.1", 1);
  EXPECT_EQ(why(),
            "no headset: /nowhere/libopenxr_loader.so.1 cannot be loaded; install "
            "libopenxr-loader1 and the headset's runtime, such as Monado");
  ::setenv("BURR_OPENXR_LOADER", "libm.so.6", 1);
  EXPECT_NE(why().find("libm.so.6 is not an OpenXR loader; install"), std::string::npos) << why();
  ::unsetenv("BURR_OPENXR_LOADER");
  Worn worn;
  worn.xr().no_runtime = true;
  EXPECT_NE(why().find("finds no runtime; install and start"), std::string::npos) << why();
  worn.xr().no_runtime = false;
  worn.xr().no_opengl = true;
  EXPECT_NE(why().find("does not offer XR_KHR_opengl_enable"), std::string::npos) << why();
  worn.xr().no_opengl = false;
  worn.xr().no_headset = true;
  EXPECT_NE(why().find("finds none; connect the headset"), std::string::npos) << why();
  EXPECT_EQ(worn.xr().instances, 0) << "left behind";
  worn.xr().no_headset = false;
  EXPECT_EQ(why(), "there is one");
  EXPECT_EQ(worn.xr().sessions, 0) << "left behind";
}

// ---- pictures

TEST(Headset, EachEyeSeesWhatStandsWhereTheRoomHasIt) {
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  PUT_ON(headset);
  EXPECT_EQ(headset.name(), "Fake headset");
  const Scene scene = two_balls();
  OnTheHead head(headset, scene);
  const FakeXr& xr = worn.xr();
  // straight ahead; turned, tilted and elsewhere; upside down
  const float s = std::sqrt(0.5F);
  const XrPosef poses[] = {{{0, 0, 0, 1}, {0, 0, 0}},
                           {{0.05F, -0.1F, 0.15F, 0.98234414F}, {0.06F, 0.04F, -0.1F}},
                           {{0, 0, s, s}, {0, 0.05F, 0.1F}}};
  for (const XrPosef& pose : poses) {
    worn.change([&](FakeXr& x) { x.head = pose; });
    ASSERT_TRUE(head.pictures(worn, 2));
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const FakeXr::Picture& picture = xr.pictures[eye];
      EXPECT_LT((middle_of(picture, 2) - seen(xr, eye, picture.pose, kBlue)).norm(), 0.7) << eye;
      EXPECT_LT((middle_of(picture, 0) - seen(xr, eye, picture.pose, kRed)).norm(), 0.7) << eye;
    }
  }
}

TEST(Headset, EyesPartByTheRightParallaxAndAreNotSwapped) {
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  // the same angles for both eyes, so that the only difference is parallax
  worn.xr().fov = {{{-0.7F, 0.7F, 0.7F, -0.7F}, {-0.7F, 0.7F, 0.7F, -0.7F}}};
  PUT_ON(headset);
  const Scene scene = two_balls();
  OnTheHead head(headset, scene);
  ASSERT_TRUE(head.pictures(worn, 1));
  const auto& eyes = worn.xr().pictures;
  EXPECT_NE(eyes[0].rgba, eyes[1].rgba);
  const double per_tangent = 320 / (2 * std::tan(0.7));
  const double blue = middle_of(eyes[0], 2).x() - middle_of(eyes[1], 2).x();
  const double red = middle_of(eyes[0], 0).x() - middle_of(eyes[1], 0).x();
  EXPECT_NEAR(blue, per_tangent * 0.064 / 0.5, 0.7) << "the left eye sees it farther to the right";
  EXPECT_NEAR(red, per_tangent * 0.064 / 0.65, 0.7) << "and less so what is farther away";
  EXPECT_NEAR(middle_of(eyes[0], 2).y(), middle_of(eyes[1], 2).y(), 0.1);
}

TEST(Headset, PicturesAreTheRenderersOwnWhateverTheWindowShowsBetween) {
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  PUT_ON(headset);
  Scene scene = two_balls();
  scene.look = Look();
  scene.look.background_top = {0.2F, 0.3F, 0.4F};
  OnTheHead head(headset, scene);
  gpu.resize_offscreen(200, 170);
  auto other = Renderer::offscreen();
  ASSERT_TRUE(other);
  for (int n = 0; n < 3; ++n) {
    // bone changes in front of a head at rest: only that part is redrawn, for each eye
    if (n > 0) set_patch(scene, 0, test::ball(scene.camera.target, 0.004 + 0.002 * n, 24, 1));
    TwoEyes eyes;
    eyes.how = n == 1 ? Stereo::anaglyph : Stereo::off;
    eyes.eye_distance = 0.01;
    ASSERT_TRUE(gpu.show(scene, eyes));
    ASSERT_TRUE(head.pictures(worn, 2));
    for (std::size_t eye = 0; eye < 2; ++eye) {
      Scene seen = scene;
      seen.camera = head.cameras()[eye];
      const auto right = (*other)->image(seen, 320, 300);
      ASSERT_TRUE(right);
      EXPECT_LE(worst(worn.xr().pictures[eye], *right), 2) << "eye " << eye << ", change " << n;
    }
    ASSERT_TRUE(gpu.show(scene));
    const auto plain = (*other)->image(scene, 200, 170);
    ASSERT_TRUE(plain);
    EXPECT_EQ(gpu.shown().rgb, plain->rgb) << "the window's own picture";
  }
}

TEST(Headset, FramesAreEndedThoughThereIsNothingToShow) {
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  PUT_ON(headset);
  const Scene scene = two_balls();
  OnTheHead head(headset, scene);
  ASSERT_TRUE(head.pictures(worn, 2));
  const auto nothing_shown = [&] {
    const int ended = worn.xr().ended, with = worn.xr().with_pictures;
    EXPECT_TRUE(head.until([&] { return worn.xr().ended >= ended + 3; }));
    return worn.xr().with_pictures == with && !head.now().eyes;
  };
  worn.change([](FakeXr& xr) { xr.views_known = false; });
  EXPECT_TRUE(nothing_shown());
  worn.change([](FakeXr& xr) {
    xr.views_known = true;
    xr.head.position.x = std::numeric_limits<float>::quiet_NaN();
  });
  EXPECT_TRUE(nothing_shown()) << "an eye nowhere";
  worn.change([](FakeXr& xr) {
    xr.head.position.x = 0;
    xr.shows = false;
  });
  EXPECT_TRUE(nothing_shown()) << "nobody looks";
  worn.change([](FakeXr& xr) { xr.shows = true; });
  EXPECT_TRUE(head.pictures(worn, 2));
  EXPECT_FALSE(headset.over());
  EXPECT_EQ(worn.xr().begun, worn.xr().ended);
}

// ---- the wand

TEST(Headset, WandIsWhereTheRuntimeSaysAndItsTriggerPulls) {
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  PUT_ON(headset);
  const Scene scene = two_balls();
  OnTheHead head(headset, scene);
  worn.xr().trigger = 0.75F;
  ASSERT_TRUE(head.until([&] { return head.now().wand.tracked; }));
  EXPECT_LT((head.now().wand.room_from_wand.p - Vec3(0.1, -0.1, -0.4)).norm(), 1e-6);
  EXPECT_NEAR(head.now().wand.trigger, 0.75, 1e-6);
  // the same place in the world as in the picture: along the axes of the window's camera
  const Camera& c = scene.camera;
  const math::Pose world = placed(c, head.now().wand.room_from_wand);
  const Vec3 wanted = c.eye() + 0.4 * (0.1 * c.right() - 0.1 * c.above() - 0.4 * c.backward());
  EXPECT_LT((world.p - wanted).norm(), 1e-6);
  EXPECT_LT((world.q * Vec3::UnitZ() - c.backward()).norm(), 1e-6) << "its back is the handle";
  worn.change([](FakeXr& xr) { xr.wand_tracked = false; });
  EXPECT_TRUE(head.until([&] { return !head.now().wand.tracked; }));
  worn.change([](FakeXr& xr) { xr.wand_tracked = true; });
  EXPECT_TRUE(head.until([&] { return head.now().wand.tracked; }));
  // another program's menu has the input of the hands
  worn.xr().happens(XR_SESSION_STATE_VISIBLE);
  EXPECT_TRUE(head.until([&] { return !head.now().wand.tracked; }));
}

TEST(Headset, ControllerVibratesWithTheForceAndWithinItsBounds) {
  EXPECT_EQ(vibration_of(0), 0);
  EXPECT_EQ(vibration_of(0.04), 0);
  EXPECT_EQ(vibration_of(-1), 0);
  EXPECT_EQ(vibration_of(std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_NEAR(vibration_of(1.5), kMostVibration / 2, 1e-12);
  EXPECT_EQ(vibration_of(std::numeric_limits<double>::infinity()), kMostVibration);
  for (double force = 0; force < 20; force += 0.01)
    EXPECT_GE(vibration_of(force + 0.01), vibration_of(force));
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  PUT_ON(headset);
  const Scene scene = two_balls();
  OnTheHead head(headset, scene);
  headset.vibrate(0.5);  // nothing before the session has the input of the hands
  EXPECT_EQ(worn.xr().applied, 0);
  ASSERT_TRUE(head.until([&] { return head.now().wand.tracked; }));
  headset.vibrate(0.5);
  EXPECT_NEAR(worn.xr().vibrates, 0.5, 1e-6);
  EXPECT_NEAR(worn.xr().vibrates_for, Headset::kVibrates, 1e-9) << "it ends by itself";
  headset.vibrate(7);
  EXPECT_EQ(worn.xr().vibrates, 1.0F);
  headset.vibrate(0);
  EXPECT_EQ(worn.xr().vibrates, 0.0F);
  EXPECT_EQ(worn.xr().stopped, 1);
  headset.vibrate(0);
  headset.vibrate(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(worn.xr().stopped, 1) << "what is still is not stopped again";
  const int before = worn.xr().applied;
  worn.xr().happens(XR_SESSION_STATE_VISIBLE);
  ASSERT_TRUE(head.until([&] { return !head.now().wand.tracked; }));
  headset.vibrate(0.5);
  EXPECT_EQ(worn.xr().applied, before);
}

TEST(Headset, PenIsAHandWhereTheRuntimeKnowsIt) {
  BURR_NEEDS_GPU(gpu);
  {
    Worn worn;
    worn.xr().pen = true;
    PUT_ON(headset);
    EXPECT_EQ(worn.xr().bound,
              (std::vector<std::string>{"/user/hand/right/input/tip_logitech/pose",
                                        "/user/hand/right/input/cluster_middle_logitech/force",
                                        "/user/hand/right/output/haptic"}));
    const Scene scene = two_balls();
    OnTheHead head(headset, scene);
    worn.xr().trigger = 0.4F;
    ASSERT_TRUE(head.until([&] { return head.now().wand.tracked; }));
    EXPECT_NEAR(head.now().wand.trigger, 0.4, 1e-6);
    headset.vibrate(0.3);
    EXPECT_NEAR(worn.xr().vibrates, 0.3, 1e-6);
  }
  Worn worn;  // a runtime that does not know it is not asked for it
  PUT_ON(headset);
  EXPECT_FALSE(headset.over());
  EXPECT_EQ(worn.xr().bound.size(), 6U);
}

TEST(Headset, RuntimeThatCannotVibrateIsUsedWithoutAndSaysSoOnce) {
  BURR_NEEDS_GPU(gpu);
  const Scene scene = two_balls();
  const auto goes_on = [&scene](Headset& headset, Worn& worn) {
    OnTheHead head(headset, scene);
    EXPECT_TRUE(head.until([&] { return head.now().wand.tracked; }));
    headset.vibrate(0.5);
    headset.vibrate(0);
    EXPECT_TRUE(head.pictures(worn, 2));
    EXPECT_FALSE(headset.over()) << headset.why();
    EXPECT_EQ(worn.xr().applied, 0);
    const std::string missing = headset.take_missing();
    EXPECT_NE(missing.find("does not let the controller vibrate"), std::string::npos) << missing;
    EXPECT_EQ(headset.take_missing(), "");
  };
  {
    Worn worn;
    worn.xr().no_haptics = true;
    PUT_ON(headset);
    goes_on(headset, worn);
    EXPECT_EQ(worn.xr().bound.size(), 4U) << "pose and trigger of two kinds";
  }
  {
    Worn worn;
    worn.xr().no_haptic_path = true;
    PUT_ON(headset);
    goes_on(headset, worn);
  }
  Worn worn;
  worn.xr().haptic_answer = XR_ERROR_RUNTIME_FAILURE;
  PUT_ON(headset);
  EXPECT_EQ(headset.take_missing(), "") << "it is not known yet";
  goes_on(headset, worn);
}

// ---- connecting and disconnecting

TEST(Headset, TakenOffAndPutOnAgain) {
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  {
    PUT_ON(headset);
    const Scene scene = two_balls();
    OnTheHead head(headset, scene);
    ASSERT_TRUE(head.pictures(worn, 2));
    worn.xr().happens(XR_SESSION_STATE_STOPPING);
    ASSERT_TRUE(head.until([&] { return !headset.running(); }));
    const int ended = worn.xr().ended;
    EXPECT_FALSE(head.frame());
    EXPECT_EQ(worn.xr().ended, ended);
    EXPECT_FALSE(headset.over());
    worn.xr().happens(XR_SESSION_STATE_READY);
    EXPECT_TRUE(head.pictures(worn, 2));
  }
  EXPECT_EQ(worn.xr().instances, 0);
  EXPECT_EQ(worn.xr().sessions, 0);
}

TEST(Headset, LossIsTheEndOfItAndNothingElse) {
  BURR_NEEDS_GPU(gpu);
  const std::function<void(Worn&)> losses[] = {
      [](Worn& worn) { worn.xr().happens(XR_SESSION_STATE_LOSS_PENDING); },
      [](Worn& worn) { worn.xr().happens(XR_SESSION_STATE_EXITING); },
      [](Worn& worn) { worn.change([](FakeXr& xr) { xr.instance_loss_pending = true; }); },
      [](Worn& worn) { worn.change([](FakeXr& xr) { xr.instance_lost = true; }); }};
  for (const auto& lose : losses) {
    Worn worn;
    PUT_ON(headset);
    const Scene scene = two_balls();
    OnTheHead head(headset, scene);
    ASSERT_TRUE(head.pictures(worn, 1));
    lose(worn);
    EXPECT_TRUE(head.until([&] { return headset.over(); }));
    EXPECT_NE(headset.why().find("the window continues"), std::string::npos) << headset.why();
    EXPECT_FALSE(head.frame());
    EXPECT_TRUE(gpu.show(scene));
  }
}

TEST(Headset, RuntimeThatHangsHoldsNothingUp) {
  BURR_NEEDS_GPU(gpu);
  Worn worn;
  const auto began = std::chrono::steady_clock::now();
  {
    PUT_ON(headset);
    const Scene scene = two_balls();
    OnTheHead head(headset, scene);
    ASSERT_TRUE(head.pictures(worn, 1));
    worn.change([](FakeXr& xr) { xr.hangs = true; });
    for (int n = 0; n < 5; ++n) static_cast<void>(head.frame());
    EXPECT_FALSE(head.frame());
    EXPECT_TRUE(gpu.show(scene));
  }
  // generous: it is enough that it comes back
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(60));
}

}  // namespace
}  // namespace burr::render
