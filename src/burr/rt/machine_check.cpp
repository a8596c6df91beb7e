#include "burr/rt/machine_check.h"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdio>
#include <initializer_list>
#include <string>
#include <string_view>

namespace burr::rt {
namespace {

// This room does without fmt: it is part of burr_core, which needs Eigen alone.
std::string number(double value, const char* format) {
  char text[64];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
std::string number(std::integral auto value) { return std::to_string(value); }
std::string joined(std::initializer_list<std::string_view> parts) {
  std::string all;
  for (const std::string_view part : parts) all.append(part);
  return all;
}

constexpr const char* kHow = "docs/understand/realtime.md, \"Allowing real time\", shows how";

CheckLine processor_line(const Machine& machine) {
  CheckLine line{"processor", machine.processor.empty() ? "unknown" : machine.processor, ""};
  line.value +=
      ", " + number(machine.cores) + (machine.cores == 1 ? " core" : " cores") + " for burr";
  if (machine.core_quota > 0) line.value += ", limited to " + number(machine.core_quota, "%.2g");
  if (machine.cores < 2)
    line.change = "the haptic loop and the picture share one core; give burr two cores or more";
  else if (machine.core_quota > 0 && machine.core_quota < 2)
    line.change =
        "the container stops burr when its processor time is used up; give the container two cores "
        "or more";
  return line;
}

CheckLine simd_line(const Machine& machine) {
  CheckLine line{"instructions", machine.simd, ""};
  if (machine.simd == "scalar")
    line.change =
        "AVX2 is not used, so large burrs on fine voxels need more time; use coarser voxels, or a "
        "newer processor";
  return line;
}

CheckLine priority_line(const MachineMeasurements& seen) {
  CheckLine line{"priority", "SCHED_FIFO: the tick runs before all ordinary programs", ""};
  if (seen.grant.fifo) {
    const Machine& m = seen.machine;
    if (m.fifo_share_us >= 0 && m.fifo_period_us > 0 && 10 * m.fifo_share_us < 9 * m.fifo_period_us)
      line.change =
          joined({"the kernel gives SCHED_FIFO threads only ", number(m.fifo_share_us), " of ",
                  number(m.fifo_period_us), " us; raise kernel.sched_rt_runtime_us with sysctl"});
    return line;
  }
  line.value = "ordinary: any busy program may delay the tick";
  line.change = seen.machine.fifo_limit > 0
                    ? joined({"SCHED_FIFO is allowed up to ", number(seen.machine.fifo_limit),
                              " but 80 is needed; ", kHow})
                    : joined({"allow SCHED_FIFO (rtprio) for your user; ", kHow});
  return line;
}

CheckLine memory_line(const MachineMeasurements& seen) {
  CheckLine line{"memory", "locked: pages stay in memory once used", ""};
  if (seen.grant.locked) return line;
  line.value = "not locked";
  if (seen.machine.locked_bytes != kNoLimit)
    line.value += joined({": the limit is ", number(seen.machine.locked_bytes / 1024), " KiB"});
  line.change = joined({"allow memlock unlimited for your user; ", kHow});
  return line;
}

CheckLine kernel_line(const Machine& machine) {
  CheckLine line{"kernel", machine.kernel.empty() ? "unknown" : machine.kernel, ""};
  if (!machine.preemption.empty()) line.value += ", " + machine.preemption;
  if (!machine.preempt_rt())
    line.change =
        "for a real device use a kernel with PREEMPT_RT (apt install linux-image-rt-amd64), which "
        "limits the worst delay";
  return line;
}

CheckLine governor_line(const Machine& machine) {
  CheckLine line{"frequency", machine.governor.empty() ? "unknown" : machine.governor, ""};
  if (!machine.governor.empty() && machine.governor != "performance")
    line.change =
        "the processor slows down between ticks; run cpupower frequency-set -g performance "
        "(package linux-cpupower)";
  return line;
}

CheckLine clock_line(const Machine& machine) {
  CheckLine line{"clock", machine.clock_source.empty() ? "unknown" : machine.clock_source, ""};
  static constexpr std::array<std::string_view, 5> kSlow = {"hpet", "acpi_pm", "jiffies", "pit",
                                                            "refined-jiffies"};
  if (std::find(kSlow.begin(), kSlow.end(), machine.clock_source) != kSlow.end())
    line.change =
        "this clock is slow to read or coarse; see `dmesg | grep -i clocksource` for why the "
        "processor's own (tsc) is not used";
  return line;
}

CheckLine virtual_line(const Machine& machine) {
  if (machine.virtual_machine.empty()) return {"virtual machine", "none found", ""};
  return {"virtual machine", machine.virtual_machine,
          "the host decides the worst delay; for a real device run burr directly on a computer"};
}

// Adds the reasons why these ticks do not meet the bars.
void compare_with(const CheckLimits& bars, const TickSummary& ticks,
                  std::vector<std::string>& why) {
  if (ticks.p999_us > bars.work_us)
    why.push_back("one tick in a thousand takes " + number(ticks.p999_us, "%.0f") +
                  " us or longer (" + number(bars.work_us, "%.0f") + " allowed)");
  if (ticks.late_p999_us > bars.late_us)
    why.push_back("one tick in a thousand begins " + number(ticks.late_p999_us, "%.0f") +
                  " us late or later (" + number(bars.late_us, "%.0f") + " allowed)");
  if (ticks.worst_lateness_us > bars.worst_us)
    why.push_back("the latest tick began " + number(1e-3 * ticks.worst_lateness_us, "%.1f") +
                  " ms late (" + number(1e-3 * bars.worst_us, "%.0f") + " allowed)");
  const double all = static_cast<double>(ticks.ticks + ticks.missed);
  if (static_cast<double>(ticks.missed) > bars.missed_share * all)
    why.push_back(number(ticks.missed) + " of " + number(all, "%.0f") + " ticks were skipped");
}

// Adds the reasons that concern only a real device.
void compare_with(const MachineMeasurements& seen, std::vector<std::string>& why) {
  if (!seen.grant.fifo) why.emplace_back("the tick has ordinary priority");
  if (!seen.grant.locked) why.emplace_back("memory is not locked");
  if (seen.machine.cores < 2) why.emplace_back("there is only one core");
  if (seen.machine.core_quota > 0 && seen.machine.core_quota < 2)
    why.emplace_back("a container limits the processor");
  if (!seen.machine.virtual_machine.empty())
    why.emplace_back("in a virtual machine the host decides the worst delay");
}

}  // namespace

const char* name(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::good:
      return "good";
    case Verdict::usable:
      return "usable";
    case Verdict::not_enough:
      break;
  }
  return "not good enough";
}

MachineReport judge(const MachineMeasurements& seen) {
  MachineReport judged;
  judged.lines = {processor_line(seen.machine), simd_line(seen.machine),
                  priority_line(seen),          memory_line(seen),
                  kernel_line(seen.machine),    governor_line(seen.machine),
                  clock_line(seen.machine),     virtual_line(seen.machine)};

  const TickSummary& ticks = seen.milling_loaded;
  std::vector<std::string> hard;
  compare_with(kUsable, ticks, hard);
  if (!hard.empty()) {
    judged.reasons = hard;
    judged.verdict = Verdict::not_enough;
  } else {
    compare_with(kGood, ticks, judged.reasons);
    compare_with(seen, judged.reasons);
    judged.verdict = judged.reasons.empty() ? Verdict::good : Verdict::usable;
  }

  judged.sentence =
      judged.verdict == Verdict::good     ? "good: this computer is fast enough for a real device"
      : judged.verdict == Verdict::usable ? "usable: good enough to learn and to try; with a real "
                                            "device the force may sometimes be released"
                                          : "not good enough for a real device";
  for (std::size_t i = 0; i < judged.reasons.size(); ++i)
    judged.sentence += (i == 0 ? ": " : "; ") + judged.reasons[i];
  // whose fault the lateness is
  const CheckLimits& bars = hard.empty() ? kGood : kUsable;
  if (ticks.late_p999_us > bars.late_us || ticks.worst_lateness_us > bars.worst_us)
    judged.sentence +=
        seen.waiting_loaded.late_p999_us > bars.late_us ||
                seen.waiting_loaded.worst_lateness_us > bars.worst_us
            ? "; a loop that only waits is just as late: the computer is the cause, not the tick"
            : "; a loop that only waits is on time: close other programs, or use a smaller burr or "
              "coarser voxels";
  return judged;
}

}  // namespace burr::rt
