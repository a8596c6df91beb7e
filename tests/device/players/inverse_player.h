// A fake Inverse3 with a grip (fake/fake_haply.h), behind a service on the loopback interface. Its
// frame: x right, y forward, z up.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "burr/device/haply/inverse.h"
#include "device/fake/fake_haply.h"
#include "device/players/device_player.h"

namespace burr::test {

class InversePlayer final : public Player {
  using Arm = FakeHaply::Arm;
  template <class F>
  auto with(F look) {
    return service_.with([&](FakeHaply::Commands& commands) {
      return look(commands.arms.empty() ? away_ : commands.arms.front());
    });
  }

 public:
  std::unique_ptr<device::Device> device(const device::LinkSettings& link) override {
    const device::haply::InverseSettings settings{
        .host = "127.0.0.1", .port = service_.port, .id = {}};
    return std::make_unique<device::WireDevice>(std::make_unique<device::haply::Inverse>(settings),
                                                link);
  }

  void hold(const math::Vec3& place, const math::Vec3& velocity) override {
    with([&](Arm& arm) {
      arm.place = {place.x(), -place.z(), place.y()};
      arm.velocity = {velocity.x(), -velocity.z(), velocity.y()};
    });
  }
  bool mill(bool down) override { return press(1U, down); }
  bool clutch(bool down) override { return press(2U, down); }
  void unplug() override {
    service_.with([&](FakeHaply::Commands& commands) {
      away_ = commands.arms.front();
      commands.arms.clear();
      away_.force.setZero();  // the service releases a force that is not requested any more
    });
  }
  void plug_in() override {
    service_.with([&](FakeHaply::Commands& commands) { commands.arms = {away_}; });
  }

  math::Vec3 force() override {
    return with([](Arm& arm) { return ours(arm.force.data()); });
  }
  double largest() override {
    return with([](Arm& arm) { return arm.largest; });
  }
  std::vector<Felt> felt() override {
    std::vector<Felt> all;
    for (const Answer& one : with([](Arm& arm) { return arm.answers.look(); }))
      all.push_back({ours(one.told.data()), ours(one.force.data())});
    return all;
  }
  [[nodiscard]] double limit() const override { return 8; }
  // It answers five thousand times a second at most, so only every fifth reading begins a tick: the
  // force may be late by that many.
  [[nodiscard]] int most_late() const override { return 5; }

 private:
  static math::Vec3 ours(const double* v) { return {v[0], v[2], -v[1]}; }
  bool press(unsigned button, bool down) {
    service_.with([&](FakeHaply::Commands& commands) {
      commands.buttons = down ? commands.buttons | button : commands.buttons & ~button;
    });
    return true;
  }

  FakeHaply service_;
  Arm away_;
};

}  // namespace burr::test
