// render/microscope.h - the operating microscope: its steps of magnification, its place, its light.
//
// The eye stands 250 mm away and sees a narrow field, so that everything in it is seen from nearly the
// same direction. Units: m. Thread: any.
#pragma once

#include <array>
#include <cstddef>

#include "burr/render/scene.h"

namespace burr::render {

// Height of the picture at each step [m]. A step of x1 shows 25 mm; the factors are those of a
// five-step changer (x0.4 x0.6 x1 x1.6 x2.5) with a step between each two.
inline constexpr std::array<double, 9> kFields = {62.5e-3, 50e-3, 42e-3,   31e-3, 25e-3,
                                                  20e-3,   16e-3, 12.5e-3, 10e-3};
inline constexpr std::size_t kFirstField = 4;
[[nodiscard]] inline double magnification_at(std::size_t step) {
  return kFields[kFirstField] / kFields[step];
}

// Looks at the target from that direction, with the patient's head up; `outward`: towards the eye,
// any length. A direction straight up or down is changed by one degree.
[[nodiscard]] Camera microscope_view(const math::Vec3& target, const math::Vec3& outward,
                                     double field);
// The step whose field is nearest to what the camera shows.
[[nodiscard]] std::size_t field_step(const Camera& camera);
// Another field around the same target.
void set_field(Camera& camera, double field);
// True: the camera sees as narrow a field from as far away as a microscope.
[[nodiscard]] bool is_microscope(const Camera& camera);

// Depth of field of a microscope that is sharp that much beyond (above 0) or before its target [m].
// One eye's light enters through 5 mm (an assumption: the pupils of stereo microscopes are a few
// millimetres wide). Something 5 mm off is then unsharp by 0.1 mm: one pixel of a picture 25 mm high
// in 250 rows, three in 720.
[[nodiscard]] Focus microscope_focus(const Camera& camera, double beyond);

// Coaxial light: the lamp stands beside the eye, a weak one on the other side, little light comes
// from elsewhere, and the room behind is dark. Everything else stays.
void light_coaxially(Look& look);

// The drape around an opening of this scene's bone; the bone's surface must be in it. Cost: a few
// hundred picks.
[[nodiscard]] std::shared_ptr<const Drape> drape_over(const Scene& scene, const Opening& opening);

}  // namespace burr::render
