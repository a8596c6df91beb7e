// edit/carve_settings.h - how far and how fast the carver cuts (carve.h).
//
// A plain struct. Units: in each line.
#pragma once

namespace burr::edit {

struct CarveSettings {
  // How far the cutting ball reaches ahead along the push, and by how much it is larger than the
  // burr: the effect of its teeth. Lengths of the tool, so that a hole does not depend on the
  // voxel; but never less than a share of a voxel, or the burr gets stuck.
  double advance_m = 50e-6;     // [m]
  double advance_least = 0.25;  // [voxel]
  double margin_m = 10e-6;      // [m]
  double margin_least = 0.1;    // less, and a stopped burr wedges in its own slot [voxel]
  double margin_most = 0.5;     // while the burr is blocked [voxel]
  double margin_rise = 20;      // while blocked [voxel/s]
  double margin_fall = 2;       // while cutting freely [voxel/s]
  double debt_timeout = 5e-3;   // how long a debt may wait, at the present rate of asking [s]
  double deposit_share = 0.8;   // radius of the deposited ball over the burr's [-]
  double deposit_gap = 0.5;     // kept between burr and deposited material [voxel]
};

}  // namespace burr::edit
