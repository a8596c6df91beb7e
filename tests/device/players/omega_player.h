// A fake omega.6 (fake/fake_dhd.h), loaded like the maker's library. Its frame: x to the user, y
// right, z up.
#pragma once

#include <dlfcn.h>

#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "burr/device/forcedimension/omega.h"
#include "device/fake/fake_dhd.h"
#include "device/players/device_player.h"
#include "support/test_places.h"

namespace burr::test {

class OmegaPlayer final : public Player {
  template <class F>
  auto with(F look) {
    const std::lock_guard lock(dhd_.lock);
    return look(dhd_.arm[0]);
  }

 public:
  OmegaPlayer() : dhd_(false_library()) {
    const std::lock_guard lock(dhd_.lock);
    dhd_.arm = {};
    for (std::size_t other = 1; other < dhd_.arm.size(); ++other) dhd_.arm[other].present = false;
    dhd_.misuse = 0;
  }
  std::unique_ptr<device::Device> device(const device::LinkSettings& link) override {
    device::forcedimension::OmegaSettings settings;
    settings.dhd_file = kLibrary;
    return std::make_unique<device::WireDevice>(
        std::make_unique<device::forcedimension::Omega>(settings), link);
  }

  void hold(const math::Vec3& place, const math::Vec3& velocity) override {
    with([&](FakeArm& arm) {
      arm.place = {place.z(), place.x(), place.y()};
      arm.velocity = {velocity.z(), velocity.x(), velocity.y()};
    });
  }
  bool mill(bool down) override { return press(1U, down); }
  bool clutch(bool down) override { return press(2U, down); }
  void unplug() override {
    with([](FakeArm& arm) { arm.present = false; });
  }
  void plug_in() override {
    with([](FakeArm& arm) {
      arm.present = true;
      arm.forces.clear();  // switching it off removed its old forces
    });
  }

  math::Vec3 force() override {
    return with([](FakeArm& arm) {
      return arm.forces.empty() || !arm.present ? math::Vec3(math::Vec3::Zero())
                                                : ours(arm.forces.back().newton.data());
    });
  }
  double largest() override {
    return with([](FakeArm& arm) { return arm.largest_force; });
  }
  std::vector<Felt> felt() override {
    std::vector<Felt> all;
    for (const Answer& one : with([](FakeArm& arm) { return arm.answers.look(); }))
      all.push_back({ours(one.told.data()), ours(one.force.data())});
    return all;
  }
  [[nodiscard]] double limit() const override { return 12; }
  std::string misuse() override {
    const std::lock_guard lock(dhd_.lock);
    return dhd_.misuse > 0 ? dhd_.misused : dhd_.arm[0].open ? "left open" : "";
  }

 private:
  inline static const std::string kLibrary = test::build_dir() + "/fakes/libdrd.so";
  static FakeDhd& false_library() {
    void* loaded = dlopen(kLibrary.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (loaded == nullptr) std::abort();
    return *reinterpret_cast<FakeDhdState>(dlsym(loaded, "fake_dhd"))();
  }
  static math::Vec3 ours(const double* v) { return {v[1], v[2], v[0]}; }
  bool press(unsigned button, bool down) {
    with([&](FakeArm& arm) { arm.buttons = down ? arm.buttons | button : arm.buttons & ~button; });
    return true;
  }

  FakeDhd& dhd_;
};

}  // namespace burr::test
