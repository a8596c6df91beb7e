#include "burr/dataset/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "burr/dataset/eye.h"
#include "burr/workshop/work_view.h"

namespace burr::dataset {
namespace {

constexpr std::size_t kRows = 4096;  // packed together
const std::string kPhysics = "/physics_data/", kVision = "/vision_data/";

// x y z, then the quaternion x y z w
std::array<double, 7> numbers_of(const math::Pose& pose) {
  return {pose.p.x(), pose.p.y(), pose.p.z(), pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()};
}

std::string readme(const Facts& facts, const Options& options) {
  const volume::Grid& grid = facts.bone->grid();
  std::string text =
      "Written by burr from a recording, in the layout of FIVRS, format 3.\n"
      "\n"
      "Frames. Positions are in metres, quaternions are x y z w. The world is that of the scan: x "
      "to "
      "the patient's left, y to the back, z to the head (LPS). A pose turns coordinates of the "
      "object "
      "into coordinates of the world.\n"
      "pose_mastoidectomy_drill and drill_pose: the tool as the hand holds it; its origin is the "
      "middle "
      "of the burr head, its shaft lies along +z. The hand may be inside bone.\n"
      "pose_mastoidectomy_proxy and proxy_pose: the same tool where the bone lets it be; pictures "
      "show "
      "this one.\n"
      "pose_mastoidectomy_volume and anatomy_pose: the volume. Its origin is the middle of its "
      "box; "
      "voxel (i, j, k) is at voxel * (ijk + 1/2 - size/2).\n"
      "pose_main_camera and camera_pose: the middle between the eyes; the camera looks along -x, y "
      "is "
      "to the right, z is up in the picture. camera_extrinsic turns that into the camera of OpenCV "
      "(z ahead, x to the right, y down). So a point p of the world is at "
      "camera_intrinsic * camera_extrinsic * inverse(pose_main_camera) * p. Pictures are measured "
      "from "
      "their top left corner; the first pixel reaches from 0 to 1, so its middle is at 0.5.\n";
  text +=
      facts.view_recorded
          ? "The camera is the one of the recorded session. All pictures have the field of view of "
            "its first moment.\n"
          : "The recording holds no view; the camera is at rest and looks at the last place of the "
            "work.\n";
  if (options.width > 0)
    text +=
        "l_img and r_img: half the baseline to the left and to the right of that camera, with "
        "parallel "
        "axes and the same matrix. depth and segm: from the camera itself. depth is along the "
        "camera's "
        "axis, in metres, as 16 bit numbers (steps of 0.06 mm at 0.1 m); infinite where nothing "
        "is. "
        "Pictures and segm are blue, green, red, as OpenCV has them. segm has the colours of "
        "label_colors (there red, green, blue), the tool is white, nothing is black.\n";
  text += options.begins > 0
              ? fmt::format(
                    "Times are seconds since 1970. The first tick was given the time {:.3f}; the "
                    "recording itself holds no time of day.\n",
                    options.begins)
              : "Times are seconds since the first tick; the recording holds no time of day.\n";
  text += fmt::format(
      "\n"
      "What is lost. burr removes bone in parts of a voxel; a voxel counts as removed in the tick "
      "in "
      "which less than half of it is left at its middle (the field falls below its iso level). "
      "What was "
      "cut from a voxel before, or is left of it, is not here: voxels of {:.4g} mm times their "
      "number is "
      "not the exact volume removed.\n"
      "Voxels that came back (undo, added material) are in voxels_added, which FIVRS does not "
      "know; one "
      "that left twice is in voxels_removed twice. A piece of bone that was moved left in one "
      "place and "
      "came in another.\n"
      "wrench is the force and the torque on the hand, in the world's axes, about the tip. In "
      "files of "
      "FIVRS the torque columns repeat the force; these do not.\n"
      "burr_size is the diameter of a round burr; 0: the tool was no round burr.\n"
      "Ticks, commands, bone states and settings of the recording that have no place in this "
      "layout are "
      "not here.\n",
      1e3 * grid.voxel);
  if (!facts.late.empty())
    text += fmt::format(
        "The session could not be simulated again by this burr ({}). The times of voxels are "
        "therefore "
        "those of recorded states of the bone, up to 0.1 s late.\n",
        facts.late);
  return text;
}

}  // namespace

std::uint8_t byte_of(float share) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0F, 1.0F)));
}

