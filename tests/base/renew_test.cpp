// Move assignment for what must end whole (base/renew.h).
#include "burr/base/renew.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace burr::base {
namespace {

std::vector<std::string> ended;

// Reads the bone until its own end, as a thread does that is joined there.
struct Reader {
  explicit Reader(std::string& bone) : bone_(bone) {}
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { ended.push_back("reader of " + bone_); }
  std::string& bone_;
};
struct Bone {
  explicit Bone(std::string text) : name(std::move(text)) {}
  Bone(const Bone&) = delete;
  Bone& operator=(const Bone&) = delete;
  ~Bone() {
    ended.push_back(name);
    name = "nothing";
  }
  std::string name;
};
struct Session {
  explicit Session(const std::string& name)
      : bone(std::make_unique<Bone>(name)), reader(std::make_unique<Reader>(bone->name)) {}
  Session(Session&&) noexcept = default;
  Session& operator=(Session&& other) noexcept { return renew(*this, other); }
  ~Session() = default;
  std::unique_ptr<Bone> bone;
  std::unique_ptr<Reader> reader;
};

TEST(Renew, TheOldOneEndsWholeBeforeTheFreshOneTakesItsPlace) {
  ended.clear();
  {
    Session now("first");
    now = Session("second");
    EXPECT_EQ(ended, (std::vector<std::string>{"reader of first", "first"}));
    EXPECT_EQ(now.bone->name, "second");
    Session& itself = now;
    now = std::move(itself);
    ASSERT_NE(now.bone, nullptr);
    EXPECT_EQ(now.reader->bone_, "second");
  }
  EXPECT_EQ(ended,
            (std::vector<std::string>{"reader of first", "first", "reader of second", "second"}));
}

}  // namespace
}  // namespace burr::base
