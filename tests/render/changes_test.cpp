// A reader that keeps copies of a scene's patches learns what changed, or that this is not known.
#include "burr/render/changes.h"

#include <gtest/gtest.h>

namespace burr::render {
namespace {

std::vector<int> told(const Changes& changes, std::uint64_t known, bool& knows) {
  std::vector<int> patches;
  knows = changes.since(known, [&](int patch) { patches.push_back(patch); });
  return patches;
}

TEST(Changes, TellsWhatCameSinceInItsOrder) {
  bool knows = true;
  Changes changes;
  EXPECT_TRUE(told(changes, 0, knows).empty());
  EXPECT_FALSE(knows) << "of nothing nothing is known: who asks first has to look at all";
  changes.add(7);
  const std::uint64_t first = changes.newest();
  EXPECT_TRUE(told(changes, first, knows).empty());
  EXPECT_TRUE(knows);
  changes.add(3);
  changes.add(7);
  EXPECT_EQ(told(changes, first, knows), (std::vector{3, 7}));
  EXPECT_TRUE(knows);
}

TEST(Changes, OfAnotherSceneOrALaterCopyNothingIsKnown) {
  bool knows = true;
  Changes one, other;
  one.add(1);
  other.add(1);
  static_cast<void>(told(other, one.newest(), knows));
  EXPECT_FALSE(knows);
  Changes copy = one;
  EXPECT_TRUE(told(copy, one.newest(), knows).empty());
  EXPECT_TRUE(knows);
  copy.add(2);
  one.add(3);
  static_cast<void>(told(copy, one.newest(), knows));
  EXPECT_FALSE(knows) << "each went its own way";
}

TEST(Changes, WhatIsTooLongAgoIsForgotten) {
  bool knows = true;
  Changes changes;
  changes.add(0);
  const std::uint64_t first = changes.newest();
  for (int n = 1; n < 4096; ++n) changes.add(n);
  EXPECT_EQ(told(changes, first, knows).size(), 4095U);
  EXPECT_TRUE(knows);
  const std::uint64_t later = changes.newest();
  changes.add(4096);
  static_cast<void>(told(changes, first, knows));
  EXPECT_FALSE(knows);
  EXPECT_EQ(told(changes, later, knows), std::vector{4096});
  EXPECT_TRUE(knows);
}

}  // namespace
}  // namespace burr::render
