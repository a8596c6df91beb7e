// Messages of Haply's service that must not be believed, or must be believed at once.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "burr/device/haply/inverse.h"
#include "burr/device/haply/message.h"
#include "device/fake/fake_haply.h"
#include "device/stand_in.h"

namespace burr::device::haply {
namespace {

using math::Vec3;
using test::FakeHaply;
using test::soon;
using Commands = FakeHaply::Commands;

class HaplyDoubt : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(wire_.connect().ok()); }
  // The reading after the service has been changed.
  HandState next(int readings = 2) {
    HandState hand;
    for (int n = 0; n < readings;) {
      const Wire::Read read = wire_.read(hand);
      EXPECT_NE(read, Wire::Read::lost) << wire_.why();
      if (read == Wire::Read::lost) break;
      if (read == Wire::Read::hand) ++n;
      EXPECT_TRUE(wire_.write(Vec3::Zero()));
    }
    return hand;
  }

  FakeHaply service_;
  Inverse wire_{{.host = "127.0.0.1", .port = service_.port, .id = {}}};
};

TEST_F(HaplyDoubt, AHandMetresAwayIsNotBelieved) {
  EXPECT_TRUE(next().valid);
  service_.with([](Commands& w) { w.arms[0].place = {1.2, 0, 0}; });
  EXPECT_FALSE(next().valid);
  service_.with([](Commands& w) { w.arms[0].place = {0.1, 0, 0}; });
  EXPECT_TRUE(next().valid);
}

TEST_F(HaplyDoubt, AnArmWithoutPowerOrCalibrationIsNotBelieved) {
  service_.with([](Commands& w) { w.arms[0].powered = false; });
  EXPECT_FALSE(next().valid);
  service_.with([](Commands& w) {
    w.arms[0].powered = true;
    w.arms[0].calibrated = false;
  });
  EXPECT_FALSE(next().valid);
  service_.with([](Commands& w) { w.arms[0].calibrated = true; });
  EXPECT_TRUE(next().valid);
}

TEST_F(HaplyDoubt, AnArmThatIsNotInAMessageIsUnpluggedAtOnce) {
  next();
  service_.with([](Commands& w) { w.arms.clear(); });
  HandState hand;
  int readings = 0;
  ASSERT_TRUE(soon([&] {
    const Wire::Read read = wire_.read(hand);
    if (read == Wire::Read::hand) ++readings;
    static_cast<void>(wire_.write(Vec3::Zero()));
    return read == Wire::Read::lost;
  }));
  EXPECT_LE(readings, 1) << "one message was under way";
  EXPECT_NE(wire_.why().find("unplugged"), std::string::npos) << wire_.why();
}

// The service has several arms: within a session one arm is never taken for another.
TEST_F(HaplyDoubt, AnotherArmThanBeforeIsNotTaken) {
  wire_.disconnect();
  WireDevice device(std::make_unique<Inverse>(
      InverseSettings{.host = "127.0.0.1", .port = service_.port, .id = {}}));
  ASSERT_TRUE(device.open().ok());
  service_.with([](Commands& w) { w.arms[0].id = "OTHER"; });
  EXPECT_TRUE(soon([&] { return device.trouble().find("Another device") != std::string::npos; }))
      << device.trouble();
  EXPECT_EQ(device.reconnections(), 0);
  EXPECT_EQ(service_.with([](Commands& w) { return w.arms[0].force; }), Vec3::Zero());
  service_.with([](Commands& w) { w.arms[0].id = "049D"; });
  EXPECT_TRUE(soon([&] { return device.reconnections() == 1; })) << device.trouble();
}

// However late it answers, burr sends one message: each answer belongs to one message.
TEST_F(HaplyDoubt, TwoMessagesAreNeverUnderWay) {
  next();
  const int before = service_.messages;
  service_.with([](Commands& w) { w.stall_ms = 50; });
  next(20);
  EXPECT_LE(service_.messages - before, 21);
}

TEST(HaplyMessage, ATurnOfNoLengthIsNonsenseAndChangesNothing) {
  State known;
  known.grip = math::Quat(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
  const State before = known;
  EXPECT_EQ(read_state(R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":0.1}}}],
                           "verse_grip":[{"state":{"orientation":{"w":0,"x":0,"y":0,"z":0}}}]})",
                       "049D", "", known),
            Read::nonsense);
  EXPECT_EQ(known.grip.coeffs(), before.grip.coeffs());
  EXPECT_EQ(known.place, before.place);
}

TEST(HaplyMessage, AVersionIsReadHoweverItIsWritten) {
  EXPECT_EQ(read_version(R"({"ok":true,"data":{"project_version":"3.5.0"}})"), 305);
  EXPECT_EQ(read_version(R"({"git_tag":"v3.1.2-4-gabc"})"), 301);
  EXPECT_EQ(read_version(R"({"version":"10.12"})"), 1012);
  EXPECT_EQ(read_version("<html>"), 0);
  EXPECT_STREQ(key_of_force(read_version(R"({"version":"3.5"})")), "vector");
  EXPECT_STREQ(key_of_force(read_version(R"({"version":"3.4.9"})")), "values");
}

}  // namespace
}  // namespace burr::device::haply
