#include "burr/render/picture.h"

#include <gtest/gtest.h>
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <optional>
#include <random>

#include "burr/math/rotation.h"
#include "burr/render/bone_scene.h"
#include "burr/render/pick.h"
#include "render/formula_surfaces.h"
#include "render/gpu.h"
#include "support/folder.h"

namespace burr::render {
namespace {

using math::Vec3;

constexpr double kPi = std::numbers::pi;
constexpr Colour kGrey = {0.6F, 0.6F, 0.6F};

// only Lambert with a light at the eye, on black: the picture can be calculated
Look plain_look() {
  Look look;
  look.plain = true;
  look.background_top = look.background_bottom = {0, 0, 0};
  return look;
}

Scene ball_scene(const Vec3& centre, double radius, int steps) {
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, kGrey, {0.8F, 0.2F, 0.2F}};
  set_patch(scene, 0, test::ball(centre, radius, steps));
  scene.camera.target = centre;
  scene.camera.distance = 0.2;
  scene.look = plain_look();
  return scene;
}

Scene bumpy_scene(int n = 5, int steps = 160) {
  Scene scene;
  scene.tissue_colours = {{0, 0, 0}, {0.89F, 0.85F, 0.76F}, {0.9F, 0.75F, 0.35F}};
  auto parts = test::cut(test::bumpy(0.05, steps), n);
  for (std::size_t i = 0; i < parts.size(); ++i) set_patch(scene, static_cast<int>(i), parts[i]);
  scene.camera = whole_view(scene, 0.4, 0.3, 1.5);
  return scene;
}

std::array<int, 3> pixel(const Image& image, int x, int y) {
  const auto at = static_cast<std::size_t>((y * image.width + x) * 3);
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

long lit_pixels(const Image& image) {
  long count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) count += pixel(image, x, y)[0] > 0;
  return count;
}

struct Difference {
  int largest = 0;
  double mean = 0;
};
Difference difference(const Image& a, const Image& b) {
  Difference d;
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  if (a.rgb.size() != b.rgb.size()) return {255, 255};
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const int by = std::abs(int{a.rgb[i]} - int{b.rgb[i]});
    d.largest = std::max(d.largest, by);
    d.mean += by;
  }
  d.mean /= static_cast<double>(a.rgb.size());
  return d;
}

TEST(Picture, NeedsNoDisplay) {
  const char* display = std::getenv("DISPLAY");
  const std::string before = display == nullptr ? "" : display;
  unsetenv("DISPLAY");
  BURR_NEEDS_GPU(gpu);
  EXPECT_FALSE(gpu.gpu().empty());
  const auto image = gpu.image(ball_scene(Vec3::Zero(), 0.03, 40), 64, 48);
  ASSERT_TRUE(image.ok()) << image.error().text;
  EXPECT_GT(lit_pixels(*image), 100);
  if (display != nullptr) setenv("DISPLAY", before.c_str(), 1);
}

TEST(Picture, ABallHasTheOutlineThatPerspectiveGivesIt) {
  BURR_NEEDS_GPU(gpu);
  const double radius = 0.03;
  const Scene scene = ball_scene({0.01, 0.02, -0.03}, radius, 200);
  const int height = 500;
  const auto image = gpu.image(scene, 700, height);
  ASSERT_TRUE(image.ok()) << image.error().text;

  // the cone that touches the ball, cut by the plane of the picture
  const double half_angle = std::asin(radius / scene.camera.distance);
  const double r = std::tan(half_angle) / std::tan(scene.camera.field_of_view / 2) * height / 2;
  EXPECT_NEAR(static_cast<double>(lit_pixels(*image)), kPi * r * r, 0.01 * kPi * r * r);
}

