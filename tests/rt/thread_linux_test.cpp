// What a thread was granted, compared with what the kernel of Linux says.
#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>

#include <atomic>
#include <string>

#include "burr/rt/thread.h"

namespace burr::rt {
namespace {

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

}  // namespace
}  // namespace burr::rt
