// python/src/scene_setup.h - a scene: a bone, a case, a tool and their settings.
//
// Thread: one at a time, with the GIL.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/tick/setting_table.h"
#include "burr/tick/settings.h"
#include "common.h"
#include "python_events.h"

namespace burr::python {

struct SceneSetup {
  BonePtr bone;
  std::optional<scenario::Case> work;
  // As `burr mill` has them, by the same words and in the same units, so that one scene gives one hash.
  tick::TypedValues settings = tick::usual_values();
  int threads = 1;
  std::string tool, tools;
  std::string title, motion = "pocket";  // of the demonstration, as its seconds
  double seconds = 20;
  std::vector<Wanted> wanted;   // by all its sessions
  py::object law = py::none();  // a compiled one's file, or a function
  std::string law_settings;

  // One of a case's file, where 1 and 1.0 are the same number.
  void put(const std::string& word, const base::Given& value);
  [[nodiscard]] double burr_mm() const { return std::get<double>(settings.at("burr_mm")); }
  [[nodiscard]] double rpm() const { return std::get<double>(settings.at("rpm")); }
};

// What a session is made with, of its settings. Throws what is out of range, with the property's name.
[[nodiscard]] tick::ServoSettings servo_of(const SceneSetup& scene);

// Opens the bone of a recipe; call: None, or f(fraction, stage).
void open_bone(SceneSetup& scene, const scenario::BoneRecipe& recipe, const py::object& call);
// What the case says becomes settings. own_burr: also its tool, or its burr as large as the voxels ask.
void take_work(SceneSetup& scene, bool own_burr);

// scene_file.cpp: a scene as the file of a case, and back.
void add_scene_file(py::class_<SceneSetup>& scene);
// scene_settings.cpp: a property for each setting that persons give.
void add_settings(py::class_<SceneSetup>& scene);
// guidance.cpp: what a mode of a session allows.
void add_guidance(py::class_<SceneSetup>& scene);

}  // namespace burr::python
