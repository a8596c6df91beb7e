// workshop/fault_file.h - the last ticks before a haptic device's force was released.
//
// A CSV table to look at afterwards or to send: first the cause in a sentence, then one row for
// each tick. It holds no name of a patient and no file name. Thread: main.
#pragma once

#include <filesystem>
#include <string>

#include "burr/base/result.h"
#include "burr/device/hand_state.h"
#include "burr/tick/servo.h"

namespace burr::workshop {

// The table as CSV; the sentences before it stand in lines that begin with '#'.
[[nodiscard]] std::string fault_text(const tick::FaultReport& report,
                                     const device::DeviceSpec& device, double rate_hz,
                                     const std::string& trouble);

// Writes folder/fault-YYYYMMDD-HHMMSS.csv (UTC), keeps the newest 20, and returns the path. Creates
// the folder if it is missing.
[[nodiscard]] Result<std::filesystem::path> keep_fault(const std::filesystem::path& folder,
                                                       const std::string& text);

}  // namespace burr::workshop
