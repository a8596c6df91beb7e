// apps/burr/window/mill/step_light.h - lights what a step of the case is about: rings around places
// and regions, and tissues in a bright colour.
//
//     light.on(step, lesson, bone.tissues(), scene);
//     light.draw(ui, camera);                          // the rings, in each picture
//     light.off(scene);
//
// Thread: main. Units: SI. Frame: world.
#pragma once

#include <utility>
#include <vector>

#include "burr/guidance/step_rings.h"
#include "burr/render/scene.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/tissue.h"
#include "window/ui/ui.h"

namespace burr::app {

class StepLight {
 public:
  [[nodiscard]] bool is_on() const { return on_; }
  void on(const scenario::Step& step, const scenario::CaseLesson& lesson,
          const volume::TissueTable& tissues, render::Scene& scene);
  void off(render::Scene& scene);
  void draw(const Ui& ui, const render::Camera& camera) const;

 private:
  bool on_ = false;
  std::vector<guidance::Ring> rings_;
  std::vector<std::pair<std::size_t, render::Colour>> colours_;  // of tissues, before
};

}  // namespace burr::app
