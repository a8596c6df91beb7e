// volume/tissue.h - what a voxel is made of: a small id that is an index into a table of materials.
//
// Units: SI. Source of the default cutting energies: Carter & Hayes 1977 for the density law, and
// the ranges of James et al. 2013. They are defaults to be calibrated, see
// docs/understand/validation.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace burr::volume {

using TissueId = std::uint8_t;  // index into TissueTable; 0 is air

enum class TissueKind : std::uint8_t {
  air,    // nothing: not shown, felt or cut
  soft,   // shown as a label; neither felt nor cut by a burr
  solid,  // bone, tooth, cement: shown, felt, cut
};

// Force on a cutting edge, per length of edge: K_c t + K_e (1 - exp(-t / onset)), t: chip
// thickness; tangential (along the cut) and radial (away from the bone). Altintas 2012, ch. 2. The
// edge term grows with t until the chip is as thick as the edge is blunt. Cortical bone: together
// with 8 N/mm these give the specific energies of James et al. 2013, 0.9 J/mm^3 at 10 um and 3 at
// 2.5.
struct CuttingForce {
  double chip_tangential = 120e6;  // K_tc                               [N/m^2]
  double chip_radial = 80e6;       // K_rc                               [N/m^2]
  double edge_tangential = 8e3;    // K_te                               [N/m]
  double edge_radial = 6e3;        // K_re                               [N/m]
  double edge_onset = 1e-6;        //                                    [m]
};

struct Tissue {
  std::string name = "bone";
  TissueKind kind = TissueKind::solid;
  std::array<float, 3> colour = {0.89F, 0.85F, 0.76F};  // sRGB 0..1
  double cutting_energy = 1.0e9;  // specific cutting energy            [J/m^3]
  double friction = 0.25;         // coefficient of steel on it, wet, spindle off  [-]
  double cutting_friction = 0.4;  // mu_c: tangential over normal force of a cut  [-]
  CuttingForce force = {};        // for the removal law "chips"
  bool spare = false;             // must not be cut
  double bleeds = 0;              // where it is cut open: 0 none .. 1 as a vessel; display only
  int label = 0;                  // its value in the file it came from
};

// tissues[id]; [0] is always air. At most 256.
struct TissueTable {
  std::vector<Tissue> tissues = {Tissue{.name = "air", .kind = TissueKind::air}, Tissue{}};
  [[nodiscard]] const Tissue& operator[](TissueId id) const {
    return tissues[id < tissues.size() ? id : 0];
  }
};

}  // namespace burr::volume
