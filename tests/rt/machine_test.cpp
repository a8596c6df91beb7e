// What the system reports about itself, from made-up files and from this machine.
#include "burr/rt/machine.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "burr/rt/idle_loop.h"
#include "support/folder.h"

namespace burr::rt {
namespace {

namespace fs = std::filesystem;

class MadeUpMachine : public testing::Test {
 protected:
  const burr::test::Folder folder;
  const fs::path root = folder.path();
  void say(const std::string& file, const std::string& text) const {
    fs::create_directories((root / file).parent_path());
    std::ofstream(root / file) << text;
  }
};

TEST_F(MadeUpMachine, IsReadAsItIs) {
  say("proc/cpuinfo",
      "processor\t: 0\nmodel name\t: Some Core 7\nflags\t\t: fpu sse2 avx2\n\n"
      "processor\t: 1\nmodel name\t: Other\nflags\t\t: fpu hypervisor\n");
  say("proc/version", "Linux version 6.1.0-18-rt-amd64 (x) #1 SMP PREEMPT_RT Debian 6.1.76-1\n");
  say("proc/sys/kernel/osrelease", "6.1.0-18-rt-amd64\n");
  say("proc/sys/kernel/sched_rt_runtime_us", "950000\n");
  say("proc/sys/kernel/sched_rt_period_us", "1000000\n");
  say("sys/devices/system/clocksource/clocksource0/current_clocksource", "hpet \n");
  say("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave\n");
  say("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n");
  say("sys/fs/cgroup/cpu.max", "50000 100000\n");
  const Machine machine = read_machine(root);
  EXPECT_EQ(machine.processor, "Some Core 7");
  EXPECT_EQ(machine.kernel, "6.1.0-18-rt-amd64");
  EXPECT_TRUE(machine.preempt_rt());
  EXPECT_EQ(machine.clock_source, "hpet");
  EXPECT_EQ(machine.governor, "powersave");
  EXPECT_EQ(machine.virtual_machine, "") << "only the first core's flags count, it has none";
  EXPECT_EQ(machine.core_quota, 0.5);
  EXPECT_EQ(machine.fifo_share_us, 950'000);
  EXPECT_EQ(machine.fifo_period_us, 1'000'000);
}

TEST_F(MadeUpMachine, GovernorsThatDifferAreMixed) {
  say("sys/devices/system/cpu/cpu0/cpufreq/scaling_governor", "performance\n");
  say("sys/devices/system/cpu/cpu1/cpufreq/scaling_governor", "powersave\n");
  EXPECT_EQ(read_machine(root).governor, "mixed");
}

TEST_F(MadeUpMachine, AVirtualOneIsSeenByItsMakerOrByTheFlag) {
  EXPECT_EQ(read_machine(root).virtual_machine, "");
  say("sys/class/dmi/id/sys_vendor", "Microsoft Corporation\n");  // a tablet
  EXPECT_EQ(read_machine(root).virtual_machine, "");
  say("proc/cpuinfo", "model name : X\nflags : fpu hypervisor avx2\n");
  EXPECT_EQ(read_machine(root).virtual_machine, "Microsoft Corporation");
  say("sys/class/dmi/id/sys_vendor", "QEMU\n");
  EXPECT_EQ(read_machine(root).virtual_machine, "QEMU");
  say("sys/class/dmi/id/sys_vendor", "ACME\n");
  EXPECT_EQ(read_machine(root).virtual_machine, "unknown maker");
}

TEST_F(MadeUpMachine, WhatIsNotToldIsLeftEmpty) {
  say("sys/fs/cgroup/cpu.max", "max 100000\n");
  const Machine machine = read_machine(root);
  EXPECT_EQ(machine.processor, "");
  EXPECT_EQ(machine.preemption, "");
  EXPECT_FALSE(machine.preempt_rt());
  EXPECT_EQ(machine.governor, "");
  EXPECT_EQ(machine.core_quota, 0);
  EXPECT_EQ(machine.fifo_share_us, -1);
}

TEST(Machine, ThisOneHasACoreAndAKernel) {
  const Machine machine = read_machine();
  EXPECT_GE(machine.cores, 1);
  EXPECT_FALSE(machine.kernel.empty());
  EXPECT_FALSE(machine.simd.empty());
  EXPECT_LE(machine.fifo_limit, 99);
}

TEST(IdleLoop, BeginsEachPeriodOnceAndCountsTheRest) {
  IdleLoop loop(1000, {.name = "waiting"});
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  const TickSummary seen = loop.stop();
  EXPECT_GE(seen.ticks + seen.missed, 100U);
  EXPECT_GE(seen.worst_lateness_us, seen.late_p50_us);
  EXPECT_EQ(loop.stop().ticks, seen.ticks) << "once it stands, it stands";
}

}  // namespace
}  // namespace burr::rt
