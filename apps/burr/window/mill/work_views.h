// apps/burr/window/mill/work_views.h - the four ways to look at the work, and their light:
//
//     microscope  narrow field from 250 mm away, light from the eye, soft tissue around the opening
//     whole       all of the bone
//     endoscope   from 10 mm in front of what the burr works on, wide, round
//     free        as it stands now, turned and zoomed at will
//
// A case with an entry begins with the microscope, everything else with the whole bone. Turning and
// shifting work in all of them. Thread: main. Frame: world. Units: m.
#pragma once

#include <memory>
#include <optional>

#include "burr/render/microscope.h"
#include "burr/render/scene.h"
#include "window/mill/window_options.h"

namespace burr::app {

enum class ViewKind { microscope, whole, endoscope, free };

class Views {
 public:
  // first: the scene's camera as the session was made ready; it looks at the place of work.
  Views(const WindowOptions& options, const render::Camera& first);

  // Takes that view. work: what the endoscope looks at; aspect: width / height of the picture.
  void go(ViewKind kind, render::Scene& scene, const math::Vec3& work, double aspect);
  // The microscope over a place, unless it is seen well already: from about that direction, and near the
  // middle. outward: unit, to the eye; radius: of what is to be in the picture.
  void face(render::Scene& scene, const math::Vec3& at, const math::Vec3& outward, double radius);
  // The view that the page began with.
  void first(render::Scene& scene, double aspect);
  // The scene has got a camera from elsewhere.
  void placed(const render::Scene& scene);
  // A step of magnification, nearer with by > 0. False: this is no microscope.
  bool magnify(double by, render::Scene& scene);
  // Depth of field under the microscope, on or off. It needs a graphics card to be fast.
  void deep(bool on) { deep_ = on; }
  [[nodiscard]] bool deep() const { return deep_ && kind_ == ViewKind::microscope; }
  // Moves the plane in focus by steps of kFine, away from the eye with by > 0; switches depth of field
  // on. False: this is no microscope.
  bool refocus(double by);
  // How far beyond the target it is sharp [m].
  [[nodiscard]] double beyond() const { return beyond_; }
  static constexpr double kFine = 0.5e-3, kMostBeyond = 30e-3;  // [m]
  // Call it in each picture: whether the drape stands in the way of this eye, and whether the eye got
  // into bone.
  void look(render::Scene& scene);
  // Takes light and drape off the scene.
  void end(render::Scene& scene) const;

  [[nodiscard]] ViewKind kind() const { return kind_; }

 private:
  void dress(render::Scene& scene);

  ViewKind kind_ = ViewKind::free, first_kind_;
  render::Camera first_;  // microscope, or the direction of the whole view
  math::Vec3 outward_;    // unit, from the bone to the surgeon
  std::optional<render::Opening> opening_;
  std::shared_ptr<const render::Drape> drape_;  // made when it is first needed
  std::optional<render::Camera> microscope_;    // as it was left
  std::optional<render::Look> bare_;            // the light of the other views
  render::Camera seen_;                         // that look() has checked
  bool deep_ = false;
  double beyond_ = 0;
  double wheel_ = 0;  // part of a step
};

}  // namespace burr::app
