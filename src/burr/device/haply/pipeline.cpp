#include "burr/device/haply/pipeline.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "burr/base/printable.h"

namespace burr::device::haply {
namespace {

using math::Quat;
using math::Vec3;
using nlohmann::json;

constexpr double kNear = 1e-4;  // [m], and of turns and scales: numbers of the service are floats

const json* at(const json& in, const char* key) {
  if (!in.is_object()) return nullptr;
  const auto found = in.find(key);
  return found != in.end() ? &*found : nullptr;
}

// What is not a finite number is none.
double number_at(const json& in, const char* key, double otherwise) {
  const json* value = at(in, key);
  return value != nullptr && value->is_number() && std::isfinite(value->get<double>())
             ? value->get<double>()
             : otherwise;
}

std::optional<double> number_at(const json* in, const char* key) {
  const json* value = in != nullptr ? at(*in, key) : nullptr;
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

Vec3 vector_at(const json& in, const char* key, double otherwise) {
  const json* value = at(in, key);
  if (value == nullptr) return Vec3::Constant(otherwise);
  return {number_at(*value, "x", otherwise), number_at(*value, "y", otherwise),
          number_at(*value, "z", otherwise)};
}

// {"position", "rotation", "scale"}, of which the service leaves out what changes nothing; a message may wrap them.
void take_transform(const json* value, std::optional<math::Pose>& pose, Vec3& scale) {
  if (value == nullptr) return;
  if (const json* inner = at(*value, "transform")) value = inner;
  if (!value->is_object()) return;
  math::Pose& out = pose.emplace();
  out.p = vector_at(*value, "position", 0);
  if (const json* turn = at(*value, "rotation"))
    out.q = Quat(number_at(*turn, "w", 1), number_at(*turn, "x", 0), number_at(*turn, "y", 0),
                 number_at(*turn, "z", 0));
  scale = vector_at(*value, "scale", 1);
}

bool is_identity(const math::Pose& pose, const Vec3& scale) {
  return pose.p.norm() < kNear && pose.q.vec().norm() < kNear && std::abs(pose.q.w()) > 0.5 &&
         (scale - Vec3::Ones()).norm() < kNear;
}

// "X-YZ" and "+X-Y+Z" are one.
std::string without_plus(std::string basis) {
  std::erase(basis, '+');
  return basis;
}

}  // namespace

bool read_pipeline(std::string_view text, const std::string& id, Pipeline& pipeline) {
  const json all = json::parse(text, nullptr, false);
  const json* arms = at(all, "inverse3");
  if (arms == nullptr || !arms->is_array()) return false;
  for (const json& arm : *arms) {
    const json *named = at(arm, "device_id"), *config = at(arm, "config");
    if (named == nullptr || *named != id || config == nullptr) continue;
    Pipeline read;
    if (const json* basis = at(*config, "basis"))
      if (const json* way = at(*basis, "permutation"); way != nullptr && way->is_string())
        read.basis = way->get<std::string>();
    if (const json* preset = at(*config, "preset"); preset != nullptr && preset->is_string())
      read.preset = preset->get<std::string>();
    take_transform(at(*config, "mount"), read.mount, read.mount_scale);
    if (const json* state = at(arm, "state"))
      take_transform(at(*state, "transform"), read.workspace, read.workspace_scale);
    if (const json* filters = at(*config, "filters")) {
      read.force_gate = number_at(at(*filters, "force_gate"), "gain");
      const json* damping = at(*filters, "damping");
      read.damping = number_at(damping, "scalar");
      if (damping != nullptr) read.damping_along = vector_at(*damping, "vector", 0);
    }
    pipeline = read;
    return true;
  }
  return false;
}

std::string in_the_way(const Pipeline& pipeline) {
  if (pipeline.basis && without_plus(*pipeline.basis) != kBasis)
    return fmt::format("turns the axes (basis {})", base::printable(*pipeline.basis, 12));
  if (pipeline.mount && !is_identity(*pipeline.mount, pipeline.mount_scale))
    return fmt::format("moves, turns or scales places (mount, preset {})",
                       base::printable(pipeline.preset.value_or("custom"), 30));
  if (pipeline.workspace && !is_identity(*pipeline.workspace, pipeline.workspace_scale))
    return "moves, turns or scales places (transform of the workspace)";
  if (pipeline.damping && !(std::abs(*pipeline.damping) < kNear))
    return fmt::format("damps every motion (filters: damping {:g})", *pipeline.damping);
  if (!(pipeline.damping_along.norm() < kNear))
    return "damps motion along an axis (filters: damping)";
  if (pipeline.force_gate && !(std::abs(*pipeline.force_gate - kForceGate) < 1e-3))
    return fmt::format("weakens forces in another way than burr knows (filters: force_gate {:g})",
                       *pipeline.force_gate);
  return {};
}

std::string ask_of_session() { return fmt::format(R"("basis":{{"permutation":"{}"}})", kBasis); }

std::string ask_of_arm() {
  return fmt::format(
      R"("preset":{{"preset":"{}"}},"damping":{{"scalar":0,"vector":{{"x":0,"y":0,"z":0}}}},"force_gate":{{"gain":{}}})",
      kPreset, kForceGate);
}

}  // namespace burr::device::haply
