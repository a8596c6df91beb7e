// burr verify safety - whatever the device reports, the force on the hand stays within its limits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "burr/device/device.h"
#include "burr/phantom/build.h"
#include "burr/tick/servo.h"
#include "verify.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kMm = 1e-3, kDt = 1e-3, kRadius = 1.5 * kMm;

// A device that reports what the test sets, and stores the force that it was sent.
class Puppet final : public device::Device {
 public:
  device::HandState next;
  Vec3 sent = Vec3::Zero();
  Status open() override { return fine(); }
  void close() override {}
  [[nodiscard]] const device::DeviceSpec& spec() const override { return spec_; }
  [[nodiscard]] device::HandState state(double) BURR_RT override { return next; }
  void write_force(const Vec3& force) BURR_RT override { sent = force; }
  void scale_force(double) BURR_RT override {}
  [[nodiscard]] bool finished() const BURR_RT override { return false; }

 private:
  device::DeviceSpec spec_;
};

struct Bench {
  explicit Bench(tick::ServoSettings settings = {})
      : bone(phantom::bone_from_distance(
            phantom::box_grid(Vec3(-8, -8, -6) * kMm, Vec3(8, 8, 6) * kMm, 0.25 * kMm), {},
            phantom::slab(), 4000)),
        surface(*bone, {}, 2, quiet) {
    settings.burr.radius = kRadius;
    limit = settings.limit;
    servo = std::make_unique<tick::Servo>(*bone, surface, puppet, settings);
    puppet.next.pedal = 0;
  }
  const Vec3& step(const Vec3& at, bool lost = false) {
    puppet.next.world_from_tool.p = at;
    (void)servo->tick(lost);
    servo->publish();
    most = std::max(most, puppet.sent.norm());
    const double grew = puppet.sent.norm() - last.norm();
    growth = std::max(growth, grew / kDt);
    not_finite |= !puppet.sent.allFinite();
    last = puppet.sent;
    return puppet.sent;
  }
  void ease(const Vec3& from, const Vec3& to, int ticks) {
    for (int n = 0; n <= ticks; ++n) (void)step(from + (to - from) * (double{1} * n / ticks));
  }
  NoProgress quiet;
  std::unique_ptr<volume::Bone> bone;
  volume::IsoVertices surface;
  Puppet puppet;
  std::unique_ptr<tick::Servo> servo;
  haptics::LimitSettings limit;
  double most = 0, growth = 0;  // of the force [N], [N/s]
  bool not_finite = false;
  Vec3 last = Vec3::Zero();
};

const Vec3 kAir(0, 0, 4 * kMm);
const Vec3 kPressed(0, 0, kRadius - 1 * kMm);  // 1 mm deep: 1 N

// Readings that no hand can give: NaN and infinity, jumps, stalls, in any order.
void fuzzed(const Verify& verify, VerifyReport::Part& part) {
  const auto seed = static_cast<std::mt19937::result_type>(verify.seed_or(20261122));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> stray(0, 1);
  Bench bench;
  bench.ease(kAir, kAir, 100);
  const double bad[] = {std::numeric_limits<double>::quiet_NaN(),
                        std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity(),
                        1e300,
                        -1e300,
                        1e-310};
  Vec3 hand = kAir;
  const int ticks = verify.quick ? 30'000 : 300'000;
  int late_zero = 0;
  for (int n = 0; n < ticks; ++n) {
    hand +=
        Vec3(stray(random), stray(random), stray(random)) * 0.2 * kMm + 0.002 * (kPressed - hand);
    Vec3 said = hand;
    const double what = share(random);
    bench.puppet.next.pedal = share(random) < 0.5 ? 1 : 0;
    bool lost = false;
    if (what < 0.003) said[static_cast<int>(3 * share(random))] = bad[random() % std::size(bad)];
    if (what > 0.997) said += Vec3(stray(random), stray(random), stray(random)) * 0.1;
    if (what > 0.5 && what < 0.502) lost = true;
    if (what > 0.6 && what < 0.6005) {  // random commands, also with senseless values
      const auto kind = static_cast<tick::CommandKind>(random() % 12);
      static_cast<void>(bench.servo->commands().push(
          {kind, share(random) < 0.2 ? bad[random() % std::size(bad)] : 3 * stray(random)}));
    }
    (void)bench.step(said, lost);
    const bool was_bad = !said.allFinite() || (said - hand).norm() > 20e-3;
    if (!was_bad) continue;
    // the force must be zero within 5 ms of detection
    for (int k = 0; k < 6; ++k) (void)bench.step(said, false);
    late_zero += bench.puppet.sent.norm() > 1e-12 ? 1 : 0;
  }
  part.at_most(fmt::format("fuzzed.force (seed {})", seed), bench.limit.user_force + 1e-9,
               bench.most, "N");
  part.at_most("fuzzed.growth", bench.limit.slew + 1e-6, bench.growth, "N/s");
  part.at_most("fuzzed.not_finite", 0, bench.not_finite ? 1 : 0, "");
  part.at_most("fuzzed.not_zero_after_5ms", 0, late_zero, "times");
}

