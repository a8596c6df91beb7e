// The mirror at the window: switched on by its key, seen, told, cut across, undone, and switched
// off; and the words for where its plane is.
#include "window/parts/mirror_mode.h"

#include <gtest/gtest.h>

#include <string>

#include "window/user.h"

namespace burr::app {
namespace {

class MirrorWindow : public Window {
 protected:
  // bone that is gone to the left and to the right of a plane  [voxel]
  static std::pair<double, double> gone(const volume::Bone& was, const volume::Bone& is,
                                        const edit::Mirror& mirror) {
    double low = 0, high = 0;
    const math::Ijk& n = is.grid().size;
    for (int k = 0; k < n.z(); ++k)
      for (int j = 0; j < n.y(); ++j)
        for (int i = 0; i < n.x(); ++i) {
          const int at = 2 * math::Ijk(i, j, k)[mirror.axis];
          const double by = (was.field(i, j, k) - is.field(i, j, k)) / 65535.0;
          if (at < mirror.twice) low += by;
          if (at > mirror.twice) high += by;
        }
    return {low, high};
  }
};

TEST_F(MirrorWindow, IsSwitchedOnSeenToldCutAcrossAndUndone) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  auto untouched = block();
  ASSERT_TRUE(untouched) << untouched.error().text;
  sim::Session& session = *ready->session;
  const volume::Grid grid = session.bone().grid();
  const std::uint64_t start = session.bone().content_hash();
  render::Scene& scene = ready->scene;
  tick::TickRow row;
  const auto removed = [&] {
    static_cast<void>(session.view(row));
    return 1e9 * row.ledger.removed;
  };
  const auto said = [&](const char* words) {
    return [this, words] { return desk_->status_text.find(words) != std::string::npos; };
  };
  render::Image without;
  const edit::Mirror middle = tick::mirror_plane(grid, tick::Plane::sagittal);
  std::pair<double, double> cut;
  double was = 0;
  mill_by(*ready,
          {{"the first picture", looks(20),
            [&] {
              without = desk_->renderer().shown();
              EXPECT_FALSE(scene.mirrored);
              press(SDLK_x);
            }},
           {"the mirror", said("Mirror: sagittal, through the middle"), {}},
           {"its picture", looks(3),
            [&] {
              ASSERT_TRUE(scene.mirrored);
              const render::Image with = desk_->renderer().shown();
              EXPECT_GT(differ(without, with, 0, 0, with.width, with.height / 6), 300)
                  << "no sign at the top";
              EXPECT_GT(differ(without, with, with.width / 5, with.height / 6, 4 * with.width / 5,
                               5 * with.height / 6),
                        300)
                  << "neither plane nor image";
              const math::Vec3 burr = grid.grid_from_world(scene.burr.world_from_tool.p);
              const math::Vec3 image = grid.grid_from_world(scene.mirrored->world_from_tool.p);
              EXPECT_LT((middle.image_of(burr) - image).norm(), 1e-6);
              press(SDLK_x, KMOD_LCTRL);
            }},
           {"another way", said("Mirror: coronal, through the middle"),
            [] {
              press(SDLK_x, KMOD_LCTRL);
              press(SDLK_x, KMOD_LCTRL);
              move_to(700, 360);
            }},
           {"beside the middle", looks(30), [] { button(SDL_BUTTON_LEFT, true); }},
           {"enough is cut", pressing_until([&] { return removed() > 8; }),
            [] { button(SDL_BUTTON_LEFT, false); }},
           {"lifted", looks(60),
            [&] {
              was = removed();
              cut = gone(untouched->session->bone(), session.bone(), middle);
            }},
           // a busy machine may have let go in between: it is several strokes then
           {"undone on both sides",
            [&, look = 0]() mutable {
              if (look++ % 40 == 0) press(SDLK_u);
              return session.bone().content_hash() == start;
            },
            [] { press(SDLK_x, KMOD_LSHIFT); }},
           {"at the tip",
            [&] {
              return scene.mirrored &&
                     std::abs(grid.grid_from_world(scene.mirrored->corners[0])[middle.axis] -
                              middle.place()) > 0.1;
            },
            [&] {
              const math::Vec3 burr = grid.grid_from_world(scene.burr.world_from_tool.p);
              EXPECT_NEAR(grid.grid_from_world(scene.mirrored->corners[0])[middle.axis],
                          burr[middle.axis], 1.5)
                  << "to the nearest half voxel, and the burr goes on a little";
              press(SDLK_x);
            }},
           // what must be known comes before what was done: it may stand where "Mirror off" would
           {"off", [&] { return !scene.mirrored; }, {}},
           {"nothing of it left", looks(3), [&] {
              EXPECT_FALSE(scene.mirrored);
              leave_work();
            }}});
  EXPECT_GT(cut.first, 1) << "nothing was cut there: the test shows nothing";
  EXPECT_GT(cut.second, 1) << "nothing was cut across";
  // all that was cut is on the one side and on the other
  EXPECT_NEAR(cut.first, cut.second, 0.02 * cut.first);
  EXPECT_GT(was, 8);
}

TEST(MirrorWords, TellWhereThePlaneIs) {
  volume::Grid grid;
  grid.size = {101, 61, 41};
  grid.voxel = 0.5e-3;
  const auto at = [&](const char* words) {
    return mirror_words(grid, *tick::mirror_in_words(words, grid));
  };
  EXPECT_EQ(at("sagittal"), "Mirror: sagittal, through the middle");
  EXPECT_EQ(at("sagittal,3"), "Mirror: sagittal, 3.0 mm left of the middle");
  EXPECT_EQ(at("sagittal,-3"), "Mirror: sagittal, 3.0 mm right of the middle");
  EXPECT_EQ(at("coronal,2.5"), "Mirror: coronal, 2.5 mm behind the middle");
  EXPECT_EQ(at("coronal,-1"), "Mirror: coronal, 1.0 mm in front of the middle");
  EXPECT_EQ(at("axial,1"), "Mirror: axial, 1.0 mm above the middle");
  EXPECT_EQ(at("axial,-1"), "Mirror: axial, 1.0 mm below the middle");
  EXPECT_EQ(mirror_words(grid, {}), "Mirror off");
}

TEST(MirrorWords, TheOutlineStaysInsideTheVolumeAndOnThePlane) {
  render::Scene scene;
  volume::Grid grid;
  grid.size = {40, 50, 60};
  grid.voxel = 1e-3;
  scene.camera.target = {0.03, 0.02, 0.055};
  scene.camera.distance = 0.2;
  show_mirror(scene, grid, {0, 31});
  ASSERT_TRUE(scene.mirrored);
  for (const math::Vec3& corner : scene.mirrored->corners) {
    const math::Vec3 p = grid.grid_from_world(corner);
    EXPECT_NEAR(p.x(), 15.5, 1e-9);
    EXPECT_TRUE((p.array() >= -1e-9).all() && (p.array() <= math::Vec3(39, 49, 59).array()).all());
  }
  show_mirror(scene, grid, {});
  EXPECT_FALSE(scene.mirrored);
}

}  // namespace
}  // namespace burr::app
