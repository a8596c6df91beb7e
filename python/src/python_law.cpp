#include "python_law.h"

#include <fmt/format.h>

#include <utility>

#include "burr/base/printable.h"
#include "burr/workshop/law_file.h"

namespace burr::python {
namespace {

// An input as Python sees it. It holds a copy, so a function may keep it.
struct LawInput {
  burr_law_in_v1 in;
  double force[3];  // of burr's own law
};

py::array three(const double* from) { return array_of({from[0], from[1], from[2]}); }

void put_force(const py::handle& given, burr_law_out_v1& out) {
  if (given.is_none()) return;
  const auto force = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!force || force.size() != 3) {
    PyErr_Clear();
    raise("a law returns None, a force of three numbers, or a tuple: force, energy_j[, torque_nm]");
  }
  for (int axis = 0; axis < 3; ++axis) out.force[axis] = force.data()[axis];
}

// None; a force; or (force, energy_j) or (force, energy_j, torque_nm), where the force may be None.
void put(const py::object& said, burr_law_out_v1& out) {
  const bool parts = py::isinstance<py::tuple>(said) && py::len(said) >= 2 &&
                     PyNumber_Check(said[py::int_(0)].ptr()) == 0;
  const bool first_is_array = py::isinstance<py::tuple>(said) && py::len(said) >= 2 &&
                              py::isinstance<py::array>(said[py::int_(0)]);
  if (!parts && !first_is_array) return put_force(said, out);
  put_force(said[py::int_(0)], out);
  out.energy_j = said[py::int_(1)].cast<double>();
  if (py::len(said) > 2) out.torque_nm = said[py::int_(2)].cast<double>();
}

}  // namespace

PythonLaw::PythonLaw(py::function law) : law_(std::move(law)) {
  about_.kind = "python";
  about_.name = base::printable(
      py::str(py::getattr(law_, "__qualname__", py::str("law"))).cast<std::string>());
}

PythonLaw::~PythonLaw() {
  const py::gil_scoped_acquire mine;
  raised_.reset();
  law_ = py::object();
}

int PythonLaw::answer(const burr_law_in_v1& in, burr_law_out_v1& out) BURR_RT {
  const py::gil_scoped_acquire mine;  // of the thread that steps: its state is there already
  const auto failed = [this](const py::error_already_set& why) {
    raised_.emplace(why);
    if (work_ != nullptr) work_->stop();
    return 1;
  };
  try {
    put(law_(LawInput{in, {out.force[0], out.force[1], out.force[2]}}), out);
    return 0;
  } catch (py::error_already_set& why) {
    return failed(why);
  } catch (const std::exception& why) {
    PyErr_SetString(PyExc_TypeError, why.what());
    return failed(py::error_already_set());
  }
}

void PythonLaw::raise_again() {
  if (!raised_) return;
  const py::error_already_set why = *std::exchange(raised_, std::nullopt);
  throw py::error_already_set(why);
}

Status PythonLaw::fit_for_real_time() const {
  return error(
      Trouble::usage,
      fmt::format(
          "the law {}: a function of Python takes too long for a session in real time; "
          "write it in C (docs/develop/how_to_add_a_force_law.md), or run the session as fast as "
          "possible",
          about_.name));
}

std::shared_ptr<tick::OwnLaw> own_law(const py::object& law, const std::string& settings) {
  if (law.is_none()) {
    if (!settings.empty()) raise("law_settings is for a compiled law; name its file as law");
    return nullptr;
  }
  if (py::isinstance<py::function>(law) || PyCallable_Check(law.ptr()) != 0) {
    if (!settings.empty()) raise("law_settings is for a compiled law; a function needs none");
    return std::make_shared<PythonLaw>(py::reinterpret_borrow<py::function>(law));
  }
  // also a pathlib.Path
  const auto path = py::module_::import("os").attr("fspath")(law).cast<std::string>();
  return take(workshop::LawFile::open(path, settings, workshop::law_passes()));
}

void add_law(py::module_& module) {
  py::class_<LawInput> input(module, "LawInput", "What a custom law knows in a tick.");
  const auto number = [&input](const char* name, double burr_law_in_v1::*member) {
    input.def_property_readonly(name, [member](const LawInput& self) { return self.in.*member; });
  };
  const auto vector = [&input](const char* name, double(burr_law_in_v1::*member)[3]) {
    input.def_property_readonly(name,
                                [member](const LawInput& self) { return three(self.in.*member); });
  };
  number("dt_s", &burr_law_in_v1::dt);
  vector("hand_m", &burr_law_in_v1::hand);
  vector("proxy_m", &burr_law_in_v1::proxy);
  vector("normal", &burr_law_in_v1::normal);
  vector("velocity_m_per_s", &burr_law_in_v1::velocity);
  vector("axis", &burr_law_in_v1::axis);
  number("depth_m", &burr_law_in_v1::depth);
  number("radius_m", &burr_law_in_v1::radius);
  number("spin_rad_per_s", &burr_law_in_v1::spin_rad_s);
  number("stiffness_n_per_m", &burr_law_in_v1::stiffness);
  number("damping_n_s_per_m", &burr_law_in_v1::damping);
  number("hu", &burr_law_in_v1::hu);
  number("price_j_per_m3", &burr_law_in_v1::price_j_m3);
  input.def_property_readonly("tissue", [](const LawInput& self) { return self.in.tissue; });
  input.def_property_readonly("touching",
                              [](const LawInput& self) { return self.in.touching != 0; });
  input.def_property_readonly("force_n", [](const LawInput& self) { return three(self.force); });
}

}  // namespace burr::python
