// python/src/python_law.h - a function of Python as a custom law, in sessions that are not in real time.
//
// It is called on the thread that steps the session, with that thread's own state of Python. Its answers are recorded, so a replay
// does not call it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "burr/tick/own_law.h"
#include "common.h"

namespace burr::python {

class PythonLaw final : public tick::OwnLaw {
 public:
  explicit PythonLaw(py::function law);
  ~PythonLaw() override;

  [[nodiscard]] int answer(const burr_law_in_v1& in, burr_law_out_v1& out) BURR_RT override;
  [[nodiscard]] Status begin() override { return fine(); }
  [[nodiscard]] Status fit_for_real_time() const override;
  [[nodiscard]] tick::LawAbout about() const override { return about_; }

  // A step that this work belongs to stops when the function raises; nullptr: no step is under way.
  void set_work(Work* work) { work_ = work; }
  // Raises what the function raised, once.
  void raise_again();

 private:
  py::object law_;
  tick::LawAbout about_;
  Work* work_ = nullptr;
  std::optional<py::error_already_set> raised_;
};

// What the user gave as a law: None, the name of a compiled one, or a function.
[[nodiscard]] std::shared_ptr<tick::OwnLaw> own_law(const py::object& law,
                                                    const std::string& settings);
void add_law(py::module_& module);

}  // namespace burr::python