// In contact at 1 N: an event, and how the force returns after it.
void in_contact(VerifyReport::Part& part) {
  struct Event {
    const char* name;
    std::function<void(Bench&)> happens;
  };
  const auto command = [](tick::CommandKind kind, double value) {
    return [kind, value](Bench& bench) {
      static_cast<void>(bench.servo->commands().push({kind, value}));
    };
  };
  using Kind = tick::CommandKind;
  const Event events[] = {
      {"stall_100ms", [](Bench& bench) { (void)bench.step(kPressed, true); }},
      {"not_a_number", [](Bench& bench) { (void)bench.step(Vec3::Constant(NAN)); }},
      {"leap", [](Bench& bench) { (void)bench.step(kPressed + Vec3(0, 0, 50 * kMm)); }},
      {"smaller_burr", command(Kind::burr_radius, 1 * kMm)},
      {"larger_burr", command(Kind::burr_radius, 2 * kMm)},
      {"stiffer", command(Kind::stiffness, 2000)},
      {"undo", command(Kind::undo, 0)},
      {"reset", command(Kind::reset, 0)},
      {"touch_by_penalty", command(Kind::touch_method, 6)},
      {"touch_by_thesis_literal", command(Kind::touch_method, 2)},
  };
  Plot plot{
      "The force on a hand that presses with about a newton, while at 0.2 s something happens: "
      "it fades within 5 ms where the hand is not believed, and grows by no more than its "
      "slew on the way back.",
      2,
      {}};
  for (const Event& event : events) {
    Bench bench;
    bench.ease(kAir, kAir, 100);
    bench.ease(kAir, kPressed, 400);
    // cut first, so that there is something to undo
    bench.puppet.next.pedal = 1;
    bench.ease(kPressed, kPressed, 300);
    bench.puppet.next.pedal = 0;
    bench.ease(kPressed, kPressed, 1000);
    bench.most = bench.growth = 0;
    Line line{event.name, {}, {}};
    const auto move = [&](const Vec3& from, const Vec3& to, int ticks) {
      for (int n = 0; n < ticks; ++n) {
        (void)bench.step(from + (to - from) * (double{1} * n / ticks));
        line.x.push_back(kDt * static_cast<double>(line.x.size()));
        line.y.push_back(bench.last.norm());
      }
    };
    const auto go_on = [&](int ticks) { move(kPressed, kPressed, ticks); };
    go_on(200);
    event.happens(bench);
    go_on(600);
    move(kPressed, kAir, 100);
    move(kAir, kPressed, 100);
    go_on(800);
    part.at_most(std::string("event.") + event.name + ".force", bench.limit.user_force + 1e-9,
                 bench.most, "N");
    part.at_most(std::string("event.") + event.name + ".growth", bench.limit.slew + 1e-6,
                 bench.growth, "N/s");
    plot.axes.push_back({event.name, "time [s]", "force [N]", {line}});
  }
  part.plot(std::move(plot));
}

// Material is added under the tool: the burr is pushed out, within the limits of the force.
void growth(VerifyReport::Part& part) {
  tick::ServoSettings settings;
  settings.mode = tick::ToolMode::add;
  Bench bench(settings);
  bench.ease(kAir, kAir, 100);
  bench.ease(kAir, kPressed, 400);
  bench.most = bench.growth = 0;
  bench.puppet.next.pedal = 1;
  bench.ease(kPressed, kPressed, 3000);
  part.at_most("growth.force", bench.limit.user_force + 1e-9, bench.most, "N");
  part.at_most("growth.growth", bench.limit.slew + 1e-6, bench.growth, "N/s");
}

void safety(const Verify& verify, VerifyReport::Part& part) {
  fuzzed(verify, part);
  in_contact(part);
  growth(part);
  part.cannot(
      "the watchdog's own thread; it is tested on a virtual clock (tests/rt), not by this report");
}

const VerifyPart part{
    60, "safety", "Safety",
    "The whole tick with a device that sends arbitrary values: not-a-number, leaps, lost ticks, "
    "senseless commands; and with changes of tool, method, stiffness and bone during contact. The "
    "force must never exceed the user's limit and never grow faster than the slew limit, and it "
    "must be zero within 5 ms of an impossible reading.",
    safety};

}  // namespace
}  // namespace burr::app
