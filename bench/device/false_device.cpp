// A simulated device, for `burr bench device` and for trying burr without hardware: one of the
// false devices of the tests. Its hand moves into the bone along its own path, starting again each
// time a program begins to talk to it.
//
//     false_device haply | polhem | crtk    prints what to give burr; runs until it is killed
#include <fmt/core.h>

#include <chrono>
#include <cstdint>
#include <string_view>
#include <thread>

#include "device/fake/fake_crtk.h"
#include "device/fake/fake_haply.h"
#include "device/fake/fake_polhem.h"
#include "device/fake/own_way.h"

namespace {

using namespace burr;
using std::chrono::steady_clock;

// told: how many messages burr has sent so far; put: sets the hand, in its user's frame [m].
template <class Told, class Put>
[[noreturn]] void play(Told told, Put put) {
  constexpr std::chrono::milliseconds kPause(300);  // after such a pause a new program begins
  std::uint64_t known = told();
  auto heard = steady_clock::now() - kPause, began = heard;
  for (auto next = steady_clock::now();; next += std::chrono::microseconds(500)) {
    const std::uint64_t count = told();
    const auto now = steady_clock::now();
    if (count != known) {
      if (now - heard >= kPause) began = now;
      heard = now;
    }
    known = count;
    put(now - heard < kPause ? test::own_way(std::chrono::duration<double>(now - began).count())
                             : math::Vec3(math::Vec3::Zero()));
    std::this_thread::sleep_until(next);
  }
}

}  // namespace

int main(int count, char** words) {
  const std::string_view kind = count == 2 ? words[1] : "";
  if (kind == "haply") {
    test::FakeHaply service;
    fmt::print("HAPLY_WS_PORT={} burr ... --device haply\n", service.port);
    std::fflush(stdout);
    play([&] { return static_cast<std::uint64_t>(service.messages); },
         [&](const math::Vec3& hand) {
           service.with([&](test::FakeHaply::Commands& w) {
             w.arms[0].place = {hand.x(), -hand.z(), hand.y()};
             w.buttons = 1;
           });
         });
  }
  if (kind == "polhem") {
    test::FakePolhem arm;
    fmt::print("burr ... --device polhem:{}\n", arm.path);
    std::fflush(stdout);
    play([&] { return arm.with([](test::FakePolhem::Commands& w) { return w.lines; }); },
         [&](const math::Vec3& hand) {
           arm.with([&](test::FakePolhem::Commands& w) {
             w.mm[0] = 1e3 * hand.z();
             w.mm[1] = 1e3 * hand.x();
             w.mm[2] = 1e3 * hand.y();
           });
         });
  }
  if (kind == "crtk") {
    test::FakeCrtkArm arm(0, "/false");
    arm.tread("gripper", true);
    fmt::print("burr ... --device crtk:/false\n");
    std::fflush(stdout);
    play([&] { return arm.with([](test::FakeCrtkArm::Commands& w) { return w.forces; }); },
         [&](const math::Vec3& hand) {
           arm.with([&](test::FakeCrtkArm::Commands& w) { w.place.p = hand; });
           static std::uint64_t often = 0;
           if (++often % 200 == 0) arm.tread("gripper", true);
         });
  }
  fmt::print(stderr, "false_device haply | polhem | crtk\n");
  return 2;
}
