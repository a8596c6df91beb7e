// volume/tissue.h - what a voxel is made of: a small id into a table of materials.
//
// Units: SI. Source of the default cutting energies: Carter & Hayes 1977 for the density law, and
// the ranges of James et al. 2013; they are defaults to calibrate, see docs/validation.md.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace burr::volume {

using TissueId = std::uint8_t;  // index into TissueTable; 0 is air

enum class TissueKind : std::uint8_t {
  air,    // nothing: neither seen, felt nor cut
  soft,   // seen as a label, neither felt nor cut by a burr
  solid,  // bone, tooth, cement: seen, felt, cut
};

struct Tissue {
  std::string name = "bone";
  TissueKind kind = TissueKind::solid;
  std::array<float, 3> colour = {0.89F, 0.85F, 0.76F};  // sRGB 0..1
  double cutting_energy = 1.0e9;  // specific cutting energy            [J/m^3]
  double friction = 0.25;         // steel on it, wet, spindle off      [-]
  bool spare = false;             // must not be cut
  int label = 0;                  // value in the file it came from
};

// tissues[id]; [0] is always air. At most 256.
struct TissueTable {
  std::vector<Tissue> tissues = {Tissue{.name = "air", .kind = TissueKind::air}, Tissue{}};
  [[nodiscard]] const Tissue& operator[](TissueId id) const {
    return tissues[id < tissues.size() ? id : 0];
  }
};

}  // namespace burr::volume
