// Views come back as they were kept, each with its bone, and nothing of a file is lost.
#include "window/mill/saved_views.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include "window/user.h"

namespace burr::app {
namespace {

SavedView some_view(double by) {
  SavedView view;
  view.camera.target = {0.01 * by, -0.2 + by * 1e-4, 0.345};
  view.camera.distance = 0.123 + 1e-3 * by;
  view.camera.azimuth = 1.1 * by;
  view.camera.elevation = -0.7;
  view.camera.field_of_view = 0.41;
  view.opacity = 0.35;
  view.labels = false;
  return view;
}

void expect_same(const std::optional<SavedView>& seen, const SavedView& kept) {
  ASSERT_TRUE(seen.has_value());
  EXPECT_LT((seen->camera.target - kept.camera.target).norm(), 1e-12);
  EXPECT_NEAR(seen->camera.distance, kept.camera.distance, 1e-12);
  EXPECT_EQ(seen->camera.azimuth, kept.camera.azimuth);
  EXPECT_EQ(seen->camera.elevation, kept.camera.elevation);
  EXPECT_EQ(seen->camera.field_of_view, kept.camera.field_of_view);
  EXPECT_EQ(seen->opacity, kept.opacity);
  EXPECT_EQ(seen->labels, kept.labels);
  EXPECT_EQ(seen->slices, kept.slices);
}

class SavedViewsFile : public testing::Test {
 protected:
  const test::Folder own_;
  fs::path folder_ = own_.path();
  fs::path file_ = folder_ / "deep" / "views.toml";
  const std::string one_ = "0123456789abcdef", other_ = "ffffffffffffffff";
};

TEST_F(SavedViewsFile, HoldsTheViewsOfEachBone) {
  {
    SavedViews views(file_, one_);
    EXPECT_FALSE(views.at(1));
    ASSERT_TRUE(views.keep(1, some_view(1)));
    ASSERT_TRUE(views.keep(4, some_view(2)));
    ASSERT_TRUE(views.keep(4, some_view(3)));  // in its place
    SavedViews others(file_, other_);
    ASSERT_TRUE(others.keep(1, some_view(4)));
  }
  const SavedViews views(file_, one_), others(file_, other_);
  EXPECT_EQ(views.trouble(), "");
  expect_same(views.at(1), some_view(1));
  expect_same(views.at(4), some_view(3));
  EXPECT_FALSE(views.at(2));
  expect_same(others.at(1), some_view(4));
  EXPECT_FALSE(others.at(4));
}

TEST_F(SavedViewsFile, SaysWhatCannotBeReadAndKeepsItAside) {
  {
    SavedViews views(file_, one_);
    ASSERT_TRUE(views.keep(1, some_view(1)));
  }
  std::ofstream(file_, std::ios::app)
      << "\n[[view]]\nbone = \"" << one_ << "\"\nslot = 2\ndistance_mm = nan\n";
  {
    SavedViews views(file_, one_);
    EXPECT_NE(views.trouble().find("views.toml"), std::string::npos) << views.trouble();
    EXPECT_NE(views.trouble().find('1'), std::string::npos) << views.trouble();
    expect_same(views.at(1), some_view(1));  // the good one is there
    EXPECT_FALSE(views.at(2));
    ASSERT_TRUE(views.keep(3, some_view(3)));
  }
  EXPECT_TRUE(fs::exists(file_.string() + ".old"));
  const SavedViews again(file_, one_);
  EXPECT_EQ(again.trouble(), "");
  expect_same(again.at(1), some_view(1));
  expect_same(again.at(3), some_view(3));

  std::ofstream(file_) << "[[[";
  SavedViews none(file_, one_);
  EXPECT_NE(none.trouble().find("views.toml"), std::string::npos) << none.trouble();
  EXPECT_FALSE(none.at(1));
}

TEST_F(SavedViewsFile, WhereItCannotBeWrittenIsToldAndTheViewIsThereMeanwhile) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "deep") << "a file in the way";
  SavedViews views(file_, one_);
  const Status kept = views.keep(2, some_view(2));
  ASSERT_FALSE(kept);
  EXPECT_NE(kept.error().text.find("deep"), std::string::npos) << kept.error().text;
  expect_same(views.at(2), some_view(2));
}

TEST_F(SavedViewsFile, KnowsABoneByItsPlaceAlone) {
  volume::Grid grid;
  grid.size = {100, 120, 80};
  grid.voxel = 0.25e-3;
  grid.frame.p = {0.1, -0.05, 0.7};
  const std::string key = key_of(grid);
  volume::Grid again = grid;
  again.frame.p.x() += 1e-10;
  EXPECT_EQ(key_of(again), key);
  again.frame.p.x() += 1e-4;
  EXPECT_NE(key_of(again), key);
  again = grid;
  again.voxel = 0.3e-3;
  EXPECT_NE(key_of(again), key);
}

class SavedViewsWindow : public Window {};

TEST_F(SavedViewsWindow, ComeBackByKeyAndInTheNextSession) {
  auto ready = block();
  ASSERT_TRUE(ready) << ready.error().text;
  render::Scene& scene = ready->scene;
  render::Camera kept, turned;
  mill_by(*ready,
          {{"the first picture", looks(3), [] { press(SDLK_F6); }},
           {"no such view", [&] { return desk_->status_text.find("F6") != std::string::npos; },
            [] {
              press(SDLK_LEFT);
              press(SDLK_UP);
            }},
           {"another view", looks(3),
            [&] {
              kept = scene.camera;
              press(SDLK_F6, KMOD_LSHIFT);
              press(SDLK_RIGHT);
              press(SDLK_RIGHT);
              press(SDLK_l);
            }},
           {"yet another", looks(3),
            [&] {
              turned = scene.camera;
              press(SDLK_F6);
            }},
           {"the one before", looks(3), [&] {
              EXPECT_TRUE(same(scene.camera, kept));
              leave_work();
            }}});
  EXPECT_FALSE(same(turned, kept)) << "nothing was turned: the test shows nothing";
  auto later = block();
  ASSERT_TRUE(later) << later.error().text;
  mill_by(*later, {{"the first picture", looks(3), [] { press(SDLK_F6); }},
                   {"the view of the first session", looks(3), [] { leave_work(); }}});
  EXPECT_LT((later->scene.camera.target - kept.target).norm(), 1e-9);
  EXPECT_EQ(later->scene.camera.azimuth, kept.azimuth);
  EXPECT_EQ(later->scene.camera.elevation, kept.elevation);
}

}  // namespace
}  // namespace burr::app
