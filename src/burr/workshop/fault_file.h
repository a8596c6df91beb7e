// workshop/fault_file.h - the last ticks before a haptic device's force was released.
//
// A table to look at afterwards or to send: what happened in words, then one row for each tick.
//
// Holds no name of a patient or a file. Thread: main.
#pragma once

#include <filesystem>
#include <string>

#include "burr/base/result.h"
#include "burr/device/hand.h"
#include "burr/tick/servo.h"

namespace burr::workshop {

// The table, CSV with the words before it behind '#'.
[[nodiscard]] std::string fault_text(const tick::FaultReport& report,
                                     const device::DeviceSpec& device, double rate_hz,
                                     const std::string& trouble);

// folder/fault-YYYYMMDD-HHMMSS.csv (UTC), the newest 20 are kept; its path. Makes the folder.
[[nodiscard]] Result<std::filesystem::path> keep_fault(const std::filesystem::path& folder,
                                                       const std::string& text);

}  // namespace burr::workshop