TEST(Picture, WhatLiesUnderThinBoneTintsIt) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(Vec3::Zero(), 0.03, 100);
  const auto middle = [&](volume::TissueId beneath, std::uint8_t through) {
    surface::Patch patch = test::ball(Vec3::Zero(), 0.03, 100);
    for (surface::Vertex& v : patch.vertices) {
      v.beneath = beneath;
      v.through = through;
    }
    set_patch(scene, 0, patch);
    const auto image = gpu.image(scene, 101, 101);
    EXPECT_TRUE(image.ok());
    return image.ok() ? pixel(*image, 50, 50) : std::array<int, 3>{};
  };
  // kGrey with a red at 0.8, 0.2, 0.2
  const double share = 102.0 / 255;
  const std::array<int, 3> tinted = middle(2, 102), bare = middle(2, 0);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(bare[c], 255 * 0.6, 1.5);
    EXPECT_NEAR(tinted[c], 255 * ((1 - share) * 0.6 + share * (c == 0 ? 0.8 : 0.2)), 2);
  }
}

TEST(Picture, BrightnessFollowsLambert) {
  BURR_NEEDS_GPU(gpu);
  const double radius = 0.03;
  const Scene scene = ball_scene(Vec3::Zero(), radius, 200);
  const int height = 401, width = 401;
  const auto image = gpu.image(scene, width, height);
  ASSERT_TRUE(image.ok()) << image.error().text;

  const auto linear = [](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  const auto srgb = [](double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
  };
  EXPECT_NEAR(pixel(*image, width / 2, height / 2)[0], 255 * 0.6, 1.5);
  for (int x = width / 2; x < width; x += 10) {
    const Ray ray = ray_through(scene.camera, x + 0.5, height / 2 + 0.5, width, height);
    const double b = ray.origin.dot(ray.direction);
    const double inside = b * b - ray.origin.squaredNorm() + radius * radius;
    if (inside < 1e-5) continue;  // the ball's edge
    const Vec3 n = (ray.origin - (b + std::sqrt(inside)) * ray.direction).normalized();
    const double facing = n.dot(scene.camera.backward());
    EXPECT_NEAR(pixel(*image, x, height / 2)[0], 255 * srgb(linear(0.6) * facing), 2) << x;
  }
}

TEST(Picture, CoreAndEsDrawTheSame) {
  BURR_NEEDS_GPU(gpu);
  auto es = Renderer::offscreen(Api::es);
  if (!es) GTEST_SKIP() << es.error().text;
  Scene scene = bumpy_scene();
  scene.burr.visible = true;
  scene.burr.world_from_tool.p = {0, -0.05, 0};
  scene.text = {"the same"};
  scene.scale_bar = true;
  const auto one = gpu.image(scene, 300, 200), two = (*es)->image(scene, 300, 200);
  ASSERT_TRUE(one.ok() && two.ok());
  EXPECT_LT(difference(*one, *two).mean, 0.02);
}

TEST(Picture, TilesMeetWithoutASeam) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = bumpy_scene();
  scene.scale_bar = true;
  scene.text = {"a line that crosses a tile's edge"};
  for (const bool half : {false, true})
    for (const int supersample : {1, 2}) {
      scene.look.occlusion_half = half;
      scene.look.supersample = supersample;
      const auto whole = gpu.image(scene, 450, 300), tiled = gpu.image(scene, 450, 300, 128);
      ASSERT_TRUE(whole.ok() && tiled.ok());
      // a vertex may fall on the other side of a sample; a seam would show along whole lines
      EXPECT_LT(difference(*whole, *tiled).mean, 0.05)
          << "half " << half << ", supersample " << supersample;
    }
}

TEST(Picture, LargerThanTheGpuHoldsIsStillOnePicture) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(Vec3::Zero(), 0.03, 200);
  const int width = 9000, height = 1000;
  const auto image = gpu.image(scene, width, height);
  ASSERT_TRUE(image.ok()) << image.error().text;
  const double r = std::tan(std::asin(0.03 / scene.camera.distance)) /
                   std::tan(scene.camera.field_of_view / 2) * height / 2;
  EXPECT_NEAR(static_cast<double>(lit_pixels(*image)), kPi * r * r, 0.01 * kPi * r * r);
}

