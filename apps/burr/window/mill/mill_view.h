// apps/burr/window/mill/mill_view.h - how the user looks at the bone while milling: the four ways to
// look, magnification and focus, saved views, the colours of tissues, see-through bone, slices, and
// the cube that turns the view.
//
// It changes the camera, the look and the insets of the scene, and puts the colours back at the end.
// What the mode of the session refuses is refused here. Thread: main; draw_*() between Ui::begin()
// and Ui::draw(). Frame: world. Units: m; pixels of the mouse for turning.
#pragma once

#include <optional>
#include <vector>

#include "window/mill/mill_case.h"
#include "window/mill/mill_site.h"
#include "window/mill/orientation_cube.h"
#include "window/mill/pointer.h"
#include "window/mill/saved_views.h"
#include "window/mill/structures.h"
#include "window/mill/work_views.h"
#include "window/parts/slices.h"

namespace burr::app {

class MillView {
 public:
  MillView(const MillSite& site, MillCase& work_case, const Pointer& pointer);

  void begin();  // before the session starts
  void end();

  // ---- where it is seen from
  // shift: moves the picture, otherwise turns it; an arrow key counts as some pixels
  void turn(double right, double up, bool shift);
  // at: what the endoscope looks at
  void take(ViewKind kind, const math::Vec3& at);
  void face(const math::Vec3& at, const math::Vec3& outward, double radius);  // as Views::face()
  void first();
  void magnify(double by);  // steps of the wheel: of the microscope, or nearer without steps
  void deep_or_not();       // depth of field under the microscope
  void refocus(double by);
  // Saves the present view, or returns to a saved one.
  void saved(int slot, bool keep);

  // ---- what is seen
  void show_labels(bool shown);  // each tissue in its own colour, or all as bone
  void toggle_labels();
  [[nodiscard]] bool labels() const { return labels_; }
  void step_opacity(bool back);
  void toggle_slices() { slices_shown_ = !slices_shown_; }
  [[nodiscard]] bool slices_shown() const { return slices_shown_; }
  // These two: from begin() on.
  [[nodiscard]] Slices& slices() { return *slices_; }
  [[nodiscard]] Structures& structures() { return *structures_; }

  // ---- in each picture
  void look() { views_.look(scene_); }
  // below: the bone under the hand that hovers; none: there is none, or the hand does not follow it
  void step(const std::optional<math::Vec3>& below);
  void draw_bar(Ui& ui, const math::Vec3& at);  // at: as for take()
  void draw_orientation(Ui& ui);
  // Width at the right that slices cover [pixel].
  [[nodiscard]] float column() const;
  // Top of the cube, below the button at the top right [points].
  [[nodiscard]] float cube_top() const { return options_.done_ends ? 66.0F : 10.0F; }

 private:
  [[nodiscard]] double aspect() const;
  void find_through(const std::optional<math::Vec3>& below);

  Desk& desk_;
  volume::Bone& bone_;
  render::Scene& scene_;
  const WindowOptions& options_;
  MillNotes& notes_;
  MillOver& over_;
  MillCase& case_;
  const Pointer& pointer_;
  Views views_;
  std::optional<SavedViews> saved_views_;
  std::optional<Slices> slices_;
  std::optional<Structures> structures_;
  bool slices_shown_ = true, labels_ = true;
  std::vector<render::Colour> colours_;  // of the tissues, while labels are shown
  ViewTurn view_turn_;
  math::Vec3 through_ = math::Vec3::Zero();  // the slices, where bone was last
};

}  // namespace burr::app