math::Pose pose_of_volume(const volume::Grid& grid) {
  const math::Vec3 middle = 0.5 * (grid.size.cast<double>() - math::Vec3::Ones());
  return {grid.world_from_grid(middle), grid.frame.q};
}

Layout::Layout(const std::string& path, const Facts& facts, const Options& options)
    : facts_(facts), file_(path) {
  describe(options);
  make_columns(options);
  if (!options.old_names) return;
  file_.link("/metadata", "/metadata_v3");
  file_.link("/data", kVision + "continuous_data");
  file_.link("/high_frequency_poses", kPhysics + "continuous_data/high_frequency_poses");
  for (const char* name : {"voxels_removed", "burr_change", "drill_force_feedback"})
    file_.link(std::string("/") + name, kPhysics + "intermittent_data/" + name);
}

void Layout::describe(const Options& options) {
  const std::string to = "/metadata_v3/";
  const volume::Grid& grid = facts_.bone->grid();
  const int width = options.width > 0 ? options.width : 640,
            height = options.height > 0 ? options.height : 480;
  file_.numbers(to + "camera_intrinsic", intrinsic(facts_.field_of_view, width, height), {3, 3});
  file_.numbers(to + "camera_extrinsic", kCvFromAmbf, {4, 4});
  const double voxel_mm = 1e3 * grid.voxel;
  file_.numbers(to + "voxel_volume", std::array{voxel_mm * voxel_mm * voxel_mm}, {});
  file_.note(to + "voxel_volume", "units", "mm^3");
  file_.numbers(to + "baseline", std::array{options.baseline}, {});
  file_.note(to + "baseline", "units", "m");
  const math::Vec3 size = grid.size.cast<double>();
  file_.numbers(to + "volume_size", std::array{size.x(), size.y(), size.z()}, {3});
  file_.numbers(to + "voxel_size", std::array{grid.voxel}, {});
  file_.note(to + "voxel_size", "units", "m");
  std::vector<std::string> names;
  std::vector<double> colours;
  for (const volume::Tissue& tissue : facts_.bone->tissues().tissues) {
    names.push_back(tissue.name);
    for (const float share : tissue.colour) colours.push_back(byte_of(share));
  }
  file_.texts(to + "label_names", names);
  file_.numbers(to + "label_colors", colours, {names.size(), 3});
  file_.text(to + "README", readme(facts_, options));
  if (!facts_.work_case.empty()) file_.text(to + "case", facts_.work_case);
  file_.group(kVision + "intermittent_data");
}

Layout::Timed Layout::poses(const std::string& name) {
  const std::string to = kPhysics + "continuous_data/high_frequency_poses/" + name;
  return {&file_.column(to + "/time_stamp", Kind::f64, {}, kRows),
          &file_.column(to + "/pose", Kind::f64, {7}, kRows)};
}

Layout::Crossed Layout::crossed(const std::string& name, const char* voxels) {
  const std::string to = kPhysics + "intermittent_data/" + name + "/";
  return {&file_.column(to + "voxel_time_stamp", Kind::f64, {}, kRows),
          &file_.column(to + voxels, Kind::i32, {4}, kRows),
          &file_.column(to + "voxel_color", Kind::i32, {5}, kRows)};
}

