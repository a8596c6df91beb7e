// The module burr._burr: errors, lists of names, and the parts.
#include <fmt/format.h>

#include <cmath>

#include "burr/base/table_cell.h"
#include "burr/base/version.h"
#include "burr/phantom/phantoms.h"
#include "burr/scenario/case.h"
#include "burr/scenario/rack.h"
#include "burr/scoring/rubric.h"
#include "burr/surgeon/motion.h"
#include "burr/workshop/mesh_shape.h"
#include "common.h"
#include "python_law.h"
#include "python_rows.h"

namespace burr::python {
namespace {

constexpr auto kLook = std::chrono::milliseconds(50);   // for Ctrl-C
constexpr auto kTell = std::chrono::milliseconds(100);  // the user's function

std::vector<std::string> tool_names(const std::string& file) {
  const scenario::Rack rack = file.empty() ? scenario::built_in_rack()
                                           : take(scenario::read_rack(file, workshop::mesh_shape));
  std::vector<std::string> names;
  for (const scenario::RackTool& tool : rack.all) names.push_back(tool.name);
  return names;
}

void add_errors(py::module_& module) {
  // made by type(), so that nothing of them is kept in this library
  const py::object made = py::module_::import("builtins").attr("type");
  const py::object error =
      made("Error", py::make_tuple(py::handle(PyExc_Exception)),
           py::dict(py::arg("__module__") = "burr",
                    py::arg("__doc__") = "One sentence: what went wrong, and what to do."));
  module.attr("Error") = error;
  module.attr("Cancelled") =
      made("Cancelled", py::make_tuple(error),
           py::dict(py::arg("__module__") = "burr",
                    py::arg("__doc__") = "The function `progress` returned False."));
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Raised& raised) {
      const py::module_ here = py::module_::import("burr._burr");
      const bool cancelled = raised.error.trouble == Trouble::interrupted;
      const py::object type = here.attr(cancelled ? "Cancelled" : "Error");
      PyErr_SetString(type.ptr(), raised.error.text.c_str());
    }
  });
}

}  // namespace

void Work::report(double fraction, std::string_view stage) {
  if (call_.is_none() || std::this_thread::get_id() != mine_ || stop_) return;
  const auto now = Clock::now();
  if (now - told_ < kTell) return;
  told_ = now;
  const py::gil_scoped_acquire mine;
  try {
    const py::object said = call_(fraction, py::str(stage.data(), stage.size()));
    if (py::isinstance<py::bool_>(said) && !said.cast<bool>()) stop_ = true;
  } catch (py::error_already_set& raised) {
    raised_.emplace(raised);
    stop_ = true;
  }
}

bool Work::cancelled() const {
  if (stop_ || std::this_thread::get_id() != mine_) return stop_;
  const auto now = Clock::now();
  if (now - looked_ < kLook) return false;
  looked_ = now;
  const py::gil_scoped_acquire mine;
  if (PyErr_CheckSignals() == 0) return false;
  raised_.emplace();  // takes over what is raised
  stop_ = true;
  return true;
}

math::Vec3 vec3_of(const py::object& given, const char* what) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array || array.size() != 3) {
    PyErr_Clear();
    raise(fmt::format("{} must be three numbers", what));
  }
  const math::Vec3 v(array.data()[0], array.data()[1], array.data()[2]);
  if (!v.allFinite()) raise(fmt::format("{} must be three finite numbers", what));
  return v;
}

py::array array_of(const math::Vec3& v) {
  return as_array(std::vector<double>{v.x(), v.y(), v.z()}, {3});
}

}  // namespace burr::python

PYBIND11_MODULE(_burr, module) {
  using namespace burr;
  using namespace burr::python;
  module.doc() = "burr: touching and cutting bone. Import the package `burr`, not this.";
  module.attr("__version__") = base::version();
  module.attr("BUILD") = base::build();
  module.attr("ROWS_VERSION") = kRowsVersion;
  add_errors(module);
  module.def("cases", &scenario::built_in_cases, "The built-in cases.");
  module.def("rubrics", &scoring::built_in_rubrics, "The built-in rubrics.");
  module.def("motions", &surgeon::motion_names, "The motions of a simulated hand.");
  module.def("phantoms", &phantom::phantom_names, "The bones by formula.");
  module.def("table_text", &base::guarded_cell, py::arg("text"),
             "A text as a cell of a table that no spreadsheet runs as a formula; csv.writer puts "
             "the quotes.");
  module.def("tool_names", &tool_names, py::arg("tools") = "",
             "The tools of the rack; tools: a .toml file with more.");
  module.def("row_type", &row_type, "The type of the rows of ticks.");
  add_law(module);
  add_bone(module);
  add_scene(module);
  add_recording(module);
  add_people(module);
}
