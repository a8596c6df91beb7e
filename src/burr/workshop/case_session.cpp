#include "burr/workshop/case_session.h"

#include <fmt/format.h>

#include <string>

#include "burr/base/printable.h"
#include "burr/tick/setting_table.h"

namespace burr::workshop {
namespace {

std::string place_of(const scenario::Case& work, const scenario::CaseSettings::Field& field) {
  return field.line > 0
             ? fmt::format("{}.toml: line {}: session.{}", work.name, field.line,
                           base::printable(field.word))
             : fmt::format("{}.toml: session.{}", work.name, base::printable(field.word));
}

std::string known_words() {
  std::string list;
  for (const auto& one : tick::servo_settings())
    if (one.about.typed.place == tick::Typed::Place::session)
      list += (list.empty() ? "" : ", ") + std::string(one.about.typed.word);
  return list;
}

}  // namespace

Status take_session(const scenario::Case& work, tick::ServoSettings& servo) {
  if (!work.session) return fine();
  for (const scenario::CaseSettings::Field& field : work.session->fields) {
    const auto* setting = tick::setting_of_word(field.word);
    if (setting == nullptr || setting->about.typed.place != tick::Typed::Place::session)
      return error(
          fmt::format("{}: is not a known field; use {}", place_of(work, field), known_words()));
    const Result<double> si = tick::si_of(setting->about, field.value);
    if (!si) return error(fmt::format("{}: {}", place_of(work, field), si.error().text));
    setting->set(servo, *si);
  }
  return fine();
}

Status check_session(const scenario::Case& work) {
  tick::ServoSettings tried;
  return take_session(work, tried);
}

}  // namespace burr::workshop
