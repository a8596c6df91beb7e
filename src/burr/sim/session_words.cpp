#include "burr/sim/session_words.h"

#include <fmt/format.h>

#include <span>
#include <string>

#include "burr/base/printable.h"
#include "burr/tick/own_law.h"
#include "burr/tick/second_hand.h"
#include "burr/tick/setting_table.h"

namespace burr::sim {
namespace {

constexpr std::size_t kHashDigits = 64;

template <class Of>
void write(std::span<const tick::Setting<Of>> table, const Of& settings, record::Numbers& numbers) {
  for (const tick::Setting<Of>& one : table) numbers[one.about.name] = one.get(settings);
}

// The numbers of a recording.
struct Source {
  const record::Numbers& numbers;
  const std::string& where;
  const std::string& version;  // of the burr that recorded it
  const char* whose;           // "session", "second hand"
  bool old;                    // it may be older than a setting
};

template <class Of>
Status read(std::span<const tick::Setting<Of>> table, const Source& from, Of& settings) {
  for (const tick::Setting<Of>& one : table) {
    const tick::About& about = one.about;
    const auto found = from.numbers.find(about.name);
    if (found == from.numbers.end() && from.old && *about.since != '\0') {
      one.set(settings, about.before);
      continue;
    }
    if (found == from.numbers.end())
      return error(fmt::format(
          "{}: the {}'s setting {} is missing in this recording; it was recorded by another "
          "version of burr ({})",
          from.where, from.whose, about.name, base::printable(from.version)));
    if (!about.recorded.has(found->second))
      return error(
          fmt::format("{}: the {}'s setting {} is {}, which is out of range ({:g} to "
                      "{:g}); the recording is damaged",
                      from.where, from.whose, about.name, found->second, about.recorded.least,
                      about.recorded.most));
    one.set(settings, found->second);
  }
  return fine();
}

}  // namespace

void describe(const SessionSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info) {
  write(tick::servo_settings(), settings.servo, info.numbers);
  write(tick::limit_settings(), settings.servo.limit, info.numbers);
  write(tick::surface_settings(), settings.surface, info.numbers);
  write(tick::device_settings(), device, info.numbers);
  info.rate_hz = settings.servo.rate_hz;
  info.words["device"] = device.name;
  info.tools = settings.servo.tools;
  if (settings.law) describe(settings.law->about(), info);
}

void describe(const tick::SecondHandSettings& settings, const device::DeviceSpec& device,
              record::SessionInfo& info) {
  record::SecondInfo& second = info.second.emplace();
  write(tick::second_hand_settings(), settings, second.numbers);
  write(tick::limit_settings(), settings.limit, second.numbers);
  write(tick::device_settings(), device, second.numbers);
  second.device = device.name;
  if (settings.tool) second.tools.push_back(*settings.tool);
}

void describe(const tick::LawAbout& law, record::SessionInfo& info) {
  for (const auto& [name, text] : {std::pair{"law", law.kind},
                                   {"law_name", law.name},
                                   {"law_sha256", law.sha256},
                                   {"law_settings_sha256", law.settings_sha256}})
    if (!text.empty()) info.words[name] = text;
}

tick::LawAbout law_of(const record::SessionInfo& info) {
  const auto word = [&info](const char* name) {
    const auto found = info.words.find(name);
    return found == info.words.end() ? std::string() : found->second;
  };
  return {word("law"), word("law_name"), word("law_sha256"), word("law_settings_sha256")};
}

Status check_law(const record::SessionInfo& info, const tick::OwnLaw* given,
                 const std::string& where) {
  const tick::LawAbout was = law_of(info),
                       is = given != nullptr ? given->about() : tick::LawAbout();
  const std::string name = base::printable(was.name);
  if (was.kind != "compiled") {
    if (given == nullptr) return fine();
    return error(Trouble::usage,
                 was.kind.empty()
                     ? fmt::format("{}: was made without a custom law; leave out `law`", where)
                     : fmt::format("{}: its law was a function of Python, whose answers are in the "
                                   "recording; leave out `law`",
                                   where));
  }
  if (given == nullptr)
    return error(Trouble::usage,
                 fmt::format("{}: was made with the law {} (SHA-256 {}); give that file with `law`",
                             where, name, base::printable(was.sha256, kHashDigits)));
  if (is.sha256 != was.sha256)
    return error(
        Trouble::usage,
        fmt::format("{}: was made with another law: the SHA-256 of {} was {}, that of `law` "
                    "{} is {}; give the file that it was made with",
                    where, name, base::printable(was.sha256, kHashDigits), base::printable(is.name),
                    is.sha256));
  if (is.settings_sha256 != was.settings_sha256)
    return error(
        Trouble::usage,
        was.settings_sha256.empty()
            ? fmt::format("{}: its law {} had no settings; leave out `law_settings`", where, name)
            : fmt::format("{}: its law {} had other settings (SHA-256 {}); give their file with "
                          "`law_settings`",
                          where, name, base::printable(was.settings_sha256, kHashDigits)));
  return fine();
}

Result<Recorded> settings_of(const record::SessionInfo& info, const std::string& where) {
  Recorded all;
  tick::ServoSettings& servo = all.settings.servo;
  const Source from = {info.numbers, where, info.burr_version, "session", true};
  Status good = read(tick::servo_settings(), from, servo);
  if (good) good = read(tick::limit_settings(), from, servo.limit);
  if (good) good = read(tick::surface_settings(), from, all.settings.surface);
  if (good) good = read(tick::device_settings(), from, all.device);
  if (!good) return good.error();
  servo.tools = info.tools;
  if (servo.tool >= static_cast<int>(info.tools.size()))
    return error(
        fmt::format("{}: the session's tool has number {}, but the recording holds {} tools; "
                    "the recording is damaged",
                    where, servo.tool, info.tools.size()));
  const auto name = info.words.find("device");
  if (name != info.words.end()) all.device.name = name->second;
  return all;
}

Result<RecordedSecond> second_of(const record::SessionInfo& info, const std::string& where) {
  RecordedSecond all;
  const record::SecondInfo& second = *info.second;
  // no setting is younger than the second hand
  const Source from = {second.numbers, where, info.burr_version, "second hand", false};
  Status good = read(tick::second_hand_settings(), from, all.settings);
  if (good) good = read(tick::limit_settings(), from, all.settings.limit);
  if (good) good = read(tick::device_settings(), from, all.device);
  if (!good) return good.error();
  all.device.name = second.device;
  if (!second.tools.empty()) all.settings.tool = second.tools.front();
  return all;
}

}  // namespace burr::sim
