// phantom/tooth_model.h - one tooth by formula, alone (tooth.cpp) or in a jaw (jaw.cpp).
//
// Frame: the tooth's own; z towards the chewing surface, neck at z = 0, y along the row of teeth.
// [m]
#pragma once

#include "burr/phantom/sculpt.h"

namespace burr::phantom {

struct ToothModel {
  bool molar = true;  // two roots and five cusps; otherwise a premolar: one root, two cusps

  // Depth in the whole tooth, with its pulp filled.
  [[nodiscard]] double depth(const Vec3& p) const;
  // Depth in the pulp: chamber and root canals.
  [[nodiscard]] double pulp(const Vec3& p) const;
  // Thickness of the enamel here: none below the neck.
  [[nodiscard]] double enamel(const Vec3& p) const;
};

}  // namespace burr::phantom
