// The settings of a scene: a property for each row of tick/setting_table.h that persons give. They are
// checked where a session or a file is made of them, so that they can be set in any order.
#include <cstdint>
#include <string>
#include <utility>
#include <variant>

#include "burr/tick/setting_table.h"
#include "common.h"
#include "scene_setup.h"

namespace burr::python {
namespace {

using tick::About;

template <class Value>
void add_as(py::class_<SceneSetup>& scene, const About& about) {
  const char* word = about.typed.word;
  scene.def_property(
      tick::property_of(about),
      [word](const SceneSetup& self) { return std::get<Value>(self.settings.at(word)); },
      [word](SceneSetup& self, Value value) { self.settings[word] = std::move(value); });
}

bool of_a_scene(const About& about) {
  return about.typed.word != nullptr && about.typed.place != tick::Typed::Place::neither;
}

}  // namespace

void SceneSetup::put(const std::string& word, const base::Given& value) {
  base::Given& mine = settings.at(word);
  const auto* whole = std::get_if<std::int64_t>(&value);
  const auto* number = std::get_if<double>(&value);
  if (whole != nullptr && std::holds_alternative<double>(mine))
    mine = static_cast<double>(*whole);
  else if (number != nullptr && std::holds_alternative<std::int64_t>(mine))
    mine = static_cast<std::int64_t>(*number);
  else
    mine = value;
}

tick::ServoSettings servo_of(const SceneSetup& scene) {
  tick::ServoSettings servo;
  check(tick::take_typed(
      scene.settings, [](const About& about) { return std::string(tick::property_of(about)); },
      servo));
  return servo;
}

void add_settings(py::class_<SceneSetup>& scene) {
  for (const auto& one : tick::servo_settings()) {
    const About& about = one.about;
    if (!of_a_scene(about)) continue;
    switch (about.kind) {
      case About::Kind::number:
        add_as<double>(scene, about);
        break;
      case About::Kind::whole:
        add_as<std::int64_t>(scene, about);
        break;
      case About::Kind::flag:
        add_as<bool>(scene, about);
        break;
      case About::Kind::choice:
        add_as<std::string>(scene, about);
        break;
    }
  }
}

}  // namespace burr::python
