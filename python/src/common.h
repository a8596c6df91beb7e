// python/src/common.h - what all parts of the module share: errors, work without the GIL, arrays.
//
// Long work runs without the GIL and reports to a Work: it looks for Ctrl-C every 50 ms, and calls
// the user's function `progress`. Nothing here is global: exceptions are found in the module.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"
#include "burr/scenario/recipe.h"
#include "burr/surface/patch.h"
#include "burr/volume/bone.h"

namespace burr::python {

namespace py = pybind11;

// An Error of the library on its way to Python: burr.Error, or burr.Cancelled.
struct Raised : std::exception {
  explicit Raised(Error why) : error(std::move(why)) {}
  [[nodiscard]] const char* what() const noexcept override { return error.text.c_str(); }
  Error error;
};
[[noreturn]] inline void raise(std::string sentence) {
  throw Raised({Trouble::usage, std::move(sentence)});
}

template <class T>
T take(Result<T> result) {
  if (!result) throw Raised(result.error());
  return std::move(*result);
}
inline void check(const Status& status) {
  if (!status) throw Raised(status.error());
}

class Work final : public Progress {
 public:
  // call: None, or f(fraction, stage); it cancels by returning False.
  explicit Work(py::object call = py::none()) : call_(std::move(call)) {}

  void report(double fraction, std::string_view stage) override;
  [[nodiscard]] bool cancelled() const override;
  // As if it had been cancelled, by nobody; any thread.
  void stop() noexcept { stop_ = true; }

  // Does the work without the GIL; then raises what the user's function raised, or KeyboardInterrupt.
  template <class Do>
  auto run(Do&& what) {
    auto done = [&] {
      const py::gil_scoped_release others_may;
      return what();
    }();
    if (raised_) throw py::error_already_set(*raised_);
    return done;
  }

 private:
  using Clock = std::chrono::steady_clock;
  py::object call_;
  std::thread::id mine_ = std::this_thread::get_id();
  mutable std::atomic<bool> stop_ = false;
  mutable Clock::time_point looked_ = Clock::now(), reported_ = looked_;
  mutable std::optional<py::error_already_set> raised_;
};

// A vector becomes an array without a copy.
template <class T>
py::array as_array(std::vector<T>&& values, std::vector<py::ssize_t> shape,
                   const py::dtype& type = py::dtype::of<T>()) {
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  const T* data = owned->data();
  const py::capsule owner(owned.get(), [](void* at) { delete static_cast<std::vector<T>*>(at); });
  static_cast<void>(owned.release());
  return py::array(type, std::move(shape), {}, data, owner);
}

// Nobody can write through it; base keeps the data alive.
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const py::object& base) {
  py::array made(py::dtype::of<T>(), std::move(shape), std::move(strides), data, base);
  py::detail::array_proxy(made.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return made;
}

// Three numbers; what: for the sentence.
[[nodiscard]] math::Vec3 vec3_of(const py::object& given, const char* what);
[[nodiscard]] py::array array_of(const math::Vec3& v);
// "0x0123456789abcdef"
[[nodiscard]] std::string hash_of(const volume::Bone& bone);

// A bone that nobody changes any more: a session works on a copy.
struct BoneBox {
  std::shared_ptr<const volume::Bone> bone;
  scenario::BoneRecipe recipe;  // how it was made; no source: from arrays, or of a session
  std::string format;
  std::vector<std::string> notices;
};
using BonePtr = std::shared_ptr<BoneBox>;
[[nodiscard]] BonePtr box(std::unique_ptr<volume::Bone> bone);

struct MeshBox {
  surface::Mesh mesh;
  volume::TissueTable tissues;
};

void add_bone(py::module_& module);
void add_scene(py::module_& module);
void add_recording(py::module_& module);
void add_people(py::module_& module);

}  // namespace burr::python
