#include "shared/setting_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>
#include <utility>

#include "burr/base/check.h"

namespace burr::app {
namespace {

using tick::About;
using Take = std::function<void(const base::Given&)>;

template <class Number>
bool read_whole(std::string_view text, Number& out) {
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), out);
  return trouble == std::errc() && end == text.data() + text.size();
}

// What was typed for it: a number where it is one, otherwise the text.
base::Given given_of(const About& about, const std::string& text) {
  if (about.kind == About::Kind::choice) return text;
  const std::string_view digits = std::string_view(text).substr(text.starts_with('+') ? 1 : 0);
  std::int64_t whole = 0;
  double number = 0;
  if (about.kind == About::Kind::whole && read_whole(digits, whole)) return whole;
  if (read_whole(digits, number)) return number;
  return text;
}

std::string help_of(const About& about, const std::string& own) {
  std::string help = own;
  if (help.empty()) help = *about.typed.help != '\0' ? about.typed.help : about.help;
  if (about.kind == About::Kind::number || about.kind == About::Kind::whole)
    help += "; " + tick::typed_range(about);
  return help;
}

CLI::Option* add(CLI::App& command, const About& about, Take take, const std::string& help) {
  const std::string name = option_name(about);
  if (about.kind == About::Kind::flag)
    return command.add_flag_function(
        name, [take = std::move(take)](std::int64_t times) { take(times > 0); }, help);
  auto* option = command.add_option_function<std::string>(
      name,
      [&about, take = std::move(take)](const std::string& text) { take(given_of(about, text)); },
      help);
  const bool choice = about.kind == About::Kind::choice;
  option->type_name(choice ? "TEXT" : about.kind == About::Kind::whole ? "INT" : "FLOAT");
  // a closed set stands in the help, and a shell completes it
  const std::string names = choice ? fmt::format("{{{}}}", fmt::join(about.choices, ",")) : "";
  return option->check(CLI::Validator(
      [&about](const std::string& text) {
        const auto si = tick::si_of(about, given_of(about, text));
        return si ? std::string() : si.error().text;
      },
      names));
}

}  // namespace

std::string option_name(const About& about) {
  std::string name =
      about.typed.option != nullptr ? about.typed.option : std::string(about.typed.word);
  std::replace(name.begin(), name.end(), '_', '-');
  return "--" + name;
}

void add_setting_options(CLI::App& command, tick::TypedValues& given) {
  for (const auto& one : tick::servo_settings()) {
    const About& about = one.about;
    if (about.typed.word == nullptr) continue;
    std::string help = help_of(about, {});
    if (about.typed.place != tick::Typed::Place::neither)
      help += " (with a case: that of the case)";
    auto* option = add(
        command, about,
        [&given, &about](const base::Given& value) { given[about.typed.word] = value; }, help);
    if (about.kind == About::Kind::flag) continue;
    const base::Given usual = tick::usual_value(one);
    const std::string* name = std::get_if<std::string>(&usual);
    option->default_str(name != nullptr ? *name : tick::text_of(usual));
  }
}

CLI::Option* add_setting_option(CLI::App& command, std::string_view word, Take take,
                                const std::string& help) {
  const auto* setting = tick::setting_of_word(word);
  BURR_CHECK(setting != nullptr);
  return add(command, setting->about, std::move(take), help_of(setting->about, help));
}

CLI::Option* add_setting_option(CLI::App& command, std::string_view word, double& to,
                                const std::string& help) {
  auto* option = add_setting_option(
      command, word, [&to](const base::Given& value) { to = std::get<double>(value); }, help);
  return to != 0 ? option->default_str(tick::text_of(to)) : option;
}

}  // namespace burr::app
