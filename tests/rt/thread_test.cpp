#include "burr/rt/thread.h"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>

namespace burr::rt {
namespace {

TEST(Thread, RunsTheWorkAndSaysWhatItIs) {
  std::atomic<bool> ran = false;
  Thread thread({.name = "helper"}, [&] { ran = true; });
  thread.join();
  EXPECT_TRUE(ran);
  EXPECT_FALSE(thread.grant().fifo);
  EXPECT_EQ(thread.grant().sentence, "helper: ordinary thread");
}

TEST(Thread, IsJoinedWhenItGoes) {
  std::atomic<int> done = 0;
  {
    const Thread thread({}, [&] { done = 7; });
  }
  EXPECT_EQ(done, 7);
}

TEST(Thread, ACoreThatIsNotThereIsSaidAndTheWorkRunsAnyway) {
  std::atomic<bool> ran = false;
  Thread thread({.name = "servo", .core = 1'000'000}, [&] { ran = true; });
  thread.join();
  EXPECT_TRUE(ran);
  EXPECT_FALSE(thread.grant().pinned);
  EXPECT_NE(thread.grant().sentence.find("core 1000000"), std::string::npos);
}

TEST(Thread, ThatGoesFirstStepsAsideForAWhile) {
  bool first = false, aside = true, heir = true, again = false;
  Thread thread({.name = "first", .realtime = true}, [&] {
    first = has_realtime_priority();
    {
      const NormalPriority normal;
      aside = has_realtime_priority();
      std::thread begun([&] { heir = has_realtime_priority(); });
      begun.join();
    }
    again = has_realtime_priority();
  });
  thread.join();
  if (!thread.grant().fifo) GTEST_SKIP() << "this machine lets nobody go first";
  EXPECT_TRUE(first);
  EXPECT_FALSE(aside);
  EXPECT_FALSE(heir);
  EXPECT_TRUE(again);
}

}  // namespace
}  // namespace burr::rt
