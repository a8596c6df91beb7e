// apps/burr/window/mill/step_light.h - shows what a step of the case is about: the target, the planes of a cut, what is
// to be spared, places for orientation. Each has a shape, a colour and a word of its own.
//
//     light.on(marks, scene);
//     light.draw(ui, camera);                          // the marks, in each picture
//     light.off(scene);
//
// Thread: main. Units: SI. Frame: world.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "burr/guidance/step_marks.h"
#include "burr/render/scene.h"
#include "shared/word_names.h"
#include "window/ui/ui.h"

namespace burr::app {

class StepLight {
 public:
  [[nodiscard]] bool is_on() const { return on_; }
  [[nodiscard]] const guidance::StepMarks& marks() const { return marks_; }
  void on(guidance::StepMarks marks, render::Scene& scene);
  void off(render::Scene& scene);
  // covered: width at the right that slices cover [pixel]
  void draw(const Ui& ui, const render::Camera& camera, float covered) const;

 private:
  bool on_ = false;
  guidance::StepMarks marks_;
  std::vector<std::pair<std::size_t, render::Colour>> colours_;  // of tissues, before
};

[[nodiscard]] ImU32 ink_of(guidance::MarkKind kind);
// The sign of a kind, for the picture and for the legend. r: its radius [pixel].
void draw_sign(ImDrawList& draw, ImVec2 at, float r, float u, guidance::MarkKind kind, ImU32 shade);
[[nodiscard]] Word legend_of(guidance::MarkKind kind);  // "to be spared"
// "spare: facial nerve"
[[nodiscard]] std::string mark_text(const guidance::StepMark& mark);

}  // namespace burr::app
