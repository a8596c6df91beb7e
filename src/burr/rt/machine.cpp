#include "burr/rt/machine.h"

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include <charconv>
#include <fstream>
#include <sstream>
#include <system_error>
#include <thread>

#include "burr/rt/simd.h"

namespace burr::rt {
namespace {

namespace fs = std::filesystem;

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  while (!line.empty() && (line.back() == ' ' || line.back() == '\0')) line.pop_back();
  return line;
}

std::int64_t number(const std::string& text, std::int64_t otherwise) {
  std::int64_t value = otherwise;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// "model name : Xeon" -> "Xeon"; also whether the flags report a hypervisor
void read_processor(const fs::path& file, Machine& machine, bool& hypervisor) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line) && !line.empty();) {  // only the first core
    const auto colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::string value = colon + 2 < line.size() ? line.substr(colon + 2) : "";
    if (line.rfind("model name", 0) == 0) machine.processor = value;
    if (line.rfind("flags", 0) == 0)
      hypervisor = (" " + value + " ").find(" hypervisor ") != std::string::npos;
  }
}

// Virtual machines report their maker where a computer reports that of its mainboard.
std::string maker_of(const fs::path& root, bool hypervisor) {
  const std::string vendor = first_line(root / "sys/class/dmi/id/sys_vendor"),
                    product = first_line(root / "sys/class/dmi/id/product_name");
  for (const char* name : {"QEMU", "KVM", "VMware", "VirtualBox", "Xen", "Microsoft Corporation",
                           "Amazon EC2", "Google Compute", "Parallels"})
    if (vendor.find(name) != std::string::npos || product.find(name) != std::string::npos) {
      // Microsoft also makes tablets, which are real machines; its virtual machines have the flag
      if (hypervisor || std::string(name) != "Microsoft Corporation") return name;
    }
  const std::string type = first_line(root / "sys/hypervisor/type");
  if (!type.empty()) return type;
  return hypervisor ? "unknown maker" : "";
}

std::string governor_of(const fs::path& root) {
  std::string governor;
  std::error_code none;
  for (int core = 0; core < 4096; ++core) {
    const fs::path cpu = root / ("sys/devices/system/cpu/cpu" + std::to_string(core));
    if (!fs::exists(cpu, none)) break;
    const std::string one = first_line(cpu / "cpufreq/scaling_governor");
    if (one.empty()) continue;
    if (!governor.empty() && governor != one) return "mixed";
    governor = one;
  }
  return governor;
}

// "#1 SMP PREEMPT_RT Debian 6.1.76-1": returns the word PREEMPT...
std::string preemption_of(const fs::path& root) {
  if (first_line(root / "sys/kernel/realtime") == "1") return "PREEMPT_RT";
  std::istringstream words(first_line(root / "proc/version"));
  for (std::string word; words >> word;)
    if (word.rfind("PREEMPT", 0) == 0) return word;
  return "";
}

// cgroup 2: "200000 100000" or "max 100000"
double quota_of(const fs::path& root) {
  std::istringstream words(first_line(root / "sys/fs/cgroup/cpu.max"));
  double quota = 0, period = 0;
  if (words >> quota >> period && period > 0) return quota / period;
  return 0;
}

}  // namespace

Machine read_machine(const fs::path& root) {
  Machine machine;
  bool hypervisor = false;
  read_processor(root / "proc/cpuinfo", machine, hypervisor);
  machine.virtual_machine = maker_of(root, hypervisor);
  machine.kernel = first_line(root / "proc/sys/kernel/osrelease");
  machine.preemption = preemption_of(root);
  machine.clock_source =
      first_line(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
  machine.governor = governor_of(root);
  machine.core_quota = quota_of(root);
  machine.simd = name(simd());
  machine.fifo_share_us = number(first_line(root / "proc/sys/kernel/sched_rt_runtime_us"), -1);
  machine.fifo_period_us = number(first_line(root / "proc/sys/kernel/sched_rt_period_us"), 0);

  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  machine.cores = sched_getaffinity(0, sizeof allowed, &allowed) == 0
                      ? CPU_COUNT(&allowed)
                      : static_cast<int>(std::thread::hardware_concurrency());
  rlimit limit = {};
  if (geteuid() == 0) {
    machine.fifo_limit = 99;
  } else if (getrlimit(RLIMIT_RTPRIO, &limit) == 0) {
    machine.fifo_limit = static_cast<int>(limit.rlim_cur > 99 ? 99 : limit.rlim_cur);
  }
  if (geteuid() == 0) {
    machine.locked_bytes = kNoLimit;
  } else if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0) {
    machine.locked_bytes = limit.rlim_cur == RLIM_INFINITY ? kNoLimit : limit.rlim_cur;
  }
  return machine;
}

}  // namespace burr::rt
