#include "burr/workshop/case_session.h"

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "burr/base/printable.h"

namespace burr::workshop {
namespace {

template <class Names>
Status unknown(const scenario::Case& work, const char* field, const std::string& word,
               const Names& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return error(fmt::format("{}.toml: session.{}: \"{}\" is not known; use one of {}", work.name,
                           field, base::printable(word), list));
}

}  // namespace

Status take_session(const scenario::Case& work, tick::ServoSettings& servo) {
  if (!work.session) return fine();
  const scenario::SessionWish& wish = *work.session;
  if (!wish.touch.empty()) {
    const auto touch = haptics::method_named(wish.touch);
    if (!touch) return unknown(work, "touch", wish.touch, haptics::kMethodNames);
    servo.touch = *touch;
  }
  if (!wish.removal.empty()) {
    const auto law = edit::law_named(wish.removal);
    if (!law) return unknown(work, "removal", wish.removal, edit::kLawNames);
    servo.removal.law = *law;
  }
  if (wish.rate_hz) servo.rate_hz = *wish.rate_hz;
  if (wish.stiffness_n_per_m) servo.force.stiffness = *wish.stiffness_n_per_m;
  if (wish.drag) servo.drag_gain = *wish.drag;
  if (wish.vibration) servo.vibration_gain = *wish.vibration;
  if (wish.torque_mnm) servo.motor.torque = 1e-3 * *wish.torque_mnm;
  if (wish.teeth) servo.burr.teeth = static_cast<int>(*wish.teeth);
  if (wish.undo_bricks) servo.undo_bricks = static_cast<std::size_t>(*wish.undo_bricks);
  if (wish.guard) servo.guarded = *wish.guard;
  if (wish.irrigation) servo.irrigated = *wish.irrigation;
  return fine();
}

}  // namespace burr::workshop
