// A fake Polhem (fake/fake_polhem.h) on a pseudo terminal. Its frame: x to the user, y right, z up.
// Its button is not read. A terminal whose other end was closed never comes back, so to be
// unplugged it falls silent instead, while its motors continue.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "burr/device/polhem/polhem.h"
#include "device/fake/fake_polhem.h"
#include "device/players/device_player.h"

namespace burr::test {

class PolhemPlayer final : public Player {
 public:
  PolhemPlayer() {
    arm_.with([](FakePolhem::Commands& commands) { commands.rate_hz = 1000; });
  }
  std::unique_ptr<device::Device> device(const device::LinkSettings& link) override {
    const device::polhem::PolhemSettings settings{.port = arm_.path, .system = "/nowhere"};
    return std::make_unique<device::WireDevice>(std::make_unique<device::polhem::Polhem>(settings),
                                                link);
  }

  void hold(const math::Vec3& place, const math::Vec3&) override {
    arm_.with([&](FakePolhem::Commands& commands) {
      for (int axis = 0; axis < 3; ++axis) commands.mm[axis] = 1e3 * place[(axis + 2) % 3];
    });
  }
  bool mill(bool) override { return false; }
  bool clutch(bool) override { return false; }
  void unplug() override {
    arm_.with([](FakePolhem::Commands& commands) { commands.silent = true; });
  }
  void plug_in() override {
    arm_.with([](FakePolhem::Commands& commands) { commands.silent = false; });
  }

  math::Vec3 force() override { return ours(arm_.force()); }
  double largest() override {
    return arm_.with([](FakePolhem::Commands& commands) { return commands.largest; });
  }
  std::vector<Felt> felt() override {
    std::vector<Felt> all;
    for (const Answer& one :
         arm_.with([](FakePolhem::Commands& commands) { return commands.answers.look(); }))
      all.push_back({1e-3 * ours(math::Vec3(one.told.data())), ours(math::Vec3(one.force.data()))});
    return all;
  }
  [[nodiscard]] double limit() const override { return 5; }
  std::string misuse() override {
    return arm_.with([](FakePolhem::Commands& commands) { return commands.odd; }) == 0
               ? ""
               : "a line that is none";
  }

 private:
  static math::Vec3 ours(const math::Vec3& v) { return {v.y(), v.z(), v.x()}; }

  FakePolhem arm_;
};

}  // namespace burr::test
