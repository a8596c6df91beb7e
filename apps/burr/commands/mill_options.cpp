#include "commands/mill_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <utility>

#include "burr/surgeon/motion.h"
#include "burr/workshop/case_session.h"
#include "burr/workshop/prepare.h"
#include "shared/law_options.h"
#include "shared/outputs.h"
#include "shared/setting_options.h"
#include "shared/volume_words.h"
#include "shared/work.h"

namespace burr::app {
namespace {

void add_pieces(CLI::App* command, const std::shared_ptr<MillOptions>& options) {
  command->add_option(
      "--move-piece", options->move_pieces,
      "X,Y,Z:DX,DY,DZ[:AX,AY,AZ]: after the motion, move the free piece nearest to "
      "X,Y,Z by DX,DY,DZ [mm, LPS], and turn it about its centre by as many degrees "
      "as AX,AY,AZ is long, about that axis; may be given more than once");
  command->add_option(
      "--carry-piece", options->carry_piece,
      "X,Y,Z:FILE.csv: after the motion, lift the free piece nearest to X,Y,Z [mm, LPS] out of the "
      "bone and carry it by the hand's further path (as --path; the spindle's column grips); the "
      "bone stops it, and it is put down where it then is");
}

void add_results(CLI::App* command, const std::shared_ptr<MillOptions>& options) {
  command->add_flag("--realtime", options->realtime,
                    "run at the speed of the clock (default: as fast as possible)");
  command->add_option("--record", options->record, "F.mcap: record the session");
  command->add_flag("--embed", options->embed, "with --record: store the bone in the file");
  command->add_option("--picture", options->picture, "F.png: picture of the bone afterwards");
  add_force(*command, options->force);
  add_law_options(*command, options->law);
  command
      ->add_option("--reserve-bricks", options->volume.reserve_bricks,
                   "memory for added material: bricks of 8^3 voxels")
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object on the last line");
}

void add_motion(CLI::App* command, const std::shared_ptr<MillOptions>& options) {
  command->add_option("--path", options->path_csv,
                      "CSV file t,x,y,z[,qw,qx,qy,qz][,spindle] of the hand (s, m; or x_mm ...)");
  command->add_option("--motion", options->motion_name,
                      fmt::format("built-in: {}; with a case also step:ID: along the plane of this "
                                  "step, by the burr or a saw",
                                  fmt::join(surgeon::motion_names(), ", ")));
  command
      ->add_option("--at", options->at_mm,
                   "X,Y,Z [mm, LPS]: where the motion begins (default: topmost bone)")
      ->delimiter(',')
      ->expected(3);
  command
      ->add_option("--into", options->into,
                   "DX,DY,DZ: direction into the bone (default: against the surface normal)")
      ->delimiter(',')
      ->expected(3);
}

void add_hand(CLI::App* command, const std::shared_ptr<MillOptions>& options) {
  command->add_option("--arm", options->arm, "grip of the simulated hand: firm, light or rigid")
      ->check(CLI::IsMember({"firm", "light", "rigid"}))
      ->capture_default_str();
  command->add_option("--mirror", options->mirror,
                      "sagittal, coronal or axial[,MM]: everything done on one side of a plane is "
                      "also done on the other; the plane goes through the middle of the volume, or "
                      "MM to the left of, behind or above it");
}

}  // namespace

void add_mill(CLI::App& app,
              const std::function<void(std::shared_ptr<const MillOptions>)>& chosen) {
  auto options = std::make_shared<MillOptions>();
  auto* command = app.add_subcommand("mill", "mill a bone with a simulated hand");
  command
      ->add_option("volume", options->volume.source,
                   "file, DICOM folder, phantom:NAME, or a case (jaw, ... or a .toml file)")
      ->required();
  add_motion(command, options);
  auto* seconds = command
                      ->add_option("--seconds", options->seconds,
                                   "duration of a built-in motion (of step:ID: 240)")
                      ->check(CLI::Range(1.0, 36'000.0))
                      ->capture_default_str();
  add_tool_options(*command, options->tool);
  static_cast<void>(add_second_tool_option(*command, options->tool));
  add_second_options(*command, options->second);
  command->add_flag("--heat", options->heat,
                    "compute the temperature of the bone and the heat dose");
  add_setting_options(*command, options->given);
  command->get_option("--irrigation")->needs("--heat");
  add_hand(command, options);
  add_pieces(command, options);
  add_results(command, options);
  add_picture_size(*command, options->size);
  add_volume_options(*command, options->volume);
  command->callback([options, seconds, chosen] {
    options->seconds_given = !seconds->empty();
    // two tools feel each other where all their parts do
    if (!options->tool.second.empty() && !options->given.contains("touch"))
      options->given["touch"] = std::string("shaft");
    chosen(options);
  });
}

Status take_case(MillOptions& options) {
  if (names_a_case(options.volume.source)) {
    auto work = scenario::read_case(options.volume.source);
    if (!work) return work.error();
    if (const Status set = workshop::check_session(*work); !set) return set;
    const bool own_burr = !options.given.contains("burr_mm");
    options.volume = workshop::recipe_of(*work, options.volume);
    options.settings["burr_mm"] = scenario::burr_mm(*work);
    options.settings["rpm"] = scenario::rpm(*work);
    options.settings["diamond"] = own_burr && work->burr.kind == tool::BurrKind::diamond;
    if (options.tool.tool.empty() && own_burr) options.tool.tool = work->tool;
    if (options.at_mm.empty() && work->at)
      options.at_mm = {1e3 * work->at->x(), 1e3 * work->at->y(), 1e3 * work->at->z()};
    if (options.into.empty() && work->into)
      options.into = {work->into->x(), work->into->y(), work->into->z()};
    options.tool.own = work->own_tools;
    if (work->session)
      for (const scenario::CaseSettings::Field& field : work->session->fields)
        options.settings[field.word] = field.value;
    options.work_case = std::move(*work);
  }
  for (const auto& [word, value] : options.given) options.settings[word] = value;
  return fine();
}

Status set_session(const MillOptions& options, sim::SessionSettings& settings) {
  settings.realtime = options.realtime;
  if (const Status taken = take_tool(options.tool, settings.servo); !taken) return taken;
  if (const Status taken = tick::take_typed(options.settings, option_name, settings.servo); !taken)
    return taken;
  auto law = own_law(options.law, options.realtime);
  if (!law) return law.error();
  settings.law = std::move(*law);
  return fine();
}

}  // namespace burr::app
