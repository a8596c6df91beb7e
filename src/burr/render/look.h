// render/look.h - the look of a picture: lights, ambient occlusion, background. Plain data.
//
// Colours are sRGB 0..1. Directions are in the eye's frame (x right, y up, z towards the eye): the
// lights move with the viewer's head, like a surgeon's lamp.
#pragma once

#include <array>

#include "burr/math/vec3.h"

namespace burr::render {

using Colour = std::array<float, 3>;  // sRGB 0..1

struct Light {
  math::Vec3 towards = math::Vec3::UnitZ();  // from the surface to the light; any length
  Colour colour = {1, 1, 1};
  double strength = 1;  // of linear light
};

struct Look {
  Light key = {{-0.55, 0.55, 0.62}, {1.0F, 0.97F, 0.92F}, 1.15};   // main light; shows the relief
  Light fill = {{0.85, -0.25, 0.45}, {0.80F, 0.88F, 1.0F}, 0.20};  // brightens the other side
  double ambient = 0.22;                                           // light from all directions
  double gloss = 0.10;            // bone is a little wet; 0 is like chalk
  double occlusion = 1.0;         // ambient occlusion, 0 none .. 1 full
  double occlusion_reach = 0.08;  // its radius, in heights of the picture at the target
  int occlusion_samples = 10;  // per pixel; 10 for a window without a GPU, 32 for a still picture
  bool occlusion_half = true;  // at half resolution: four times cheaper, a little softer
  int supersample = 1;         // n x n samples per pixel; 1 for a window without a GPU, 2 or 3 for
                               // a still picture
  double opacity = 1;          // of bone; below 1 shows what lies in it or behind it
  bool plain = false;          // only Lambert with a light at the eye: for measurements in the
                               // picture
  Colour background_top = {0.20F, 0.23F, 0.27F};
  Colour background_bottom = {0.09F, 0.10F, 0.12F};
};

// For still pictures: everything at full resolution.
[[nodiscard]] inline Look still_look() {
  Look look;
  look.occlusion_samples = 24;
  look.occlusion_half = false;
  look.supersample = 2;
  return look;
}

}  // namespace burr::render
