// Every row of the table of settings: what a session takes, what it refuses and with which words, and that
// a recording keeps it to the bit.
#include "burr/tick/setting_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "burr/device/replayed_hand.h"
#include "burr/phantom/build.h"
#include "burr/phantom/shapes.h"
#include "burr/scenario/rack.h"
#include "burr/sim/session.h"
#include "burr/sim/session_words.h"
#include "burr/tick/second_hand.h"
#include "burr/tool/limits.h"

namespace burr::sim {
namespace {

using math::Vec3;
using tick::About;
using tick::Setting;
using Kind = tick::About::Kind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// All that a session is made of.
struct All {
  SessionSettings settings;
  tick::SecondHandSettings second;
  device::DeviceSpec device, second_device;
};

// Calls use(table, part): part(all) is the struct that the table is of.
template <class Use>
void each_table(const Use& use) {
  use(
      tick::servo_settings(), [](All & all) -> auto& { return all.settings.servo; });
  use(
      tick::limit_settings(), [](All & all) -> auto& { return all.settings.servo.limit; });
  use(
      tick::surface_settings(), [](All & all) -> auto& { return all.settings.surface; });
  use(
      tick::device_settings(), [](All & all) -> auto& { return all.device; });
  use(
      tick::second_hand_settings(), [](All & all) -> auto& { return all.second; });
  use(
      tick::limit_settings(), [](All & all) -> auto& { return all.second.limit; });
  use(
      tick::device_settings(), [](All & all) -> auto& { return all.second_device; });
}

Status check_all(const All& all) {
  Status good = tick::check_settings(all.settings.servo);
  if (good) good = tick::check_settings(all.settings.surface);
  if (good) good = tick::check_settings(all.device);
  if (good) good = tick::check_settings(all.second_device);
  if (good) good = tick::check_settings(all.second);
  return good;
}

// Whether the member can hold such a value at all: no truth is 2, no count is below 0.
bool possible(const About& about, double value) {
  const std::string name = about.name;
  if (about.kind == Kind::number) return true;
  if (!std::isfinite(value) || about.kind == Kind::flag || name == "deposit_tissue") return false;
  return value >= 0 || (name != "undo_bricks" && name != "reserve_blocks");
}

// The values next to a range, and those that are no number.
std::array<double, 5> beyond(const About& about) {
  const tick::Range range = about.range;
  const double step = about.kind == Kind::number ? 1e-6 * (range.most - range.least) : 1;
  return {range.least - step, range.most + step, kNan, kInfinity, -kInfinity};
}

std::unique_ptr<volume::Bone> slab() {
  return phantom::bone_from_distance(
      phantom::box_grid(Vec3::Constant(-4e-3), Vec3::Constant(4e-3), 0.5e-3), {}, phantom::slab(),
      8);
}

// A session in which everything is usual but what `all` says.
Status made(const All& all) {
  NoProgress quiet;
  SessionSettings settings = all.settings;
  settings.threads = 1;
  if (settings.servo.undo_bricks == tick::ServoSettings{}.undo_bricks)
    settings.servo.undo_bricks = 16;
  auto session =
      Session::make(slab(), std::make_unique<device::ReplayedHand>(all.device), settings, quiet);
  if (!session) return session.error();
  return (*session)->add_second_hand(std::make_unique<device::ReplayedHand>(all.second_device),
                                     all.second);
}

void expect_named(const Status& status, const About& about, double value) {
  ASSERT_FALSE(status) << about.name << " " << value;
  const std::string& text = status.error().text;
  EXPECT_EQ(status.error().trouble, Trouble::usage) << text;
  EXPECT_NE(text.find(std::string(about.name) + ": must be "), std::string::npos) << text;
  const std::string said = std::isnan(value) ? "nan" : fmt::format("{}", value);
  EXPECT_TRUE(text.ends_with(", not " + said)) << text << " / " << said;
  EXPECT_EQ(text.find("--"), std::string::npos) << text;
}

TEST(SettingTable, TakesTheUsual) {
  const Status good = check_all({});
  EXPECT_TRUE(good) << good.error().text;
  std::set<std::string> names, words;
  std::size_t rows = 0;
  each_table([&]<class Of>(std::span<const Setting<Of>> table, const auto& part) {
    All all;
    rows += table.size();
    for (const Setting<Of>& one : table) {
      const About& about = one.about;
      EXPECT_TRUE(about.range.has(one.get(part(all)))) << about.name;
      EXPECT_LE(about.recorded.least, about.range.least) << about.name;
      EXPECT_GE(about.recorded.most, about.range.most) << about.name;
      EXPECT_TRUE(*about.since == '\0' || about.recorded.has(about.before)) << about.name;
      EXPECT_STRNE(about.help, "") << about.name;
      if constexpr (!std::is_same_v<Of, tick::SecondHandSettings>) names.insert(about.name);
      if (about.typed.word != nullptr) {
        EXPECT_TRUE(words.insert(about.typed.word).second) << about.typed.word;
      }
    }
  });
  // no name twice: they share one list in a recording
  EXPECT_EQ(names.size(), rows - tick::second_hand_settings().size() -
                              tick::limit_settings().size() - tick::device_settings().size());
}

TEST(SettingTable, TakesBothEndsAndNamesWhatLiesBeyond) {
  int refused = 0;
  each_table([&]<class Of>(std::span<const Setting<Of>> table, const auto& part) {
    for (const Setting<Of>& one : table) {
      const About& about = one.about;
      for (const double end : {about.range.least, about.range.most}) {
        All all;
        one.set(part(all), end);
        const Status good = check_all(all);
        EXPECT_TRUE(good) << good.error().text;
      }
      for (const double value : beyond(about)) {
        if (!possible(about, value)) continue;
        All all;
        one.set(part(all), value);
        // of a float the value is what the float is
        expect_named(check_all(all), about, one.get(part(all)));
        ++refused;
      }
    }
  });
  EXPECT_GT(refused, 300);
}

TEST(SettingTable, NoSessionIsMadeWithWhatLiesBeyond) {
  ASSERT_TRUE(made({})) << made({}).error().text;
  each_table([&]<class Of>(std::span<const Setting<Of>> table, const auto& part) {
    for (const Setting<Of>& one : table)
      for (const double value : {beyond(one.about)[1], kNan}) {
        if (!possible(one.about, value)) continue;
        All all;
        one.set(part(all), value);
        expect_named(made(all), one.about, one.get(part(all)));
      }
  });
}

// What issue 42 found: the recording of such a session could not be read.
TEST(SettingTable, SaysWhatIsWrongInOneSentence) {
  All all;
  all.settings.servo.drag_gain = -50;
  EXPECT_EQ(made(all).error().text, "drag_gain: must be a number from 0 to 10, not -50");
  all.settings.servo.drag_gain = kNan;
  EXPECT_EQ(made(all).error().text, "drag_gain: must be a number from 0 to 10, not nan");
  all = {};
  all.settings.servo.motor.torque = -1;
  EXPECT_EQ(made(all).error().text, "motor_torque_nm: must be a number from 0 to 1 N m, not -1");
  all = {};
  all.settings.servo.burr.teeth = 65;
  EXPECT_EQ(made(all).error().text, "burr_teeth: must be a whole number from 1 to 64, not 65");
  all = {};
  all.second.friction = -1;
  EXPECT_EQ(made(all).error().text,
            "the second hand's friction: must be a number from 0 to 1000, not -1");
  all = {};
  all.device.lever = kInfinity;
  EXPECT_EQ(
      made(all).error().text,
      "the device \"simulated hand\": device_lever_m: must be a number from 0 to 10 m, not inf");
}

// ---- recordings

record::SessionInfo described(const All& all, const volume::Bone& bone) {
  record::SessionInfo info;
  describe(all.settings, all.device, info);
  describe(all.second, all.second_device, info);
  info.volume.content_hash = bone.content_hash();
  info.volume.grid = bone.grid();
  info.volume.tissues = bone.tissues();
  return info;
}

std::uint64_t bits(double value) { return std::bit_cast<std::uint64_t>(value); }

// The value of each row after a way through the text of a recording.
template <class Check>
void expect_kept(const All& all, const volume::Bone& bone, const Check& check) {
  const record::SessionInfo info = described(all, bone);
  const Status writable = record::check(info);
  ASSERT_TRUE(writable) << writable.error().text;
  const auto read = record::session_from_json(record::to_json(info), "s.mcap");
  ASSERT_TRUE(read) << read.error().text;
  const auto session = settings_of(*read, "s.mcap");
  ASSERT_TRUE(session) << session.error().text;
  const auto second = second_of(*read, "s.mcap");
  ASSERT_TRUE(second) << second.error().text;
  All back{session->settings, second->settings, session->device, second->device};
  check(back);
}

TEST(SettingTable, ARecordingKeepsBothEndsToTheBit) {
  const auto bone = slab();
  const scenario::RackTool saw = *scenario::built_in_rack().get("sagittal-saw");
  All usual;
  usual.settings.servo.tools.resize(tool::kMostTools, {saw.name, saw.tool, saw.cutter});
  each_table([&]<class Of>(std::span<const Setting<Of>> table, const auto& part) {
    for (const Setting<Of>& one : table) {
      const About& about = one.about;
      const double inside = about.range.least + (about.range.most - about.range.least) / 3;
      for (const double value : {about.range.least, about.range.most, about.recorded.least,
                                 about.recorded.most, inside}) {
        All all = usual;
        one.set(part(all), value);
        const double was = one.get(part(all));
        expect_kept(all, *bone, [&](All& back) {
          EXPECT_EQ(bits(one.get(part(back))), bits(was)) << about.name << " " << value;
        });
      }
    }
  });
}

// What held before the day from which recordings have a setting, as burr was on that day.
TEST(SettingTable, ARecordingFromBeforeASettingHasTheValueOfThatDay) {
  const std::map<std::string, double> then = {{"wedge", 0},
                                              {"slip_m_per_s", 0},
                                              {"turn_hand", 0},
                                              {"tool_friction", 0},
                                              {"tool_planes", 0},
                                              {"tool_close_m", 1e-6},
                                              {"torque_gain", 1},
                                              {"irrigated", 0},
                                              {"tool", -1},
                                              {"device_lever_m", 0},
                                              {"device_scale", 1},
                                              {"device_peak_torque_nm", 0},
                                              {"device_max_turn_stiffness_nm_per_rad", 0},
                                              {"device_turn_damping_nm_s_per_rad", 0}};
  const auto bone = slab();
  const record::SessionInfo info = described({}, *bone);
  std::size_t added = 0;
  for (const auto& [name, value] : info.numbers) {
    record::SessionInfo older = info;
    older.numbers.erase(name);
    const auto read = settings_of(older, "s.mcap");
    const auto known = then.find(name);
    ASSERT_EQ(read.ok(), known != then.end()) << name;
    if (!read) {
      EXPECT_NE(read.error().text.find(name), std::string::npos) << read.error().text;
      continue;
    }
    ++added;
    record::SessionInfo again;
    describe(read->settings, read->device, again);
    EXPECT_EQ(again.numbers[name], known->second) << name;
    again.numbers[name] = value;
    EXPECT_EQ(again.numbers, info.numbers) << name;  // and nothing else is otherwise
  }
  EXPECT_EQ(added, then.size());
}

// ---- what persons type

TEST(SettingTable, TakesTheEndsThatItNamesToPersons) {
  int typed = 0;
  for (const Setting<tick::ServoSettings>& one : tick::servo_settings()) {
    const About& about = one.about;
    if (about.typed.word == nullptr) continue;
    ++typed;
    EXPECT_EQ(tick::setting_of_word(about.typed.word), &one);
    for (const double end : {about.range.least, about.range.most}) {
      base::Given shown = std::stod(fmt::format("{:.6g}", about.typed.from_si(end)));
      if (about.kind == Kind::flag) shown = end != 0;
      if (about.kind == Kind::choice)
        shown = std::string(about.choices[static_cast<std::size_t>(end)]);
      const auto good = tick::si_of(about, shown);
      EXPECT_TRUE(good) << about.typed.word << " " << good.error().text;
    }
    for (const double value : beyond(about)) {
      const double shown = std::isfinite(value) ? about.typed.from_si(value) : value;
      const auto wrong = tick::si_of(about, shown);
      ASSERT_FALSE(wrong) << about.typed.word << " " << shown;
      EXPECT_EQ(wrong.error().trouble, Trouble::usage);
      EXPECT_EQ(wrong.error().text,
                "must be " + tick::typed_range(about) + ", not " + tick::text_of(shown));
    }
  }
  EXPECT_GE(typed, 14);
  EXPECT_EQ(tick::setting_of_word("drags"), nullptr);
}

TEST(SettingTable, WhatPersonsTypeBecomesTheBitsOfTheSession) {
  const auto si = [](const char* word, const base::Given& value) {
    return *tick::si_of(tick::setting_of_word(word)->about, value);
  };
  for (const double value : {0.7, 3.1, 4.0, 5.3, 6.123456, 7.0}) {
    EXPECT_EQ(bits(si("burr_mm", value)), bits(0.5e-3 * value));
    EXPECT_EQ(bits(si("rpm", 1e4 * value)), bits(1e4 * value * 2 * std::numbers::pi / 60));
    EXPECT_EQ(bits(si("torque_mnm", value)), bits(1e-3 * value));
    EXPECT_EQ(bits(si("drag", value)), bits(value));
  }
  EXPECT_EQ(si("guard", true), 1);
  EXPECT_EQ(si("touch", std::string("shaft")), static_cast<double>(haptics::Method::shaft));
  EXPECT_EQ(si("teeth", std::int64_t{7}), 7);
  EXPECT_EQ(si("drag", std::int64_t{2}), 2);
}

TEST(SettingTable, RefusesWhatPersonsTypeInOneSentence) {
  const auto said = [](const char* word, const base::Given& value) {
    return tick::si_of(tick::setting_of_word(word)->about, value).error().text;
  };
  EXPECT_EQ(said("torque_mnm", -1.0), "must be a number from 0 to 1000 mN m, not -1");
  EXPECT_EQ(said("burr_mm", 0.5), "must be a number from 0.6 to 7 mm, not 0.5");
  EXPECT_EQ(said("rpm", 6e5), "must be a number from -500000 to 500000 1/min, not 600000");
  EXPECT_EQ(said("teeth", 2.5), "must be a whole number from 1 to 64, not 2.5");
  EXPECT_EQ(said("teeth", std::string("many")),
            "must be a whole number from 1 to 64, not \"many\"");
  EXPECT_EQ(said("guard", std::int64_t{1}), "must be true or false, not 1");
  EXPECT_EQ(said("drag", true), "must be a number from 0 to 10, not true");
  EXPECT_EQ(said("removal", std::string("wish")),
            "must be one of energy, thesis, chips, not \"wish\"");
  EXPECT_EQ(said("removal", std::string("a\x1b[2J\n")),
            "must be one of energy, thesis, chips, not \"a?[2J?\"");
}

// What is not among them stays; an error begins with the caller's word.
TEST(SettingTable, ManyAreTakenAtOnce) {
  const auto word_of = [](const About& about) { return "its " + std::string(about.typed.word); };
  tick::ServoSettings servo;
  ASSERT_TRUE(tick::take_typed({{"drag", 3.0}, {"guard", true}}, word_of, servo));
  EXPECT_EQ(servo.drag_gain, 3);
  EXPECT_TRUE(servo.guarded);
  EXPECT_EQ(servo.rate_hz, tick::ServoSettings().rate_hz);
  const Status wrong = tick::take_typed({{"rate_hz", 20.0}}, word_of, servo);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().text, "its rate_hz: must be a number from 500 to 10000 Hz, not 20");
}

// Whoever says nothing on the command line or in Python gets the session that C++ gives.
TEST(SettingTable, TheUsualIsTheSameForAll) {
  tick::ServoSettings servo;
  ASSERT_TRUE(tick::take_typed(
      tick::usual_values(), [](const About&) { return std::string(); }, servo));
  for (const Setting<tick::ServoSettings>& one : tick::servo_settings()) {
    const double usual = one.get(tick::ServoSettings());
    EXPECT_NEAR(one.get(servo), usual, 1e-6 * std::abs(usual)) << one.about.name;
  }
}

}  // namespace
}  // namespace burr::sim
