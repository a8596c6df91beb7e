// Every sentence and every verdict of `burr check`, from made-up facts.
#include "burr/rt/machine_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>

namespace burr::rt {
namespace {

TickSummary ticks(double work_p999, double late_p999, double worst, std::uint64_t missed = 0) {
  TickSummary t;
  t.ticks = 4000;
  t.p50_us = work_p999 / 3;
  t.p99_us = work_p999 / 2;
  t.p999_us = work_p999;
  t.max_us = 1.5 * work_p999;
  t.late_p999_us = late_p999;
  t.worst_lateness_us = worst;
  t.missed = missed;
  return t;
}

// A machine without any fault.
MachineMeasurements fine_machine() {
  MachineMeasurements seen;
  seen.machine.processor = "Some Core 7";
  seen.machine.cores = 8;
  seen.machine.simd = "avx2";
  seen.machine.kernel = "6.1.0-18-rt-amd64";
  seen.machine.preemption = "PREEMPT_RT";
  seen.machine.clock_source = "tsc";
  seen.machine.governor = "performance";
  seen.machine.fifo_limit = 90;
  seen.machine.locked_bytes = kNoLimit;
  seen.machine.fifo_share_us = 950'000;
  seen.machine.fifo_period_us = 1'000'000;
  seen.grant.fifo = seen.grant.locked = true;
  seen.waiting = seen.waiting_loaded = ticks(1, 10, 30);
  seen.milling = seen.milling_loaded = ticks(150, 20, 60);
  return seen;
}

const CheckLine& line(const MachineReport& judged, const std::string& what) {
  const auto found = std::find_if(judged.lines.begin(), judged.lines.end(),
                                  [&](const CheckLine& one) { return one.what == what; });
  if (found == judged.lines.end()) throw std::runtime_error("no line " + what);
  return *found;
}

TEST(MachineCheck, AMachineWithoutFaultIsGoodAndNothingIsToBeChanged) {
  const MachineReport judged = judge(fine_machine());
  EXPECT_EQ(judged.verdict, Verdict::good) << judged.sentence;
  EXPECT_EQ(judged.sentence, "good: this computer is fast enough for a real device");
  EXPECT_TRUE(judged.reasons.empty());
  EXPECT_EQ(judged.lines.size(), 8U);
  for (const CheckLine& one : judged.lines) EXPECT_EQ(one.change, "") << one.what;
}

TEST(MachineCheck, EachFaultHasItsLineAndItsCureAndOnlyThatLine) {
  struct Fault {
    std::string what, value, change;  // parts of the line
    std::function<void(MachineMeasurements&)> put;
    Verdict verdict = Verdict::good;
  };
  const Fault faults[] = {
      {"processor", "1 core for burr", "two cores or more", [](auto& s) { s.machine.cores = 1; },
       Verdict::usable},
      {"processor", "limited to 1.5", "container", [](auto& s) { s.machine.core_quota = 1.5; },
       Verdict::usable},
      {"instructions", "scalar", "AVX2", [](auto& s) { s.machine.simd = "scalar"; }},
      {"priority", "ordinary", "rtprio",
       [](auto& s) {
         s.grant.fifo = false;
         s.machine.fifo_limit = 0;
       },
       Verdict::usable},
      {"priority", "ordinary", "up to 50 but 80",
       [](auto& s) {
         s.grant.fifo = false;
         s.machine.fifo_limit = 50;
       },
       Verdict::usable},
      {"priority", "SCHED_FIFO", "sched_rt_runtime_us",
       [](auto& s) { s.machine.fifo_share_us = 500'000; }},
      {"memory", "64 KiB", "memlock unlimited",
       [](auto& s) {
         s.grant.locked = false;
         s.machine.locked_bytes = 64 * 1024;
       },
       Verdict::usable},
      {"memory", "not locked", "memlock", [](auto& s) { s.grant.locked = false; }, Verdict::usable},
      {"kernel", "PREEMPT_DYNAMIC", "linux-image-rt",
       [](auto& s) { s.machine.preemption = "PREEMPT_DYNAMIC"; }},
      {"frequency", "powersave", "cpupower", [](auto& s) { s.machine.governor = "powersave"; }},
      {"clock", "hpet", "tsc", [](auto& s) { s.machine.clock_source = "hpet"; }},
      {"virtual machine", "QEMU", "host", [](auto& s) { s.machine.virtual_machine = "QEMU"; },
       Verdict::usable},
  };
  for (const Fault& fault : faults) {
    MachineMeasurements seen = fine_machine();
    fault.put(seen);
    const MachineReport judged = judge(seen);
    EXPECT_EQ(judged.verdict, fault.verdict) << fault.change << ": " << judged.sentence;
    const CheckLine& named = line(judged, fault.what);
    EXPECT_NE(named.value.find(fault.value), std::string::npos) << named.value;
    EXPECT_NE(named.change.find(fault.change), std::string::npos) << named.change;
    for (const CheckLine& other : judged.lines)
      if (other.what != fault.what) {
        EXPECT_EQ(other.change, "") << fault.what << ", " << other.what;
      }
  }
}

TEST(MachineCheck, WhatTheMachineDoesNotTellIsNoFault) {
  MachineMeasurements seen = fine_machine();
  seen.machine.governor = seen.machine.clock_source = seen.machine.processor = "";
  const MachineReport judged = judge(seen);
  EXPECT_EQ(judged.verdict, Verdict::good);
  EXPECT_EQ(line(judged, "frequency").value, "unknown");
}

TEST(MachineCheck, TheBarsDecideOnEachSide) {
  struct Case {
    TickSummary loaded;
    Verdict verdict;
    std::string reason;
  };
  const Case cases[] = {
      {ticks(500, 100, 1000), Verdict::good, ""},
      {ticks(501, 100, 1000), Verdict::usable, "takes 501 us"},
      {ticks(500, 101, 1000), Verdict::usable, "begins 101 us late"},
      {ticks(500, 100, 1100), Verdict::usable, "the latest tick began 1.1 ms late"},
      {ticks(500, 100, 1000, 1), Verdict::usable, "1 of 4001 ticks were skipped"},
      {ticks(900, 1000, 5000, 4), Verdict::usable, "4 of 4004"},
      {ticks(901, 1000, 5000), Verdict::not_enough, "takes 901 us"},
      {ticks(900, 1001, 5000), Verdict::not_enough, "begins 1001 us late"},
      {ticks(900, 1000, 5100), Verdict::not_enough, "5.1 ms late"},
      {ticks(900, 1000, 5000, 5), Verdict::not_enough, "5 of 4005"},
  };
  for (const Case& one : cases) {
    MachineMeasurements seen = fine_machine();
    seen.milling_loaded = one.loaded;
    const MachineReport judged = judge(seen);
    EXPECT_EQ(judged.verdict, one.verdict) << judged.sentence;
    EXPECT_NE(judged.sentence.find(one.reason), std::string::npos) << judged.sentence;
    EXPECT_EQ(judged.reasons.empty(), one.verdict == Verdict::good);
  }
}

TEST(MachineCheck, OnlyWhatIsMeasuredUnderLoadDecides) {
  MachineMeasurements seen = fine_machine();
  seen.waiting = seen.milling = ticks(5000, 5000, 50'000, 100);
  EXPECT_EQ(judge(seen).verdict, Verdict::good);
}

TEST(MachineCheck, SaysWhetherTheMachineOrTheTickIsLate) {
  MachineMeasurements seen = fine_machine();
  seen.milling_loaded = ticks(100, 3000, 9000);
  EXPECT_NE(judge(seen).sentence.find("close other programs"), std::string::npos);
  seen.waiting_loaded = ticks(1, 3000, 9000);
  EXPECT_NE(judge(seen).sentence.find("the computer is the cause"), std::string::npos);
  EXPECT_EQ(judge(seen).verdict, Verdict::not_enough);
}

TEST(MachineCheck, NamesOfTheVerdicts) {
  EXPECT_STREQ(name(Verdict::good), "good");
  EXPECT_STREQ(name(Verdict::usable), "usable");
  EXPECT_STREQ(name(Verdict::not_enough), "not good enough");
}

}  // namespace
}  // namespace burr::rt
