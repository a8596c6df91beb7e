// sim/session_words.h - writes the settings of a session as named numbers into a recording and
// reads them back; a replay needs each of them exact to the bit.
//
// Thread: any. Names carry their units.
#pragma once

#include "burr/base/result.h"
#include "burr/device/hand_state.h"
#include "burr/record/session_info.h"
#include "burr/sim/session.h"
#include "burr/tick/second_hand_settings.h"

namespace burr::tick {
struct LawAbout;
}

namespace burr::sim {

void describe(const SessionSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info);

// The custom law; none: nothing is written, and its kind is empty.
void describe(const tick::LawAbout& law, record::SessionInfo& info);
[[nodiscard]] tick::LawAbout law_of(const record::SessionInfo& info);
// May this law be asked again in a replay of the recording? nullptr: none is there. Error: the recording was
// made with another one, or needs one.
[[nodiscard]] Status check_law(const record::SessionInfo& info, const tick::OwnLaw* given,
                               const std::string& where);

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
