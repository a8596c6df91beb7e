// dataset/layout.h - one file of a data set: the names, shapes and types of FIVRS' layout 3, and what
// it says about itself.
//
// Thread: that of hdf5_file.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "burr/base/result.h"
#include "burr/dataset/hdf5_file.h"
#include "burr/dataset/options.h"
#include "burr/math/pose.h"
#include "burr/tick/rows.h"
#include "burr/volume/bone.h"

namespace burr::dataset {

// What all files of one recording share.
struct Facts {
  const volume::Bone* bone = nullptr;  // before the first tick
  double rate_hz = 1000;
  double field_of_view = 0.5;
  bool view_recorded = true;  // false: one camera at rest
  std::string late;           // Crossings::late
  std::string work_case;      // its name; empty: none
};

// The middle of the volume's box, and its axes: where index (i, j, k) is, is the volume's
// pose * (voxel * (ijk + 1/2 - size/2)).
[[nodiscard]] math::Pose pose_of_volume(const volume::Grid& grid);

// A share of a colour, 0 to 1, as a byte.
[[nodiscard]] std::uint8_t byte_of(float share);

// The pictures of one sample, from the top row down. Colours: blue, green, red.
struct SamplePictures {
  std::span<const std::uint8_t> left, right, labels;  // height x width x 3
  std::span<const std::uint16_t> depth;               // height x width, half_of() [m]
};

// A voxel that crossed the surface.
struct CrossedLabel {
  std::array<std::int32_t, 3> at = {};
  volume::TissueId tissue = 0;
};

class Layout {
 public:
  Layout(const std::string& path, const Facts& facts, const Options& options);

  // t: since 1970, or since the first tick [s]; must not decrease
  void tick(double t, const tick::TickRow& row, const math::Pose& camera);
  void sample(double t, const tick::TickRow& row, const math::Pose& camera,
              const SamplePictures* pictures);
  // A group of voxels of one tick.
  void removed(double t, std::span<const CrossedLabel> voxels) { cross(removed_, t, voxels); }
  void added(double t, std::span<const CrossedLabel> voxels) { cross(added_, t, voxels); }

  [[nodiscard]] Status finish() { return file_.finish(); }

 private:
  struct Timed {
    Column *time = nullptr, *value = nullptr;
  };
  struct Crossed {
    Column *time = nullptr, *voxel = nullptr, *colour = nullptr;
  };
  void describe(const Options& options);
  void make_columns(const Options& options);
  Timed poses(const std::string& name);
  Crossed crossed(const std::string& name, const char* voxels);
  void cross(Crossed& columns, double t, std::span<const CrossedLabel> voxels);

  Facts facts_;
  Hdf5File file_;
  Timed drill_, proxy_, camera_, anatomy_, wrench_, burr_;
  Crossed removed_, added_;
  Column *time_ = nullptr, *drill_sample_ = nullptr, *proxy_sample_ = nullptr,
         *camera_sample_ = nullptr, *volume_sample_ = nullptr;
  Column *left_ = nullptr, *right_ = nullptr, *labels_ = nullptr, *depth_ = nullptr;
  double burr_mm_ = -1;  // the last in this file
};

}  // namespace burr::dataset
