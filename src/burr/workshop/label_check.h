// workshop/label_check.h - do the labels of a bone look as the case expects: volume, inscribed
// radius, connected pieces, length, neighbours.
//
// A flooded or broken label would decide a learner's mark. The inscribed radius tells a flooded
// nerve from a nerve better than its volume does.
//
// Units: SI. Thread: any, one at a time. Memory: about 6 bytes for each voxel of the box around a
// structure.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/case.h"
#include "burr/scenario/lesson.h"
#include "burr/volume/bone.h"

namespace burr::workshop {

// A voxel counts if it is labelled so and, for solid tissue, lies inside the surface.
struct LabelFigures {
  std::size_t voxels = 0;
  double volume = 0;  // [m^3]
  // the largest distance from a voxel in it to the nearest one outside, centre to centre: up to a
  // voxel less than the radius of a ball [m]
  double inscribed = 0;
  int pieces = 0;     // connected over faces, edges and corners; those below 1 % are left out
  double length = 0;  // between two voxels that lie far apart; at most a tenth too short [m]
  std::vector<volume::TissueId> neighbours;  // tissues that touch it, sorted
};
[[nodiscard]] LabelFigures label_figures(const volume::Bone& bone,
                                         std::span<const volume::TissueId> tissues);

// "11810", "0.85": a number rounded to so many digits, without an exponent and without zeros at its
// end. digits: 1 to 15.
[[nodiscard]] std::string figure(double value, int digits);

// The tissues of a bone that belong to a structure, by its names.
[[nodiscard]] std::vector<volume::TissueId> tissues_of(const scenario::Structure& structure,
                                                       const volume::TissueTable& table);

struct LabelFinding {
  std::string structure;
  std::uint32_t line = 0;            // of the structure in the case's file
  std::vector<std::string> tissues;  // by their names in the bone; empty: the bone lacks it
  LabelFigures figures;
  std::vector<std::string> faults;  // sentences without the structure's name; empty: as expected
  bool accepted = false;            // the user accepts it in spite of its faults
};

// One finding for each structure of the lesson. accepted: names of structures. Error: interrupted,
// or a name in `accepted` that no structure has.
[[nodiscard]] Result<std::vector<LabelFinding>> check_labels(
    const scenario::CaseLesson& lesson, const volume::Bone& bone,
    const std::vector<std::string>& accepted, Progress& progress);

// Error: one sentence about the first structure whose label is not as expected and not accepted, with
// file, line, fault and remedy, and how many there are. file: as it is to be shown.
[[nodiscard]] Status as_expected(const std::vector<LabelFinding>& findings,
                                 const std::string& file);

// The landmarks of the bone that a case is about: those of a formula; none for a scan.
[[nodiscard]] std::vector<scenario::Landmark> landmarks_of(const scenario::Case& work);

// The lesson of a case, with the landmarks of its bone. Error: as scenario::lesson_of() and place().
[[nodiscard]] Result<scenario::CaseLesson> placed_lesson(const scenario::Case& work);

}  // namespace burr::workshop
