// The bones shaped at build time are those of their formulas, to the bit.
#include "burr/workshop/prebuilt_phantom.h"

#include <gtest/gtest.h>

#include "burr/base/progress.h"
#include "burr/phantom/phantoms.h"

namespace burr::workshop {
namespace {

TEST(PrebuiltPhantom, IsTheBoneOfItsFormulaToTheBit) {
#ifdef BURR_SANITIZED
  GTEST_SKIP() << "no bones are shaped beforehand in a build with a sanitizer";
#endif
  for (const char* name : {"temporal-bone", "jaw", "tooth", "spine"}) {
    SCOPED_TRACE(name);
    const auto ready = prebuilt_phantom(name, 100);
    ASSERT_NE(ready, nullptr) << "not there, or damaged";
    NoProgress quiet;
    const auto formula = phantom::phantom(name, 0, quiet, 100);
    ASSERT_TRUE(formula) << formula.error().text;
    EXPECT_EQ(ready->content_hash(), (*formula)->content_hash());
    EXPECT_EQ(ready->grid().size, (*formula)->grid().size);
    EXPECT_EQ(ready->grid().voxel, (*formula)->grid().voxel);
    EXPECT_EQ(ready->grid().frame.p, (*formula)->grid().frame.p);
    const auto& a = ready->tissues().tissues;
    const auto& b = (*formula)->tissues().tissues;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t t = 0; t < a.size(); ++t) {
      EXPECT_EQ(a[t].name, b[t].name);
      EXPECT_EQ(a[t].kind, b[t].kind);
      EXPECT_EQ(a[t].colour, b[t].colour);
      EXPECT_EQ(a[t].cutting_energy, b[t].cutting_energy);
      EXPECT_EQ(a[t].spare, b[t].spare);
      EXPECT_EQ(a[t].force.chip_tangential, b[t].force.chip_tangential);
    }
  }
}

TEST(PrebuiltPhantom, OfWhatIsNotThereThereIsNone) {
  EXPECT_EQ(prebuilt_phantom("no-such-bone", 0), nullptr);
  EXPECT_EQ(prebuilt_phantom("../README", 0), nullptr);
}

}  // namespace
}  // namespace burr::workshop
