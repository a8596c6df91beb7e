// python/src/python_events.h - what happens in a session, told to functions of Python: touch, leave, removed,
// near, step_reached.
//
//     ticks (no GIL)              helper thread (takes the GIL)         Python
//     note(row, voxels)  ------>  calls the functions, at most 60   ->  f(event)
//     only notes what happened    rounds a second; what happened
//                                 meanwhile is merged into one call
//
// A function never runs on the thread of the ticks. What it raises is raised again at the next step()
// or close(). Thread: as each function says.
#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "burr/sim/row_log.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"
#include "burr/volume/distance_to.h"
#include "common.h"

namespace burr::python {

enum class Happens { touch, leave, removed, near, step_reached };

// What somebody wants to be told.
struct Wanted {
  Happens what = Happens::touch;
  std::string name;  // a tissue (removed, near) or a step; empty: any
  double mm = 0;     // near: of the burr's surface
  py::object call;
};

// What a function is given.
struct Event {
  std::string what;
  std::uint64_t first_tick = 0, tick = 0, count = 0;
  math::Vec3 p = math::Vec3::Zero();  // of the burr, at the newest  [m]
  std::map<std::string, std::uint64_t> voxels;
  std::string structure, step;
  std::optional<double> distance_m;  // the least
};

// GIL. Raises for an unknown event, and for a name that does not belong to it.
[[nodiscard]] Wanted wanted_of(const std::string& event, const py::object& call,
                               const py::object& label, const py::object& structure,
                               const py::object& mm, const py::object& step);

class Events {
 public:
  // bone: before the first cut.
  Events(BonePtr bone, std::optional<scenario::Case> work);
  ~Events();  // GIL; as stop(false)
  Events(const Events&) = delete;
  Events& operator=(const Events&) = delete;

  // GIL, while the session stands. Raises if the bone or the case has no such name. keeps_voxels: of
  // the session.
  void add(Wanted wanted, bool keeps_voxels);
  // Thread of the ticks, after each tick. voxels: those of this tick and later ones.
  void note(const tick::TickRow& row);
  void note(const sim::CrossedVoxel& voxel);
  // While the session stands: whether steps should be looked at, and with which bone.
  [[nodiscard]] bool wants_bone(std::uint64_t ticks) const;
  void look(std::unique_ptr<volume::Bone> now, std::uint64_t tick);
  [[nodiscard]] bool watches_steps() const { return !steps_.empty(); }
  // The session went back to its beginning.
  void start_over();

  // GIL. Raises what a function raised since the last call.
  void raise_what_failed();
  // GIL. Calls the functions for the events that wait (or drops these), then ends the thread. No function is called afterwards.
  void stop(bool tell);
  // GIL; for Python's collector of garbage.
  int visit(visitproc visitor, void* arg) const;
  void forget();

 private:
  struct Helper;
  void happened(std::size_t which, const std::string& name, const tick::TickRow& row,
                std::optional<double> distance);
  void put(std::size_t which, const std::string& name, const Event& event);

  struct Near {
    std::size_t which = 0;
    double distance = 0;
    volume::DistanceTo to;
    bool inside = false;
  };
  BonePtr bone_;
  std::optional<scenario::Case> work_;
  std::optional<scenario::CaseLesson> lesson_;
  std::vector<Wanted> wanted_;                       // without the functions, which the helper has
  std::vector<std::size_t> touch_, leave_, steps_;   // numbers of wishes
  std::map<int, std::vector<std::size_t>> removed_;  // by tissue; -1: any
  std::vector<Near> near_;
  bool touching_ = false;
  tick::TickRow newest_;
  std::uint64_t looked_ = 0;  // tick
  std::shared_ptr<Helper> helper_;
  py::object at_exit_;
};

void add_events(py::module_& module);

}  // namespace burr::python
