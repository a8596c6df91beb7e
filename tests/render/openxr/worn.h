// tests/render/openxr/worn.h - puts on the headset of fake_openxr.h: opens the fake runtime, resets
// it, and names it in BURR_OPENXR_LOADER while this object lives.
#pragma once

#include <gtest/gtest.h>

#include <dlfcn.h>

#include <cstdlib>
#include <string>

#include "render/openxr/fake_openxr.h"
#include "support/test_places.h"

namespace burr::test {

class Worn {
 public:
  Worn() {
    const std::string file = test::build_dir() + "/libfake_openxr.so";
    void* const opened = dlopen(file.c_str(), RTLD_NOW | RTLD_NODELETE);
    if (opened == nullptr) {
      ADD_FAILURE() << dlerror();
      std::abort();
    }
    reinterpret_cast<void (*)()>(dlsym(opened, "fake_xr_forget"))();
    fake_ = reinterpret_cast<FakeXr* (*)()>(dlsym(opened, "fake_xr"))();
    ::setenv("BURR_OPENXR_LOADER", file.c_str(), 1);
  }
  ~Worn() {
    ::unsetenv("BURR_OPENXR_LOADER");
    for (const std::string& breach : fake_->breaches) ADD_FAILURE() << "OpenXR: " << breach;
  }
  Worn(const Worn&) = delete;
  Worn& operator=(const Worn&) = delete;

  [[nodiscard]] FakeXr& xr() { return *fake_; }
  template <class Change>
  void change(const Change& how) {
    const std::lock_guard lock(fake_->mutex);
    how(*fake_);
  }

 private:
  FakeXr* fake_ = nullptr;
};

}  // namespace burr::test
