// python/src/scene.h - a scene: a bone, a case, a tool and their settings.
//
// Thread: one at a time, with the GIL.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/tick/settings.h"
#include "common.h"
#include "events.h"

namespace burr::python {

struct Scene {
  BonePtr bone;
  std::optional<scenario::Case> work;
  // as `burr mill` has them, in its units, so that one scene gives one hash
  double burr_mm = 5, rpm = 40000, rate_hz = 1000, stiffness_n_per_m = 1000, drag = 1,
         vibration = 0, torque_mnm = 1e3 * tool::Motor{}.torque;
  bool diamond = false, guarded = false, irrigated = false;
  int teeth = tool::Burr{}.teeth, threads = 1;
  std::string tool, tools, touch = "constraint", removal = "energy";
  std::size_t undo_bricks = tick::ServoSettings{}.undo_bricks;
  std::string title, motion = "pocket";  // of the demonstration, as its seconds
  double seconds = 20;
  std::vector<Wanted> wanted;   // by all its sessions
  py::object law = py::none();  // a compiled one's file, or a function
  std::string law_settings;
};

// Opens the bone of a recipe; call: None, or f(fraction, stage).
void open_bone(Scene& scene, const scenario::Recipe& recipe, const py::object& call);
// What the case says becomes settings. own_burr: also its tool, or its burr as large as the voxels ask.
void take_work(Scene& scene, bool own_burr);

// scene_file.cpp: a scene as the file of a case, and back.
void add_scene_file(py::class_<Scene>& scene);
// guidance.cpp: what a mode of a session allows.
void add_guidance(py::class_<Scene>& scene);

}  // namespace burr::python
