// device/haply/pipeline.h - what Haply's service does to places and forces on their way between a session and an arm:
// axes (basis), mount, workspace, filters. burr asks for none of it, reads back what there is, and refuses an arm
// whose service turns, moves or weakens what burr sends. For use of this room only.
//
// Source: the maker's published pages of service 3.5 (basis, mount and workspace, filters, device configuration).
// A service before 3.5 tells nothing of it. Frame: the service's. Thread: any.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "burr/math/pose.h"

namespace burr::device::haply {

// What burr asks for: the arm's own frame, and the gate with which an arm is sold, which weakens forces only while
// they swing.
inline constexpr const char* kBasis = "XYZ";
inline constexpr const char* kPreset = "defaults";
inline constexpr double kForceGate = 0.3;

// As a message with the configuration tells it; nothing: it is not told.
struct Pipeline {
  std::optional<std::string> basis, preset;
  std::optional<math::Pose> mount, workspace;
  math::Vec3 mount_scale = math::Vec3::Ones(), workspace_scale = math::Vec3::Ones();
  std::optional<double> force_gate, damping;
  math::Vec3 damping_along = math::Vec3::Zero();

  [[nodiscard]] bool told() const { return basis || mount || force_gate || damping; }
};

// False: the message has no configuration of this arm, or one that cannot be read.
[[nodiscard]] bool read_pipeline(std::string_view text, const std::string& id, Pipeline& pipeline);

// What stands between burr and the arm, as the end of a sentence: "turns the axes (basis XZY)". Empty: nothing.
[[nodiscard]] std::string in_the_way(const Pipeline& pipeline);

// The parts of a session's first message, to be put into {}: of the session, and of the arm.
[[nodiscard]] std::string ask_of_session();
[[nodiscard]] std::string ask_of_arm();

}  // namespace burr::device::haply