TEST(Picture, WhatCannotBeDrawnIsRefusedWithASentence) {
  BURR_NEEDS_GPU(gpu);
  for (const auto& [width, height] : {std::pair{0, 10}, {10, -1}, {70'000, 10}}) {
    const auto image = gpu.image(Scene{}, width, height);
    ASSERT_FALSE(image.ok());
    EXPECT_EQ(image.error().trouble, Trouble::usage);
  }
  EXPECT_TRUE(gpu.image(Scene{}, 16, 16).ok()) << "an empty scene is a background";
}

TEST(Picture, TheBurrHidesWhatIsBehindItAndNothingElse) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(Vec3::Zero(), 0.03, 200);
  const auto bare = gpu.image(scene, 400, 400);

  // a burr in free air in front of the bone, its shaft to the right
  scene.burr.visible = true;
  scene.burr.radius = 5e-3;
  scene.burr.world_from_tool.p = {0, -0.045, 0};
  scene.burr.world_from_tool.q = math::shortest_rotation(Vec3::UnitZ(), Vec3::UnitX());
  const auto before = gpu.image(scene, 400, 400);
  scene.burr.world_from_tool.p = {0, 0.045, 0};
  const auto behind = gpu.image(scene, 400, 400);
  scene.burr.world_from_tool.p = Vec3::Zero();
  const auto inside = gpu.image(scene, 400, 400);
  ASSERT_TRUE(bare.ok() && before.ok() && behind.ok() && inside.ok());

  // pixels of the head: closer to the middle than its outline
  const double t = std::tan(scene.camera.field_of_view / 2);
  const double outline = std::tan(std::asin(5e-3 / (0.2 - 0.045))) / t * 200;
  const double bone = std::tan(std::asin(0.03 / 0.2)) / t * 200;
  for (int y = 0; y < 400; ++y)
    for (int x = 0; x < 400; ++x) {
      const double r = std::hypot(x + 0.5 - 200, y + 0.5 - 200);
      if (r < 0.8 * outline) {
        // flutes may be deep, but never as deep as the bone: only the edge of a flute is as bright
        ASSERT_NE(pixel(*before, x, y), pixel(*bare, x, y)) << x << " " << y;
      }
      const bool left_of_shaft = x < 200 - 1.1 * outline;
      if (left_of_shaft) {
        ASSERT_EQ(pixel(*before, x, y), pixel(*bare, x, y)) << x << " " << y;
      }
      if (r < 0.98 * bone) {
        ASSERT_EQ(pixel(*behind, x, y), pixel(*bare, x, y)) << x << " " << y;
        ASSERT_EQ(pixel(*inside, x, y), pixel(*bare, x, y)) << x << " " << y;
      }
    }
}

TEST(Picture, MarksOnTopAreSeenThroughBone) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(Vec3::Zero(), 0.03, 100);
  scene.markers.push_back({Vec3::Zero(), 4e-3, {0, 0, 1}, false});
  EXPECT_EQ(pixel(*gpu.image(scene, 100, 100), 50, 50)[2],
            pixel(*gpu.image(scene, 100, 100), 50, 50)[0]);
  scene.markers[0].on_top = true;
  const auto seen = pixel(*gpu.image(scene, 100, 100), 50, 50);
  EXPECT_EQ(seen[0], 0);
  EXPECT_GT(seen[2], 100);
}

TEST(Picture, TissuesHaveTheirColours) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(Vec3::Zero(), 0.03, 100);
  set_patch(scene, 0, test::ball(Vec3::Zero(), 0.03, 100, 2));
  EXPECT_EQ(pixel(*gpu.image(scene, 101, 101), 50, 50), (std::array{204, 51, 51}));
  scene.tissue_colours[2] = {0, 1, 0};
  EXPECT_EQ(pixel(*gpu.image(scene, 101, 101), 50, 50), (std::array{0, 255, 0}))
      << "other colours need no other mesh";
}

