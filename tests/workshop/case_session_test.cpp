// [session] of a case becomes settings; what the table does not have or take is one sentence with its line.
#include "burr/workshop/case_session.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "burr/scenario/case.h"
#include "burr/tick/setting_table.h"

namespace burr::workshop {
namespace {

scenario::Case with(const std::string& lines) {
  auto read = scenario::parse_case(
      "title = \"x\"\nphantom = \"block\"\n[burr]\ndiameter_mm = 5\nrpm = 1000\n[session]\n" +
          lines,
      "x.toml");
  EXPECT_TRUE(read) << read.error().text;
  return std::move(*read);
}

TEST(CaseSession, BecomesSettings) {
  tick::ServoSettings servo;
  ASSERT_TRUE(take_session(with("torque_mnm = 3\ndrag = 2.5\nguard = true\ntouch = "
                                "\"shaft\"\nteeth = 7\nstiffness_n_per_m = 777.7\n"),
                           servo));
  EXPECT_EQ(servo.motor.torque, 1e-3 * 3);
  EXPECT_EQ(servo.drag_gain, 2.5);
  EXPECT_TRUE(servo.guarded);
  EXPECT_EQ(servo.touch, haptics::Method::shaft);
  EXPECT_EQ(servo.burr.teeth, 7);
  EXPECT_EQ(servo.force.stiffness, 777.7);
  EXPECT_EQ(servo.rate_hz, tick::ServoSettings().rate_hz) << "what it does not name stays";
}

TEST(CaseSession, RefusesWithTheLine) {
  for (const auto& [line, words] :
       {std::pair{"rate_hz = 20",
                  "x.toml: line 7: session.rate_hz: must be a number from 500 to 10000 Hz, not 20"},
        {"teeth = 2.5", "session.teeth: must be a whole number from 1 to 64, not 2.5"},
        {"guard = 1", "session.guard: must be true or false, not 1"},
        {"drag = nan", "session.drag: must be a number from 0 to 10, not nan"},
        {"touch = \"\"", "session.touch: must be one of constraint, "},
        {"removal = \"wish\"",
         "session.removal: must be one of energy, thesis, chips, not \"wish\""},
        {"burr_mm = 3", "session.burr_mm: is not a known field; use rate_hz"},
        {"stifness = 3", "session.stifness: is not a known field; use rate_hz"}}) {
    const Status wrong = check_session(with(std::string(line) + "\n"));
    ASSERT_FALSE(wrong) << line;
    EXPECT_NE(wrong.error().text.find(words), std::string::npos) << wrong.error().text;
    EXPECT_TRUE(wrong.error().text.starts_with("x.toml: line 7: ")) << wrong.error().text;
  }
}

// Every field that a case can have is taken with the value that is usual.
TEST(CaseSession, TakesEachField) {
  std::string lines;
  int fields = 0;
  for (const auto& one : tick::servo_settings()) {
    if (one.about.typed.place != tick::Typed::Place::session) continue;
    ++fields;
    lines +=
        std::string(one.about.typed.word) + " = " + tick::text_of(tick::usual_value(one)) + "\n";
  }
  EXPECT_EQ(fields, 11);
  const Status good = check_session(with(lines));
  EXPECT_TRUE(good) << good.error().text;
}

}  // namespace
}  // namespace burr::workshop
