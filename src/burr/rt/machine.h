// rt/machine.h - what the computer is, as far as it decides whether ticks come in time.
//
// Read once from /proc, /sys and the kernel's limits; nothing is changed. What the system does not
// say is left empty or zero. Thread: any.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace burr::rt {

inline constexpr std::uint64_t kNoLimit = UINT64_MAX;

struct Machine {
  std::string processor;            // "Intel(R) Xeon(R) Processor"
  std::string kernel;               // "6.1.0-18-amd64"
  std::string preemption;           // "PREEMPT_RT", "PREEMPT_DYNAMIC" ... as the kernel calls it
  std::string clock_source;         // "tsc", "hpet" ...
  std::string governor;             // of the processor's frequency; "mixed" where cores differ
  std::string virtual_machine;      // its maker, "unknown maker"; empty: none is seen
  std::string simd;                 // which kernels run
  int cores = 0;                    // this program may use
  double core_quota = 0;            // of a container, in cores; 0: none
  int fifo_limit = 0;               // highest SCHED_FIFO priority that may be asked for; 0: none
  std::uint64_t locked_bytes = 0;   // that may be locked, kNoLimit: all
  std::int64_t fifo_share_us = -1;  // of fifo_period_us that SCHED_FIFO may take; -1: all
  std::int64_t fifo_period_us = 0;
  [[nodiscard]] bool preempt_rt() const { return preemption == "PREEMPT_RT"; }
};

// root: where proc and sys lie; another one only in tests. Never fails.
[[nodiscard]] Machine read_machine(const std::filesystem::path& root = "/");

}  // namespace burr::rt