TEST(Picture, HollowsAreDarkerThanPlains) {
  BURR_NEEDS_GPU(gpu);
  // two balls that touch: dark where they meet, bright where nothing is near
  Scene scene = ball_scene(Vec3::Zero(), 0.02, 200);
  set_patch(scene, 1, test::ball({0.04, 0, 0}, 0.02, 200));
  scene.camera.target = {0.02, 0, 0};
  scene.look = Look{};
  scene.look.occlusion_half = false;
  scene.look.key.strength = scene.look.fill.strength = 0;
  scene.look.ambient = 1;
  const auto image = gpu.image(scene, 400, 300);
  ASSERT_TRUE(image.ok());
  scene.look.occlusion = 0;
  const auto flat = gpu.image(scene, 400, 300);
  ASSERT_TRUE(flat.ok());
  // the middle of the left ball, and a point near the contact
  const auto at = [&](const Image& in, double x) {
    return pixel(in, static_cast<int>(200 + (x - 0.02) / scene.camera.view_height() * 300), 150)[1];
  };
  EXPECT_GE(at(*image, 0.0), at(*flat, 0.0) - 6);
  EXPECT_LE(at(*image, 0.0185), at(*flat, 0.0185) - 25);
}

// ---- redrawing only what changed

// Compares a scene that changes here and there, drawn as it changes, with the same scene drawn
// whole each time.
void expect_no_difference_is_seen(Renderer& gpu, double scale) {
  auto other = Renderer::offscreen();
  ASSERT_TRUE(other.ok());
  for (Renderer* renderer : {&gpu, other->get()}) renderer->resize_offscreen(320, 240);

  Scene scene = bumpy_scene();
  scene.quality.scale = scale;
  scene.look.gloss = 0.3;
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(gpu.figures().patches_uploaded, static_cast<int>(scene.patches.size()));
  EXPECT_EQ(gpu.figures().redrawn, 1);
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_EQ(gpu.figures().patches_uploaded, 0);
  EXPECT_EQ(gpu.figures().redrawn, 0) << "nothing moved";

  const unsigned seed = 23;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  scene.burr.visible = true;
  scene.burr.radius = 4e-3;
  bool any_partial = false;
  for (int step = 0; step < 16; ++step) {
    // the burr moves; a patch here and there sinks a little or vanishes
    scene.burr.world_from_tool.p = Vec3(0.1 * uniform(random), -0.06, 0.1 * uniform(random));
    show_contact(scene, scene.burr.world_from_tool.p, scene.burr.world_from_tool.p,
                 Vec3(0, -1, uniform(random)));
    // now and then the eye moves too, nearer and farther: background becomes bone, and bone
    // background
    if (step % 3 == 1) orbit(scene.camera, uniform(random), 0.3 * uniform(random));
    if (step % 4 == 2) zoom(scene.camera, step % 8 == 2 ? 0.5 : 2);
    const auto which = static_cast<std::size_t>(random() % scene.patches.size());
    if (scene.patches[which].mesh != nullptr) {
      surface::Patch sunk = test::unpacked(*scene.patches[which].mesh);
      for (auto& v : sunk.vertices) v.p -= 1e-3F * v.n;
      if (step % 5 == 4) sunk = {};
      set_patch(scene, static_cast<int>(which), sunk);
    }
    ASSERT_TRUE(gpu.show(scene).ok());
    EXPECT_LE(gpu.figures().patches_uploaded, 1);
    any_partial = any_partial || gpu.figures().redrawn < 0.8;

    ASSERT_TRUE((*other)->show(Scene{}).ok());  // the renderer keeps nothing
    ASSERT_TRUE((*other)->show(scene).ok());
    // the scale of the depth depends on the bone's extent at the last whole drawing: rounding may
    // differ
    const Difference apart = difference(gpu.shown(), (*other)->shown());
    EXPECT_LE(apart.largest, 1) << "step " << step;
    EXPECT_LT(apart.mean, 5e-3) << "step " << step;
  }
  EXPECT_TRUE(any_partial) << "everything was drawn each time: this test proved nothing";
}

TEST(Picture, OnlyChangedPatchesAreSentAndNoDifferenceIsSeen) {
  BURR_NEEDS_GPU(gpu);
  expect_no_difference_is_seen(gpu, 1);
}

