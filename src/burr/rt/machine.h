// rt/machine.h - the properties of this computer that decide whether ticks come in time.
//
// Read once from /proc, /sys and the kernel's limits; nothing is changed. What the system does not
// report stays empty or zero. Thread: any.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace burr::rt {

inline constexpr std::uint64_t kNoLimit = UINT64_MAX;

struct Machine {
  std::string processor;            // "Intel(R) Xeon(R) Processor"
  std::string kernel;               // "6.1.0-18-amd64"
  std::string preemption;           // "PREEMPT_RT", "PREEMPT_DYNAMIC" ..., the kernel's word
  std::string clock_source;         // "tsc", "hpet" ...
  std::string governor;             // of the CPU frequency; "mixed": cores differ
  std::string virtual_machine;      // its maker, or "unknown maker"; empty: none detected
  std::string simd;                 // instruction set of the kernels in use (rt/simd.h)
  int cores = 0;                    // that this program may use
  double core_quota = 0;            // CPU limit of a container, in cores; 0: no limit
  int fifo_limit = 0;               // highest SCHED_FIFO priority allowed; 0: none
  std::uint64_t locked_bytes = 0;   // memory that may be locked; kNoLimit: all
  std::int64_t fifo_share_us = -1;  // of fifo_period_us, for SCHED_FIFO; -1: all
  std::int64_t fifo_period_us = 0;
  [[nodiscard]] bool preempt_rt() const { return preemption == "PREEMPT_RT"; }
};

// root: folder that contains proc and sys; tests pass another one. Never fails.
[[nodiscard]] Machine read_machine(const std::filesystem::path& root = "/");

}  // namespace burr::rt