void Layout::make_columns(const Options& options) {
  const std::string sight = kVision + "continuous_data/", now = kPhysics + "intermittent_data/";
  time_ = &file_.column(sight + "time", Kind::f64, {}, kRows);
  drill_sample_ = &file_.column(sight + "pose_mastoidectomy_drill", Kind::f64, {7}, kRows);
  proxy_sample_ = &file_.column(sight + "pose_mastoidectomy_proxy", Kind::f64, {7}, kRows);
  camera_sample_ = &file_.column(sight + "pose_main_camera", Kind::f64, {7}, kRows);
  volume_sample_ = &file_.column(sight + "pose_mastoidectomy_volume", Kind::f64, {7}, kRows);
  if (options.width > 0) {
    const auto high = static_cast<std::uint64_t>(options.height),
               wide = static_cast<std::uint64_t>(options.width);
    left_ = &file_.column(sight + "l_img", Kind::u8, {high, wide, 3}, 1);
    right_ = &file_.column(sight + "r_img", Kind::u8, {high, wide, 3}, 1);
    labels_ = &file_.column(sight + "segm", Kind::u8, {high, wide, 3}, 1);
    depth_ = &file_.column(sight + "depth", Kind::f16, {high, wide}, 1);
  }
  removed_ = crossed("voxels_removed", "voxel_removed");
  added_ = crossed("voxels_added", "voxel_added");
  file_.text(
      now + "voxels_removed/README",
      "Voxels that left the bone, in groups. The first column of voxel_removed and of "
      "voxel_color is the row of the group in voxel_time_stamp. Then come the index i j k, or "
      "the colour of its label: red green blue opacity, 0 to 255.");
  burr_ = {&file_.column(now + "burr_change/time_stamp", Kind::f64, {}, 64),
           &file_.column(now + "burr_change/burr_size", Kind::f64, {}, 64)};
  file_.note(now + "burr_change/burr_size", "units", "mm");
  wrench_ = {&file_.column(now + "drill_force_feedback/time_stamp", Kind::f64, {}, kRows),
             &file_.column(now + "drill_force_feedback/wrench", Kind::f64, {6}, kRows)};
  drill_ = poses("drill_pose");
  proxy_ = poses("proxy_pose");
  camera_ = poses("camera_pose");
  anatomy_ = poses("anatomy_pose");
}

void Layout::tick(double t, const tick::TickRow& row, const math::Pose& camera) {
  const auto put = [t](Timed& columns, const auto& numbers) {
    columns.time->add(&t);
    columns.value->add(numbers.data());
  };
  put(drill_, numbers_of(row.hand.world_from_tool));
  put(proxy_, numbers_of(workshop::pose_of_tool(row)));
  put(camera_, numbers_of(camera));
  put(anatomy_, numbers_of(pose_of_volume(facts_.bone->grid())));
  const math::Vec3 &f = row.contact.force, &m = row.contact.torque;
  put(wrench_, std::array{f.x(), f.y(), f.z(), m.x(), m.y(), m.z()});
  const double burr_mm = row.tool.number < 0 ? 2e3 * row.tool.radius : 0;
  if (burr_mm == burr_mm_) return;
  burr_mm_ = burr_mm;
  put(burr_, std::array{burr_mm});
}

void Layout::sample(double t, const tick::TickRow& row, const math::Pose& camera,
                    const SamplePictures* pictures) {
  time_->add(&t);
  drill_sample_->add(numbers_of(row.hand.world_from_tool).data());
  proxy_sample_->add(numbers_of(workshop::pose_of_tool(row)).data());
  camera_sample_->add(numbers_of(camera).data());
  volume_sample_->add(numbers_of(pose_of_volume(facts_.bone->grid())).data());
  if (pictures == nullptr) return;
  left_->add(pictures->left.data());
  right_->add(pictures->right.data());
  labels_->add(pictures->labels.data());
  depth_->add(pictures->depth.data());
}

void Layout::cross(Crossed& columns, double t, std::span<const CrossedLabel> voxels) {
  const auto group = static_cast<std::int32_t>(columns.time->rows());
  columns.time->add(&t);
  for (const CrossedLabel& voxel : voxels) {
    const std::array<float, 3>& colour = facts_.bone->tissues()[voxel.tissue].colour;
    const std::array<std::int32_t, 4> where = {group, voxel.at[0], voxel.at[1], voxel.at[2]};
    const std::array<std::int32_t, 5> what = {group, byte_of(colour[0]), byte_of(colour[1]),
                                              byte_of(colour[2]), 255};
    columns.voxel->add(where.data());
    columns.colour->add(what.data());
  }
}

}  // namespace burr::dataset
