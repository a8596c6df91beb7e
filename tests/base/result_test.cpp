#include "burr/base/result.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "burr/base/hash.h"
#include "burr/base/version.h"

namespace burr {
namespace {

Result<int> whole(const std::string& text) {
  if (text.empty()) return error("label table: no number in it; write one");
  return static_cast<int>(text.size());
}

TEST(Result, IsAValueOrASentence) {
  Result<int> good = whole("four");
  ASSERT_TRUE(good.ok());
  EXPECT_TRUE(static_cast<bool>(good));
  EXPECT_EQ(*good, 4);
  *good = 5;
  EXPECT_EQ(good.value(), 5);

  const Result<int> bad = whole("");
  ASSERT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().trouble, Trouble::data);
  EXPECT_EQ(bad.error().text, "label table: no number in it; write one");
}

TEST(Result, PassesOnAnErrorOfAnotherKind) {
  const auto outer = [](const std::string& text) -> Result<std::string> {
    const Result<int> inner = whole(text);
    if (!inner) return inner.error();
    return std::string("good");
  };
  EXPECT_EQ(*outer("x"), "good");
  EXPECT_EQ(outer("").error().trouble, Trouble::data);
}

TEST(Result, HoldsWhatCanOnlyBeMoved) {
  Result<std::unique_ptr<int>> one = std::make_unique<int>(1);
  ASSERT_TRUE(one.ok());
  const std::unique_ptr<int> taken = std::move(*one);
  EXPECT_EQ(*taken, 1);
}

TEST(Result, StatusIsFineOrNot) {
  EXPECT_TRUE(fine().ok());
  const Status lost = error(Trouble::io, "bone.stl: no room on the disk");
  EXPECT_EQ(static_cast<int>(lost.error().trouble), 74);
}

TEST(Result, TroubleIsTheExitCodePeopleScriptAgainst) {
  EXPECT_EQ(static_cast<int>(Trouble::usage), 2);
  EXPECT_EQ(static_cast<int>(Trouble::data), 65);
  EXPECT_EQ(static_cast<int>(Trouble::internal), 70);
  EXPECT_EQ(static_cast<int>(Trouble::io), 74);
  EXPECT_EQ(static_cast<int>(Trouble::interrupted), 130);
}

TEST(ResultDeathTest, AskingForWhatIsNotThereIsLoud) {
  const Result<int> bad = whole("");
  EXPECT_DEATH((void)bad.value(), "internal error: ok\\(\\)");
  const Result<int> good = whole("x");
  EXPECT_DEATH((void)good.error(), "internal error: !ok\\(\\)");
}

TEST(Hash, KnownBits) {
  // first outputs of SplitMix64 seeded with 0 and 1 (S. Vigna's reference program)
  EXPECT_EQ(base::mix(0, std::uint64_t{0}), 0xe220a8397b1dcdafULL);
  EXPECT_EQ(base::mix(1, std::uint64_t{0}), 0x910a2dec89025cc1ULL);
}

TEST(Hash, SeesOrderSignAndLength) {
  const std::uint64_t ab[] = {1, 2}, ba[] = {2, 1}, a[] = {1};
  EXPECT_NE(base::mix(0, std::span<const std::uint64_t>(ab)),
            base::mix(0, std::span<const std::uint64_t>(ba)));
  EXPECT_NE(base::mix(0, std::span<const std::uint64_t>(ab)),
            base::mix(0, std::span<const std::uint64_t>(a)));
  EXPECT_NE(base::mix(0, 0.0), base::mix(0, -0.0)) << "bits, not numbers";
}

TEST(Version, IsThatOfTheProject) {
  EXPECT_EQ(std::string(base::version()).find_first_not_of("0123456789."), std::string::npos);
  EXPECT_FALSE(std::string(base::build()).empty());
}

}  // namespace
}  // namespace burr
