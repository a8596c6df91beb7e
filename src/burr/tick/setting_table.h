// tick/setting_table.h - every setting of a session that a recording keeps, each once: its name, unit,
// range and meaning, and how to reach it. Recordings, cases, the command line, Python and
// docs/use/settings.md are loops over it, and every session checks it.
//
//     for (const Setting<ServoSettings>& one : servo_settings()) one.set(servo, one.get(other));
//     if (Status good = check_settings(servo); !good) return good.error();
//     // "motor_torque_nm: must be a number from 0 to 1 N m, not -1"
//
// A setting has two ranges. What a new session takes is checked wherever one is made. What a recording may
// hold is as wide or wider: an older burr took more, and its recordings are still read.
//
// Thread: any. Units: SI; a person gives some settings in other ones (Typed).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "burr/base/given.h"
#include "burr/base/result.h"
#include "burr/device/hand_state.h"
#include "burr/haptics/safety/limit.h"
#include "burr/tick/settings.h"
#include "burr/volume/iso_vertices.h"

namespace burr::tick {

struct SecondHandSettings;

struct Range {
  double least = 0, most = 1;
  // False also for what is no number.
  [[nodiscard]] constexpr bool has(double value) const { return value >= least && value <= most; }
};

// How a person gives a setting: in a case, on the command line, in Python.
struct Typed {
  const char* word = nullptr;  // "torque_mnm"; nullptr: only programs set it
  const char* unit = "";       // "mN m"
  double (*to_si)(double) = nullptr;
  double (*from_si)(double) = nullptr;  // to say a limit; not exact to the bit
  const char* help = "";                // "": as About::help
  // Where it stands in a case; where it stands in neither, no case has it.
  enum class Place { neither, session, burr } place = Place::neither;
  // Its names on the command line and in Python, where they are not the word: "rate", "guarded".
  const char *option = nullptr, *property = nullptr;
};

struct About {
  enum class Kind { number, whole, flag, choice };

  const char* name;  // in a recording, with its unit: "motor_torque_nm"
  const char* unit;  // "N m"; "": a share, a gain, a number of things
  Kind kind;
  Range range;     // of a new session
  Range recorded;  // of a recording; holds `range`
  const char* help;
  std::span<const std::string_view> choices = {};  // the names of the values 0, 1, 2 ...
  Typed typed = {};
  const char* since = "";  // recordings have it since that day; "": always
  double before = 0;       // its value in those that lack it

  // ---- to write the table
  [[nodiscard]] constexpr About read_from(double least, double most) const {
    About all = *this;
    all.recorded = {least, most};
    return all;
  }
  [[nodiscard]] constexpr About as(const Typed& by_persons) const {
    About all = *this;
    all.typed = by_persons;
    return all;
  }
  [[nodiscard]] constexpr About from_day(const char* day, double earlier) const {
    About all = *this;
    all.since = day;
    all.before = earlier;
    return all;
  }
};

template <class Of>
struct Setting {
  About about;
  double (*get)(const Of&);
  void (*set)(Of&, double);  // of a value in About::recorded
};

// In the order of recordings. The limits of the force, which both hands have, are apart.
[[nodiscard]] std::span<const Setting<ServoSettings>> servo_settings();
[[nodiscard]] std::span<const Setting<haptics::LimitSettings>> limit_settings();
[[nodiscard]] std::span<const Setting<volume::IsoSettings>> surface_settings();
[[nodiscard]] std::span<const Setting<SecondHandSettings>> second_hand_settings();
// What a recording keeps of a device; its driver sets it.
[[nodiscard]] std::span<const Setting<device::DeviceSpec>> device_settings();

// By the word that persons use, "torque_mnm"; nullptr: there is none.
[[nodiscard]] const Setting<ServoSettings>* setting_of_word(std::string_view word);

// Refuses what is out of its range, or no number, in one sentence with the setting's name and value.
[[nodiscard]] Status check_settings(const ServoSettings& settings);
[[nodiscard]] Status check_settings(const volume::IsoSettings& settings);
[[nodiscard]] Status check_settings(const SecondHandSettings& settings);
[[nodiscard]] Status check_settings(const device::DeviceSpec& spec);

// What persons gave, by Typed::word and in their units.
using TypedValues = std::map<std::string, base::Given, std::less<>>;
// Each as a session has it if nobody says anything, with six digits at the most.
[[nodiscard]] TypedValues usual_values();
[[nodiscard]] base::Given usual_value(const Setting<ServoSettings>& setting);
// The value in SI, to the bit the same for each front. Error: "must be a number from 0 to 1000 mN m, not
// -5"; the caller puts its own word for the setting in front.
[[nodiscard]] Result<double> si_of(const About& about, const base::Given& given);
// They become settings; what is not among them stays. Error: as si_of(), after word_of(about) and ": ".
[[nodiscard]] Status take_typed(const TypedValues& values,
                                const std::function<std::string(const About&)>& word_of,
                                ServoSettings& settings);

// Its name in Python.
[[nodiscard]] const char* property_of(const About& about);
// "a number from 0 to 1000 mN m", "true or false"
[[nodiscard]] std::string typed_range(const About& about);
// The same in SI: "a number from 0 to 1 N m", of a new session or of a recording.
[[nodiscard]] std::string range_of(const About& about, const Range& range);
// As an error says it: 0.0003, true, "constraint"
[[nodiscard]] std::string text_of(const base::Given& given);
// The value of one of About::choices; none: it has no such name.
[[nodiscard]] std::optional<double> choice_named(const About& about, std::string_view name);

}  // namespace burr::tick