TEST(Picture, WhatIsStretchedOnlyInPartIsNotSeenEither) {
  BURR_NEEDS_GPU(gpu);
  expect_no_difference_is_seen(gpu, 0.75);
}

TEST(Picture, ABurrThatWasOverTheSkyLeavesNothingThereWhenTheEyeMoves) {
  BURR_NEEDS_GPU(gpu);
  auto other = Renderer::offscreen();
  ASSERT_TRUE(other.ok());
  for (Renderer* renderer : {&gpu, other->get()}) renderer->resize_offscreen(320, 240);
  Scene scene = bumpy_scene();
  zoom(scene.camera, 0.4);
  ASSERT_TRUE(gpu.show(scene).ok());
  scene.burr.visible = true;
  scene.burr.radius = 4e-3;
  const Vec3 forward = (scene.camera.target - scene.camera.eye()).normalized();
  const Vec3 right = forward.cross(Vec3::UnitZ()).normalized();
  scene.burr.world_from_tool.p = scene.camera.target - 0.13 * right;
  ASSERT_TRUE(gpu.show(scene).ok());
  EXPECT_LT(gpu.figures().redrawn, 0.8) << "all was drawn: this proves nothing";
  scene.burr.visible = false;
  orbit(scene.camera, 0.01, 0);
  ASSERT_TRUE(gpu.show(scene).ok());
  ASSERT_TRUE((*other)->show(scene).ok());
  EXPECT_LE(difference(gpu.shown(), (*other)->shown()).largest, 1);
}

TEST(Picture, PatchesOutOfSightOrTurnedAwayAreNotDrawn) {
  BURR_NEEDS_GPU(gpu);
  Scene scene = ball_scene(Vec3::Zero(), 0.03, 100);
  auto parts = test::cut(test::unpacked(*scene.patches[0].mesh), 8);
  for (std::size_t i = 0; i < parts.size(); ++i) set_patch(scene, static_cast<int>(i), parts[i]);
  ASSERT_TRUE(gpu.image(scene, 300, 200).ok());
  const long whole = gpu.figures().triangles_drawn;
  int all = 0;
  for (const auto& patch : scene.patches) all += patch.mesh != nullptr;
  EXPECT_LT(gpu.figures().patches_drawn, 0.8 * all) << "the back of the bone was drawn";
  zoom(scene.camera, 4);
  ASSERT_TRUE(gpu.image(scene, 300, 200).ok());
  EXPECT_LT(gpu.figures().triangles_drawn, whole / 2) << "what is beside the picture was drawn";
}

// ---- files

TEST(Picture, APngHoldsThePixelsAndNothingElse) {
  const test::Folder folder;
  std::mt19937 random(5);
  Image image{37, 23, {}};
  for (int i = 0; i < 37 * 23 * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(random()));
  const auto path = folder.path() / "noise.png";
  const Status written = write_png(image, path);
  ASSERT_TRUE(written.ok()) << written.error().text;

  int width = 0, height = 0, channels = 0;
  stbi_uc* back = stbi_load(path.c_str(), &width, &height, &channels, 3);
  ASSERT_NE(back, nullptr);
  EXPECT_EQ(width, 37);
  EXPECT_EQ(height, 23);
  EXPECT_EQ(channels, 3);
  EXPECT_TRUE(std::equal(image.rgb.begin(), image.rgb.end(), back));
  stbi_image_free(back);

  // chunks: length, name, data, checksum; only the three that a picture needs
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::string names;
  for (std::size_t at = 8; at + 8 <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i)
      length = length * 256 + static_cast<unsigned char>(bytes[at + i]);
    names += bytes.substr(at + 4, 4) + " ";
    at += length + 12;
  }
  EXPECT_EQ(names, "IHDR IDAT IEND ");
}

