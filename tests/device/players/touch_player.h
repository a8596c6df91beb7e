// A fake Touch (fake/fake_hd.h), loaded like the maker's library.
#pragma once

#include <dlfcn.h>

#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "burr/device/openhaptics/touch.h"
#include "burr/haptics/touch_method.h"
#include "device/fake/fake_hd.h"
#include "device/players/device_player.h"
#include "support/test_places.h"

namespace burr::test {

class TouchPlayer final : public Player {
  inline static const std::string kLibrary = test::build_dir() + "/fakes/libHD.so";

  template <class F>
  auto with(F look) {
    const std::lock_guard lock(hd_.mutex);
    return look(hd_.touch[0]);
  }

 public:
  static FakeHd& false_library() {
    void* loaded = dlopen(kLibrary.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (loaded == nullptr) std::abort();
    return *reinterpret_cast<FakeHdState>(dlsym(loaded, "fake_hd"))();
  }
  TouchPlayer() : hd_(false_library()) {
    const std::lock_guard lock(hd_.mutex);
    hd_.touch = {};
    hd_.rate = 1000;
    hd_.misuse = 0;
  }
  std::unique_ptr<device::Device> device(const device::LinkSettings& link) override {
    device::openhaptics::TouchSettings settings;
    settings.hd_file = kLibrary;
    settings.link = link;
    return std::make_unique<device::openhaptics::Touch>(settings);
  }

  void hold(const math::Vec3& place, const math::Vec3& velocity) override {
    with([&](FakeTouch& touch) {
      for (int axis = 0; axis < 3; ++axis) {
        touch.transform[12 + static_cast<std::size_t>(axis)] = 1e3 * place[axis];
        touch.velocity[static_cast<std::size_t>(axis)] = 1e3 * velocity[axis];
      }
    });
  }
  bool press(int button, bool down) {
    with([&](FakeTouch& touch) {
      touch.buttons = down ? touch.buttons | button : touch.buttons & ~button;
    });
    return true;
  }
  bool mill(bool down) override { return press(1, down); }
  bool clutch(bool down) override { return press(2, down); }
  void unplug() override {
    with([](FakeTouch& touch) { touch.present = false; });
  }
  void plug_in() override {
    with([](FakeTouch& touch) { touch.present = true; });
  }

  math::Vec3 force() override {
    return with([](FakeTouch& touch) {
      return touch.forces.empty() || !touch.force_on ? math::Vec3(math::Vec3::Zero())
                                                     : math::Vec3(touch.forces.back().data());
    });
  }
  double largest() override {
    return with([](FakeTouch& touch) { return touch.largest_force; });
  }
  std::vector<Felt> felt() override {
    std::vector<Felt> all;
    for (const Answer& one : with([](FakeTouch& touch) { return touch.answers.look(); }))
      all.push_back({1e-3 * math::Vec3(one.told.data()), math::Vec3(one.force.data())});
    return all;
  }
  [[nodiscard]] double limit() const override { return 3.3; }
  std::string misuse() override {
    const std::lock_guard lock(hd_.mutex);
    if (hd_.misuse > 0) return hd_.misused;
    if (hd_.touch[0].open) return "left open";
    return hd_.touch[0].left_on ? "forces left on" : "";
  }

 private:
  FakeHd& hd_;
};

}  // namespace burr::test
