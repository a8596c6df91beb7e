// The properties of a computer with Windows, from its registry and its kernel. rt/machine.cpp is the one for Linux.
#include "burr/rt/machine.h"

#include <windows.h>

#include <bit>
#include <thread>

#include "burr/rt/simd.h"

namespace burr::rt {
namespace {

constexpr const char* kSystem = "SOFTWARE\\Microsoft\\Windows NT\\CurrentVersion";
constexpr const char* kProcessor = "HARDWARE\\DESCRIPTION\\System\\CentralProcessor\\0";
constexpr const char* kMaker = "HARDWARE\\DESCRIPTION\\System\\BIOS";

// A text of the registry, below HKEY_LOCAL_MACHINE; empty if it is not there.
std::string text(const char* key, const char* name) {
  char value[256] = {};
  DWORD bytes = sizeof value;
  if (RegGetValueA(HKEY_LOCAL_MACHINE, key, name, RRF_RT_REG_SZ, nullptr, value, &bytes) !=
      ERROR_SUCCESS)
    return "";
  std::string found = value;
  while (!found.empty() && found.back() == ' ') found.pop_back();
  return found;
}

// Virtual machines report their maker where a computer reports that of its mainboard.
std::string maker_of_virtual_machine() {
  const std::string vendor = text(kMaker, "SystemManufacturer"),
                    product = text(kMaker, "SystemProductName");
  for (const char* name :
       {"QEMU", "KVM", "VMware", "VirtualBox", "Xen", "Amazon EC2", "Google Compute", "Parallels"})
    if (vendor.find(name) != std::string::npos || product.find(name) != std::string::npos)
      return name;
  // Microsoft also makes tablets, which are real machines
  return vendor == "Microsoft Corporation" && product == "Virtual Machine" ? vendor : "";
}

int cores_for_this_program() {
  DWORD_PTR mine = 0, all = 0;
  if (GetProcessAffinityMask(GetCurrentProcess(), &mine, &all) != 0 && mine != 0)
    return std::popcount(std::uint64_t{mine});
  return static_cast<int>(std::thread::hardware_concurrency());
}

std::uint64_t memory() {
  MEMORYSTATUSEX status = {};
  status.dwLength = sizeof status;
  return GlobalMemoryStatusEx(&status) != 0 ? status.ullTotalPhys : 0;
}

}  // namespace

// There is no folder to read in, so `root` is not used.
Machine read_machine(const std::filesystem::path& /*root*/) {
  Machine machine;
  machine.processor = text(kProcessor, "ProcessorNameString");
  machine.kernel = "Windows";
  // not the version's number, which is 6.3 for Windows 10 and 11 too
  if (const std::string build = text(kSystem, "CurrentBuildNumber"); !build.empty())
    machine.kernel += ", build " + build;
  machine.clock_source = "QueryPerformanceCounter";
  machine.virtual_machine = maker_of_virtual_machine();
  machine.simd = name(simd());
  machine.cores = cores_for_this_program();
  machine.fifo_limit = 99;          // time-critical priority needs no right
  machine.locked_bytes = memory();  // nor does the working set (rt/thread_rights_windows.cpp)
  return machine;
}

}  // namespace burr::rt