TEST(Picture, AFileThatCannotBeWrittenIsToldAndNothingIsLeft) {
  const test::Folder folder;
  const Image image{1, 1, {0, 0, 0}};
  const Status written = write_png(image, folder.path() / "missing" / "a.png");
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().trouble, Trouble::io);
  EXPECT_NE(written.error().text.find("a.png"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Picture, AFilmIsNumberedPictures) {
  BURR_NEEDS_GPU(gpu);  // and a film at the same time
  const test::Folder folder;
  auto film = Film::in(folder.path() / "film", 64, 48);
  ASSERT_TRUE(film.ok()) << film.error().text;
  Scene scene = ball_scene(Vec3::Zero(), 0.03, 30);
  for (int i = 0; i < 3; ++i) {
    orbit(scene.camera, 0.1, 0);
    ASSERT_TRUE(film->frame(scene).ok());
  }
  EXPECT_EQ(film->frames(), 3);
  for (const char* name : {"frame_000001.png", "frame_000002.png", "frame_000003.png"}) {
    int width = 0, height = 0, channels = 0;
    EXPECT_EQ(stbi_info((folder.path() / "film" / name).c_str(), &width, &height, &channels), 1);
    EXPECT_EQ(width, 64);
  }
}

// ---- picking, and bone from its field

TEST(Picture, TheMouseFindsTheBallToATenthOfAMillimetre) {
  const unsigned seed = 24;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Scene scene;
  auto parts = test::cut(test::ball({0.01, 0, 0.02}, 0.03, 150), 4);
  for (std::size_t i = 0; i < parts.size(); ++i) set_patch(scene, static_cast<int>(i), parts[i]);
  scene.camera = whole_view(scene, 0, 0, 1);
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    orbit(scene.camera, uniform(random), uniform(random) - 0.5);
    const Ray ray =
        ray_through(scene.camera, 800 * uniform(random), 800 * uniform(random), 800, 800);
    const Vec3 from = ray.origin - Vec3(0.01, 0, 0.02);
    const double b = from.dot(ray.direction), c = from.squaredNorm() - 0.03 * 0.03;
    const auto hit = pick(scene, ray);
    if (std::abs(b * b - c) < 1e-5) continue;  // only touches the edge
    ASSERT_EQ(hit.has_value(), b * b > c);
    if (!hit) continue;
    ++hits;
    const Vec3 truth = ray.origin + (-b - std::sqrt(b * b - c)) * ray.direction;
    EXPECT_LT((hit->p - truth).norm(), 0.1e-3);
    EXPECT_GT(hit->n.dot((truth - Vec3(0.01, 0, 0.02)).normalized()), 0.999);
    EXPECT_EQ(hit->tissue, 1);
  }
  EXPECT_GT(hits, 150);
}

TEST(Picture, ABoneBecomesASceneThatLooksLikeIt) {
  BURR_NEEDS_GPU(gpu);
  // a ball of 20 mm in a field of 1 mm voxels
  volume::Grid grid;
  grid.size = {64, 64, 64};
  std::vector<volume::Field> field;
  for (int k = 0; k < 64; ++k)
    for (int j = 0; j < 64; ++j)
      for (int i = 0; i < 64; ++i)
        field.push_back(volume::field_from_depth(20 - (Vec3(i, j, k) - Vec3(31, 32, 33)).norm()));
  const auto bone = volume::bone_from_arrays(grid, {}, field, {}, {}, 0);
  Scene scene;
  NoProgress nobody;
  const Status skinned = skin_bone(scene, *bone, 2, nobody);
  ASSERT_TRUE(skinned.ok()) << skinned.error().text;
  EXPECT_EQ(scene.tissue_colours.size(), 2U);
  EXPECT_TRUE(bounds(scene).centre().isApprox(Vec3(0.031, 0.032, 0.033), 1e-3));

  scene.camera = whole_view(scene, 0.5, 0.5, 1);
  scene.look = plain_look();
  const auto image = gpu.image(scene, 400, 400);
  ASSERT_TRUE(image.ok());
  const double r = std::tan(std::asin(0.02 / scene.camera.distance)) /
                   std::tan(scene.camera.field_of_view / 2) * 200;
  EXPECT_NEAR(static_cast<double>(lit_pixels(*image)), kPi * r * r, 0.01 * kPi * r * r);
}

}  // namespace
}  // namespace burr::render
