// thermal/heat_grid.h - the temperature of the bone around the work, and its heat dose.
//
//     rho c dT/dt = div(k grad T) + Q
//
// Finite volumes on the cells of matter.h, explicit in time. The heat between two cells a and b is
//
//     heat = G (T_b - T_a) dt,   G = edge * 2 K_a K_b / (K_a + K_b),   K = share * k
//
// so no heat crosses air. Bone that is open to the air keeps its heat when dry; when wet it gives
// heat to the coolant, through half a cell and the film of coolant:
//
//     G = A / (1 / h_c + edge / (2 K)),   A = edge^2 |one-sided differences of the share|
//
// A is the norm of the differences, not a count of open faces: a slanted plane gets its own area,
// not that of its stairs (up to 1.7 times as much). A step never moves a cell beyond the mean of
// its neighbours, dt sum G / C < 1, so rounding creates neither heat nor cold: no new highest and
// no new lowest temperature. For equal materials sum G / C <= 12 alpha / edge^2, twice the value of
// whole cells.
//
// The box is fixed. Heat moves only a few cm in minutes, and a dose map that moved with the burr
// would lose the dose behind it. Bone around the box stays at the starting temperature, so let the
// box reach 10 mm further than the burr will.
//
// The same bone and the same calls give the same bits. Thread: any one at a time, never the
// servo's; the bone may be cut meanwhile. Frame: world. Memory: about 90 B per cell: 6 MB for 40 mm
// with cells of 1 mm, 50 MB with cells of 0.5 mm. Cost: bench/thermal/heat_bench.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "burr/math/aabb.h"
#include "burr/rt/changed_bits.h"
#include "burr/thermal/heat_settings.h"
#include "burr/thermal/heat_summary.h"
#include "burr/thermal/matter.h"
#include "burr/volume/bone.h"

namespace burr::thermal {

class HeatGrid {
 public:
  // Construct before the session: adds a watcher to the bone. work: box, world  [m]
  HeatGrid(volume::Bone& bone, const math::Aabb& work, const HeatSettings& settings);

  // Reads what was cut or added since the last call. Removed bone takes its heat along; new
  // material has the starting temperature. False: the servo was writing; call again.
  bool read_changes();

  // Heats the matter within `radius` (at least one cell) of p, in proportion to its heat capacity
  // and less towards the edge. Returns the heat put in: all of it, or nothing if there is no
  // matter.  [J]
  double deposit(const math::Vec3& p, double radius, double energy);

  // From now on coolant runs over all open surface within wet_radius of p; dry() ends it.
  void irrigate(const math::Vec3& p);
  void dry() { wet_ = false; }

  // Advances the time, in as many steps as stability needs.  [s]
  void advance(double seconds);

  // Sets all temperatures and doses back to the start; the bone stays as it is.
  void start_over();

  // ---- reading
  [[nodiscard]] const CellBox& box() const { return box_; }
  [[nodiscard]] math::Vec3 centre(const math::Ijk& cell) const;  // world  [m]
  [[nodiscard]] math::Ijk cell_at(const math::Vec3& p) const;    // may lie outside the box
  [[nodiscard]] bool has_matter(const math::Ijk& cell) const;
  // Of the cell; the starting temperature if it has no matter or is outside.  [deg C]
  [[nodiscard]] double temperature_c(const math::Ijk& cell) const;
  [[nodiscard]] double cem43_min(const math::Ijk& cell) const;
  [[nodiscard]] double longest_stable_step() const;  // [s]
  [[nodiscard]] HeatLedger ledger() const;           // without `spent`
  [[nodiscard]] double wet_area() const;             // of all surface open to the air [m^2]
  // Fills in everything but time, rows and `spent`.
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
  std::vector<volume::BrickIndex> due_;  // changed and not yet read

  // one entry per cell of the box and of the layer around it, which stays at the start temperature
  std::vector<double> rise_, next_;        // above start_c  [K]
  std::vector<double> capacity_, warmth_;  // [J/K]; 1 / capacity, or 0 [K/J]
  std::vector<double> dose_;               // [min]
  std::vector<float> peak_;                // highest rise  [K]
  std::vector<float> k_, share_;           // share * k  [W/(m K)]; share  [-]
  std::array<std::vector<float>, 3> g_;    // to the next cell along x, y, z [W/K]
  std::vector<float> area_, film_;         // open to the air  [m^2]; to the coolant, when wet [W/K]
  std::vector<Parts> parts_;
  std::vector<int> in_row_;  // (count.y x count.z) number of cells with matter

  double fastest_ = 0;  // largest sum G / C so far          [1/s]
  bool wet_ = false;
  math::Vec3 nozzle_ = math::Vec3::Zero();  // p_cell
  HeatLedger ledger_;
  // highest of what was cut; only ever_c, cem43_min, there
  std::array<TissueHeat, 256> removed_peak_;
};

}  // namespace burr::thermal
