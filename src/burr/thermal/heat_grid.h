// thermal/heat_grid.h - the temperature of the bone around the work, and the dose it has had.
//
//     rho c dT/dt = div(k grad T) + Q
//
// Finite volumes on the cells of matter.h, explicit in time. Between two cells
//
//     heat = G (T_b - T_a) dt,   G = edge * 2 K_a K_b / (K_a + K_b),   K = share * k
//
// so nothing crosses air. Where bone lies open to the air it keeps its heat when dry, and when wet
// gives some to the coolant, through half a cell and the film:
//
//     G = A / (1 / h_c + edge / (2 K)),   A = edge^2 |one-sided differences of the share|
//
// A by the norm, not by counting open faces: a slanted plane has its own area, not that of its
// stairs (up to 1.7 times as much). A step takes a cell no further than the mean of its neighbours,
// dt sum G / C < 1, so it makes neither heat nor cold out of rounding: no new highest, no new
// lowest. For equal materials sum G / C <= 12 alpha / edge^2, twice what whole cells have.
//
// The box is fixed. Heat goes only a few cm in minutes, and a map of doses that moved with the burr
// would forget what lies behind; bone around the box stays at the starting temperature, so let it
// reach 10 mm further than the burr will.
//
// Same bone, same calls: same bits. Thread: any one at a time, never the servo's; the bone may be
// cut meanwhile. Frames: world. Memory: about 90 B a cell: 6 MB for 40 mm of 1 mm cells, 50 MB of
// 0.5 mm. Cost: bench/thermal/heat_bench.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/rt/changed_bits.h"
#include "burr/thermal/matter.h"
#include "burr/thermal/settings.h"
#include "burr/thermal/summary.h"
#include "burr/volume/bone.h"

namespace burr::thermal {

class HeatGrid {
 public:
  // Before the session: adds a watcher to the bone. work: world  [m]
  HeatGrid(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings);

  // Sees what was cut or put on since the last look. Bone that went takes its heat along; what came
  // is as warm as everything was at the start. False: the servo was writing; look again.
  bool look();

  // Heats what matter there is within `radius` (at least one cell) of p, by its capacity and less
  // towards the edge. Returns what stayed: all of it, or nothing where there is no matter.  [J]
  double deposit(const math::Vec3& p, double radius, double energy);

  // From now on the coolant runs over what is open within wet_radius of p; dry() ends it.
  void irrigate(const math::Vec3& p);
  void dry() { wet_ = false; }

  // In as many steps as it takes.  [s]
  void advance(double seconds);

  // All as at the start, the bone as it is.
  void start_over();

  // ---- reading
  [[nodiscard]] const CellBox& box() const { return box_; }
  [[nodiscard]] math::Vec3 centre(const math::Ijk& cell) const;  // world  [m]
  [[nodiscard]] math::Ijk cell_at(const math::Vec3& p) const;    // may lie outside the box
  [[nodiscard]] bool has_matter(const math::Ijk& cell) const;
  // Of the cell; the starting temperature where there is no matter, or outside.  [deg C]
  [[nodiscard]] double temperature_c(const math::Ijk& cell) const;
  [[nodiscard]] double cem43_min(const math::Ijk& cell) const;
  [[nodiscard]] double longest_stable_step() const;  // [s]
  [[nodiscard]] HeatLedger ledger() const;           // all but what was spent
  [[nodiscard]] double wet_area() const;             // of everything open to the air  [m^2]
  // All but time, rows and what was spent.
  void summarise(HeatSummary& out) const;

 private:
  struct Parts {
    std::array<volume::TissueId, kMostParts> tissue = {};
    std::array<float, kMostParts> part = {};
  };
  [[nodiscard]] bool read(volume::BrickIndex brick);
  void set(const math::Ijk& cell, const Matter& matter);
  void remember(std::size_t cell);
  void link(const math::Ijk& lo, const math::Ijk& end);
  void open_to_air(std::size_t cell);
  void step(double dt);
  void conduct(double dt);
  void cool(double dt);
  void leave_box(double dt);
  void add_dose(double dt);

  HeatSettings settings_;
  volume::Bone& bone_;
  rt::ChangedBits& changed_;
  CellBox box_;
  MatterReader reader_;
  std::vector<MatterReader::Found> found_;
  std::vector<volume::BrickIndex> due_;  // changed and not read yet

  // one for each cell of the box and the layer around it, which stays at the start
  std::vector<double> rise_, next_;        // above start_c  [K]
  std::vector<double> capacity_, warmth_;  // [J/K]; its inverse, or 0  [K/J]
  std::vector<double> dose_;               // [min]
  std::vector<float> peak_;                // highest rise  [K]
  std::vector<float> k_, share_;           // share * k  [W/(m K)]; share  [-]
  std::array<std::vector<float>, 3> g_;    // to the next along x, y, z  [W/K]
  std::vector<float> area_, film_;         // open to the air  [m^2]; to the coolant, if wet  [W/K]
  std::vector<Parts> parts_;
  std::vector<int> in_row_;  // (count.y x count.z) cells with matter

  double fastest_ = 0;  // largest sum G / C there ever was  [1/s]
  bool wet_ = false;
  math::Vec3 nozzle_ = math::Vec3::Zero();  // p_cell
  HeatLedger ledger_;
  std::array<TissueHeat, 256> gone_;  // highest of what was cut; only ever_c, cem43_min, there
};

}  // namespace burr::thermal
