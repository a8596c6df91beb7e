// A fake CRTK arm (fake/fake_crtk.h) on a private bus, with its end rotated. It holds its last
// force for ever, and accepts forces while its node is silent.
#pragma once

#include <memory>
#include <vector>

#include "burr/device/crtk/leader.h"
#include "device/fake/fake_crtk.h"
#include "device/players/device_player.h"

namespace burr::test {

class CrtkPlayer final : public Player {
 public:
  std::unique_ptr<device::Device> device(const device::LinkSettings& link) override {
    device::crtk::LeaderSettings settings;
    settings.arm = "/arm";
    settings.domain = domain_;
    return std::make_unique<device::WireDevice>(std::make_unique<device::crtk::Leader>(settings),
                                                link);
  }

  void hold(const math::Vec3& place, const math::Vec3& velocity) override {
    arm_.with([&](FakeCrtkArm::Commands& commands) {
      commands.place = {place, turn_};
      commands.velocity = velocity;
    });
  }
  bool mill(bool down) override {
    arm_.tread("gripper", down);
    return true;
  }
  bool clutch(bool down) override {
    arm_.tread("clutch", down);
    return true;
  }
  void unplug() override {
    arm_.with([](FakeCrtkArm::Commands& commands) { commands.silent = true; });
  }
  void plug_in() override {
    arm_.with([](FakeCrtkArm::Commands& commands) { commands.silent = false; });
  }

  math::Vec3 force() override { return turn_ * arm_.force(); }
  double largest() override {
    return arm_.with([](FakeCrtkArm::Commands& commands) { return commands.largest; });
  }
  std::vector<Felt> felt() override {
    std::vector<Felt> all;
    for (const Answer& one :
         arm_.with([](FakeCrtkArm::Commands& commands) { return commands.answers.look(); }))
      all.push_back({math::Vec3(one.told.data()), turn_ * math::Vec3(one.force.data())});
    return all;
  }
  [[nodiscard]] double limit() const override { return 3; }
  // One force may be on its way while the pose is sent.
  [[nodiscard]] int most_late() const override { return 1; }

 private:
  const math::Quat turn_{Eigen::AngleAxisd(1.1, math::Vec3(1, -2, 0.5).normalized())};
  const int domain_ = quiet_domain();
  FakeCrtkArm arm_{domain_, begins()};

  [[nodiscard]] FakeCrtkArm::Commands begins() const {
    FakeCrtkArm::Commands commands;
    commands.place.q = turn_;
    return commands;
  }
};

}  // namespace burr::test
