// metrics/solid_contacts.h - when a turning burr touched a structure of solid tissue (an ossicle, a
// tooth), and how hard.
//
// The contact point is c - r n: centre of the head, its radius, the contact's normal out of the bone.
// It belongs to the structure if the nearest solid tissue there is one of the structure's and lies
// within a voxel. The nearest tissue is that before the first cut. Frame: world. Units: SI. Thread:
// one. Memory: fixed; none per tick.
#pragma once

#include <array>
#include <span>

#include "burr/metrics/intact_soft.h"
#include "burr/metrics/measured.h"
#include "burr/metrics/moment.h"
#include "burr/volume/distance_to.h"
#include "burr/volume/tissue.h"

namespace burr::metrics {

class SolidContactsMaker {
 public:
  // all: the distance to all solid tissues of the bone; outlives this. structure: some of them.
  SolidContactsMaker(const volume::DistanceTo& all, std::span<const volume::TissueId> structure,
                     double voxel);
  void add(const Moment& now);
  // Depth of a contact is 0: a burr cannot be inside solid bone. Not assessable: no solid tissue in
  // the bone, no tissue named, the burr never turned, or no radius was recorded while it did.
  [[nodiscard]] Assessed<Contacts> finish() const;

 private:
  const volume::DistanceTo& all_;
  std::array<bool, 256> of_structure_ = {};
  bool named_, turned_ = false, radius_ = false;
  double voxel_;
  Contacts contacts_;
};

}  // namespace burr::metrics
