#include "commands/second_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <optional>
#include <utility>

#include "burr/device/simulated_hand.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/second_hand.h"

namespace burr::app {
namespace {

using math::Vec3;

std::optional<Vec3> vector_of(const std::vector<double>& values, double scale) {
  if (values.empty()) return {};
  return Vec3(values[0], values[1], values[2]) * scale;
}

Result<device::HandPath> path_of(const SecondOptions& options, double radius, double seconds,
                                 const volume::Bone& bone) {
  if (!options.path_csv.empty()) return surgeon::read_path(options.path_csv);
  const auto place = surgeon::find_work_place(bone, radius, vector_of(options.at_mm, 1e-3),
                                              vector_of(options.into, 1));
  if (!place) return place.error();
  return surgeon::motion(options.motion, *place, radius, seconds);
}

}  // namespace

void add_second_options(CLI::App& command, SecondOptions& options) {
  auto* path =
      command.add_option("--second-path", options.path_csv,
                         "CSV file as --path: a second hand follows it in the same session");
  auto* motion = command.add_option(
      "--second-motion", options.motion,
      fmt::format("a second hand makes this motion: {}", fmt::join(surgeon::motion_names(), ", ")));
  motion->excludes(path);
  command
      .add_option("--second-at", options.at_mm,
                  "X,Y,Z [mm, LPS]: where the second hand's motion begins")
      ->delimiter(',')
      ->expected(3)
      ->needs(motion);
  command
      .add_option("--second-into", options.into,
                  "DX,DY,DZ: its direction into the bone (default: against the surface normal)")
      ->delimiter(',')
      ->expected(3)
      ->needs(motion);
}

Status add_second_hand(const SecondOptions& options, const ToolOptions& rack, double seconds,
                       sim::Session& session, std::optional<sim::FollowedPath>& followed) {
  if (!options.wanted()) {
    if (rack.second.empty()) return fine();
    return error(Trouble::usage, "--second-tool " + rack.second +
                                     ": there is no second hand; give it a --second-path or a "
                                     "--second-motion");
  }
  tick::SecondHandSettings settings;
  auto tool = second_tool(rack);
  if (!tool) return tool.error();
  settings.tool = std::move(*tool);
  settings.force = session.settings().servo.force;
  auto path = path_of(options, settings.radius, seconds, session.bone());
  if (!path) return path.error();
  followed = {*path,
              options.path_csv.empty() ? "--second-motion " + options.motion : options.path_csv,
              true};
  return session.add_second_hand(
      std::make_unique<device::SimulatedHand>(std::move(*path), device::ArmSettings{}), settings);
}

}  // namespace burr::app
