// `burr settings`: every setting of a session, from the table that all fronts use (tick/setting_table.h).
// docs/use/settings.md is what it prints with --markdown.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "burr/tick/second_hand.h"
#include "burr/tick/setting_table.h"
#include "shared/setting_options.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using tick::About;
using tick::Setting;
using Place = tick::Typed::Place;

// "a whole number from 1 to 64": "1 to 64"
std::string short_range(const std::string& range) {
  for (const std::string_view words : {"a number from ", "a whole number from ", "one of "})
    if (range.starts_with(words)) return range.substr(words.size());
  return range;
}

const char* meaning_of(const About& about) {
  return *about.typed.help != '\0' ? about.typed.help : about.help;
}

std::string place_of(const About& about) {
  if (about.typed.place == Place::session) return fmt::format("`{}`", about.typed.word);
  return about.typed.place == Place::burr ? "`[burr]`" : "";
}

std::string usual_of(const Setting<tick::ServoSettings>& one) {
  const base::Given usual = tick::usual_value(one);
  const std::string* name = std::get_if<std::string>(&usual);
  return name != nullptr ? *name : tick::text_of(usual);
}

void print_given() {
  fmt::print(
      "|option|in a case|in Python|range|usual|what it is|in a recording|\n"
      "|---|---|---|---|---|---|---|\n");
  for (const auto& one : tick::servo_settings()) {
    const About& about = one.about;
    if (about.typed.word == nullptr) continue;
    const bool in_python = about.typed.place != Place::neither;
    fmt::print("|`{}`|{}|{}|{}|{}|{}|`{}`|\n", option_name(about), place_of(about),
               in_python ? fmt::format("`{}`", tick::property_of(about)) : "",
               short_range(tick::typed_range(about)), usual_of(one), meaning_of(about), about.name);
  }
}

// Those that only programs set.
template <class Of>
void print_rows(const char* title, std::span<const Setting<Of>> table) {
  fmt::print("\n### {}\n\n|in a recording|range|usual|what it is|\n|---|---|---|---|\n", title);
  for (const Setting<Of>& one : table) {
    const About& about = one.about;
    if (about.typed.word != nullptr) continue;
    fmt::print("|`{}`|{}|{}|{}{}|\n", about.name, short_range(tick::range_of(about, about.range)),
               tick::text_of(one.get(Of())), about.help,
               *about.since != '\0' ? fmt::format(" (recorded since {})", about.since) : "");
  }
}

void print_page() {
  fmt::print(
      "# Settings of a session\n\n"
      "`burr settings --markdown` prints this page from the table that burr itself uses. A value "
      "out "
      "of its range is\nrefused with one sentence, wherever it was given.\n\n"
      "## What you can give\n\n"
      "An option of `burr mill` goes before the case, and the case before what is usual. Fields of "
      "a "
      "case stand in\n`[session]`; `[burr]` of [a case](cases.md) has diameter, kind and "
      "speed.\n\n");
  print_given();
  fmt::print(
      "\n## What programs set\n\nIn C++ each is a member of `tick::ServoSettings`, or of what is "
      "named "
      "here; a recording keeps it.\n");
  print_rows("Of the session", tick::servo_settings());
  print_rows("Limits of the force (`haptics::LimitSettings`)", tick::limit_settings());
  print_rows("The felt surface (`volume::IsoSettings`)", tick::surface_settings());
  print_rows("The second hand (`tick::SecondHandSettings`)", tick::second_hand_settings());
  print_rows("The device (`device::DeviceSpec`), by its driver", tick::device_settings());
}

void print_lines() {
  for (const auto& one : tick::servo_settings())
    if (one.about.typed.word != nullptr)
      fmt::print("{:<16} {}; {}; usual: {}\n", option_name(one.about), meaning_of(one.about),
                 tick::typed_range(one.about), usual_of(one));
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand(
      "settings", "list the settings of a session, with their ranges and what is usual");
  auto markdown = std::make_shared<bool>(false);
  command->add_flag("--markdown", *markdown,
                    "all of them, also those that only programs set, as docs/use/settings.md");
  command->callback([markdown, &todo] {
    todo.work = [markdown] {
      if (*markdown)
        print_page();
      else
        print_lines();
      return fine();
    };
  });
}

const Command command{63, add};

}  // namespace
}  // namespace burr::app
