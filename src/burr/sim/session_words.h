// sim/session_words.h - writes the settings of a session as named numbers into a recording and
// reads them back; a replay needs each of them exact to the bit.
//
// Thread: any. Names carry their units.
#pragma once

#include "burr/base/result.h"
#include "burr/record/session_info.h"
#include "burr/sim/session.h"

namespace burr::sim {

void describe(const SessionSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info);

struct Recorded {
  SessionSettings settings;
  device::DeviceSpec device;
};
// Error: a number that a replay needs is missing.
[[nodiscard]] Result<Recorded> settings_of(const record::SessionInfo& info,
                                           const std::string& where);

}  // namespace burr::sim
