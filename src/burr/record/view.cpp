#include "burr/record/view.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace burr::record {
namespace {

using nlohmann::json;

constexpr double kScreen = 0.3;  // height of the screen that magnification means [m]

json array(const math::Vec3& v) { return {v.x(), v.y(), v.z()}; }

bool get(const json& object, const char* name, math::Vec3& to) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_array() || at->size() != 3) return false;
  for (std::size_t n = 0; n < 3; ++n) {
    if (!(*at)[n].is_number()) return false;
    to[static_cast<Eigen::Index>(n)] = (*at)[n].get<double>();
  }
  return true;
}

bool get(const json& object, const char* name, double& to) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_number()) return false;
  to = at->get<double>();
  return true;
}

bool get(const json& object, const char* name, bool& to) {
  const auto at = object.find(name);
  if (at == object.end() || !at->is_boolean()) return false;
  to = at->get<bool>();
  return true;
}

}  // namespace

double magnification_of(double view_height) { return kScreen / std::max(view_height, 1e-9); }
double view_height_of(double magnification) { return kScreen / std::max(magnification, 1e-9); }

bool same_sight(const View& a, const View& b) {
  return a.eye == b.eye && a.right == b.right && a.up == b.up && a.back == b.back &&
         a.field_of_view == b.field_of_view && a.magnification == b.magnification &&
         a.see_through == b.see_through && a.colours == b.colours && a.slices == b.slices &&
         a.panels == b.panels && a.two_eyes == b.two_eyes;
}

bool View::operator==(const View& other) const {
  return tick == other.tick && same_sight(*this, other);
}

Status check(const View& view) {
  const auto unit = [](const math::Vec3& v) { return std::abs(v.norm() - 1) < 1e-6; };
  if (!view.eye.allFinite() || !std::isfinite(view.field_of_view) ||
      !std::isfinite(view.magnification) || !std::isfinite(view.see_through))
    return error(Trouble::internal, "recording: a view holds a number that is not finite");
  if (!unit(view.right) || !unit(view.up) || !unit(view.back))
    return error(Trouble::internal, "recording: an axis of a view is not a unit vector");
  return fine();
}

std::string to_json(const View& view) {
  const json object = {{"tick", view.tick},
                       {"eye_m", array(view.eye)},
                       {"right", array(view.right)},
                       {"up", array(view.up)},
                       {"back", array(view.back)},
                       {"field_of_view_rad", view.field_of_view},
                       {"magnification", view.magnification},
                       {"see_through", view.see_through},
                       {"colours", view.colours},
                       {"slices", view.slices},
                       {"panels", view.panels},
                       {"two_eyes", view.two_eyes}};
  return object.dump();
}

bool view_from_json(std::string_view text, View& view) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object()) return false;
  const auto tick = object.find("tick");
  if (tick == object.end() || !tick->is_number_unsigned()) return false;
  View read;
  read.tick = tick->get<std::uint64_t>();
  if (!get(object, "eye_m", read.eye) || !get(object, "right", read.right) ||
      !get(object, "up", read.up) || !get(object, "back", read.back) ||
      !get(object, "field_of_view_rad", read.field_of_view) ||
      !get(object, "magnification", read.magnification) ||
      !get(object, "see_through", read.see_through) || !get(object, "colours", read.colours) ||
      !get(object, "slices", read.slices) || !get(object, "panels", read.panels) ||
      !get(object, "two_eyes", read.two_eyes) || !check(read))
    return false;
  view = read;
  return true;
}

std::string view_schema() {
  return R"({
 "$schema": "https://json-schema.org/draft/2020-12/schema",
 "title": "burr.View",
 "description": "What the surgeon saw from this tick on, until the next message.",
 "type": "object",
 "properties": {
  "tick": {"type": "integer"},
  "eye_m": {"type": "array", "items": {"type": "number"}, "description": "LPS; of two eyes the middle [m]"},
  "right": {"type": "array", "items": {"type": "number"}, "description": "unit vector: right in the picture"},
  "up": {"type": "array", "items": {"type": "number"}, "description": "unit vector: up in the picture"},
  "back": {"type": "array", "items": {"type": "number"}, "description": "unit vector: from the picture towards the eye"},
  "field_of_view_rad": {"type": "number", "description": "vertical angle of the picture"},
  "magnification": {"type": "number", "description": "times life size, on a screen of 0.3 m height"},
  "see_through": {"type": "number", "description": "0: the bone hides what lies behind it; 1: it is not seen"},
  "colours": {"type": "boolean", "description": "tissues have their own colours"},
  "slices": {"type": "boolean"},
  "panels": {"type": "boolean"},
  "two_eyes": {"type": "boolean", "description": "stereo"}
 }
})";
}

}  // namespace burr::record
