#include "burr/render/handpiece.h"

#include <algorithm>

namespace burr::render {

Profile shaft_profile(double radius, double shaft_radius) {
  const double neck = std::min(shaft_radius, 0.55 * radius);
  const double z0 = 0.8 * radius, z1 = z0 + 3 * radius;
  const double z2 = z1 + 4 * (shaft_radius - neck) + 1e-6;
  const double end = std::max(kShaftOut, z2 + radius);
  return {{z0, neck}, {z1, neck}, {z2, shaft_radius}, {end, shaft_radius}, {end, 0}};
}

Profile collet_profile() {
  return {{-1.5e-3, 0}, {-1.5e-3, 1.9e-3}, {0, 2.4e-3}, {4e-3, 2.8e-3}, {5e-3, 2.8e-3}};
}

Profile nose_profile() {
  return {{5e-3, 2.8e-3},  {5e-3, 3.3e-3}, {16e-3, 4e-3}, {28e-3, 5.6e-3},
          {38e-3, 7.3e-3}, {43e-3, 8e-3},  {46e-3, 8e-3}};
}

Profile grip_profile() {
  constexpr double kGroove = 5e-3;
  Profile z_r = {{46e-3, 8e-3}};
  for (int n = 0; n < 9; ++n) {
    const double z = 48e-3 + n * kGroove;
    z_r.insert(z_r.end(),
               {{z, 7.8e-3}, {z + 0.4e-3, 7.3e-3}, {z + 1.2e-3, 7.3e-3}, {z + 1.6e-3, 7.8e-3}});
  }
  z_r.insert(z_r.end(), {{93e-3, 7.8e-3}, {95e-3, 8.2e-3}});
  return z_r;
}

Profile tail_profile() {
  return {{95e-3, 8.2e-3},  {112e-3, 8.4e-3}, {118e-3, 7e-3},   {119e-3, 4.5e-3},
          {135e-3, 4.5e-3}, {136e-3, 3.2e-3}, {150e-3, 3.2e-3}, {150e-3, 0}};
}

}  // namespace burr::render
