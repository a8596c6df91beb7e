// apps/burr/commands/mill_options.h - the options of `burr mill`. A value that was not typed is taken from the
// case, if one was named.
//
// Thread: main.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/sim/session.h"
#include "burr/tick/setting_table.h"
#include "commands/second_options.h"
#include "shared/law_choice.h"
#include "shared/picture_size.h"
#include "shared/tool_options.h"

namespace CLI {
class App;
}

namespace burr::app {

inline constexpr std::string_view kStepMotion = "step:";  // --motion step:ID

struct MillOptions {
  scenario::BoneRecipe volume;
  PictureSize size;
  std::string path_csv, motion_name, record, picture, arm = "firm", mirror;
  ToolOptions tool;
  SecondOptions second;
  LawChoice law;
  std::string carry_piece;
  std::vector<double> at_mm, into;
  std::vector<std::string> move_pieces;
  double seconds = 10;
  // Of the session: what was typed; and with it, what the case says and what is usual.
  tick::TypedValues given, settings = tick::usual_values();
  bool heat = false, realtime = false, embed = false, json = false, force = false;
  bool seconds_given = false;
  std::optional<scenario::Case> work_case;  // if the volume is one

  [[nodiscard]] double burr_mm() const { return std::get<double>(settings.at("burr_mm")); }
};

// Adds the command. chosen: gets the options when they were parsed.
void add_mill(CLI::App& app, const std::function<void(std::shared_ptr<const MillOptions>)>& chosen);

// Fills MillOptions::settings. A case says what is milled and, unless the options do, with which burr,
// where, and which way in. Error: of the case.
[[nodiscard]] Status take_case(MillOptions& options);

// What a session is made with. Error: the tool, the law.
[[nodiscard]] Status set_session(const MillOptions& options, sim::SessionSettings& settings);

}  // namespace burr::app
