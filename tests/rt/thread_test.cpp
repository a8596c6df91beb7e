#include "burr/rt/thread.h"

#include <gtest/gtest.h>

#include <pthread.h>
#include <sched.h>
#include <thread>

#include <atomic>

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

TEST(Thread, WhatItGotIsWhatTheKernelSays) {
  std::atomic<int> policy = -1;
  Thread thread({.name = "servo", .realtime = true, .priority = 70}, [&] {
    sched_param param = {};
    int now = -1;
    pthread_getschedparam(pthread_self(), &now, &param);
    if (now == SCHED_FIFO && param.sched_priority != 70) now = -2;
    policy = now;
  });
  thread.join();
  const ThreadGrant& grant = thread.grant();
  EXPECT_EQ(policy, grant.fifo ? SCHED_FIFO : SCHED_OTHER);
  if (grant.fifo && grant.locked) {
    EXPECT_EQ(grant.sentence, "servo: SCHED_FIFO 70, memory locked");
  } else {
    EXPECT_NE(grant.sentence.find("docs/understand/realtime.md"), std::string::npos)
        << grant.sentence;
  }
}

TEST(Thread, StaysOnTheCoreItWasGiven) {
  cpu_set_t allowed;
  ASSERT_EQ(pthread_getaffinity_np(pthread_self(), sizeof allowed, &allowed), 0);
  unsigned core = 0;
  while (!CPU_ISSET(core, &allowed)) ++core;
  std::atomic<int> seen = -1;
  Thread thread({.core = static_cast<int>(core)}, [&] { seen = sched_getcpu(); });
  thread.join();
  EXPECT_TRUE(thread.grant().pinned) << thread.grant().sentence;
  EXPECT_EQ(seen, static_cast<int>(core));
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
