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
// Of the other hand; describes it in info.second.
void describe(const tick::SecondHandSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info);
struct RecordedSecond {
  tick::SecondHandSettings settings;
  device::DeviceSpec device;
};
// Call it where info.second is there. Error: as settings_of().
[[nodiscard]] Result<RecordedSecond> second_of(const record::SessionInfo& info,
                                               const std::string& where);

// Error: a number that a replay needs is missing.
[[nodiscard]] Result<Recorded> settings_of(const record::SessionInfo& info,
                                           const std::string& where);

}  // namespace burr::sim
