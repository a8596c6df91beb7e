// burr mill - a simulated hand mills a bone from a file or a formula; the result is measured,
// recorded and drawn.
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "batch/row_command.h"
#include "burr/device/simulated_hand.h"
#include "burr/importing/materials.h"
#include "burr/render/bone_scene.h"
#include "burr/render/picture.h"
#include "burr/report/piece_words.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/path_check.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/tick/mirror_plane.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/work_view.h"
#include "commands/mill_options.h"
#include "commands/mill_pieces.h"
#include "commands/mill_result.h"
#include "commands/mill_way.h"
#include "commands/second_options.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/outputs.h"
#include "shared/recorded_session.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using math::Vec3;

Status draw(const MillOptions& options, const surgeon::WorkPlace& place, sim::Session& session) {
  render::Scene scene =
      workshop::scene_of_work(session.bone(), 0.5e-3 * options.burr_mm(), place.at, -place.into);
  const Status skinned = render::skin_bone(scene, session.bone(), 2, progress());
  if (!skinned) return skinned;
  return render::render_png(scene, options.size.width, options.size.height, options.picture);
}

// Bone within 20 mm of the work: heat does not go further within minutes.
math::Aabb work_box(const volume::Bone& bone, const Vec3& at) {
  const volume::Grid& grid = bone.grid();
  math::Aabb box;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p((corner & 1) != 0 ? grid.size.x() - 1.0 : 0.0,
                 (corner & 2) != 0 ? grid.size.y() - 1.0 : 0.0,
                 (corner & 4) != 0 ? grid.size.z() - 1.0 : 0.0);
    box.extend(grid.world_from_grid(p));
  }
  constexpr double kAround = 20e-3;
  box.lo = box.lo.cwiseMax(at - Vec3::Constant(kAround));
  box.hi = box.hi.cwiseMin(at + Vec3::Constant(kAround));
  return box;
}

// The heat constants of each tissue, by its name, from the table of materials.
Result<thermal::HeatSettings> heat_settings(const MillOptions& options,
                                            const volume::TissueTable& tissues) {
  importing::Materials materials = importing::built_in_materials();
  if (!options.volume.materials.empty()) {
    auto read = importing::read_materials(options.volume.materials);
    if (!read) return read.error();
    materials = std::move(*read);
  }
  thermal::HeatSettings settings;
  for (std::size_t id = 1; id < tissues.tissues.size(); ++id) {
    const volume::Tissue& tissue = tissues.tissues[id];
    const importing::Material& material = materials.of(tissue.name, tissue.kind);
    if (!material.conductivity || !material.density || !material.specific_heat) continue;
    settings.special.push_back(
        {static_cast<volume::TissueId>(id),
         {material.conductivity->value, material.density->value, material.specific_heat->value}});
  }
  return settings;
}

// The volume, or the bone of the case; with its notices on stderr.
Result<importing::Imported> open_volume(MillOptions& options) {
  if (const Status taken = take_case(options); !taken) return taken.error();
  auto opened = workshop::open_bone(options.volume, progress());
  if (!opened) return opened.error();
  if (options.work_case) {
    const Status fits = scenario::check_tissues(*options.work_case, opened->bone->tissues());
    if (!fits) return fits.error();
    double burr_mm = options.burr_mm();
    workshop::fit_burr(burr_mm, opened->bone->grid().voxel, opened->summary.notices);
    options.settings["burr_mm"] = burr_mm;
  }
  print_notices(opened->summary.notices);
  return opened;
}

std::vector<report::MovedPiece> pieces_of(const MillOptions& options, const edit::PieceStore& store,
                                          const volume::Bone& bone) {
  if (!options.work_case || (options.move_pieces.empty() && options.carry_piece.empty()))
    return report::moved_pieces(store, bone);
  const auto lesson = workshop::placed_lesson(*options.work_case);
  return report::moved_pieces(store, bone, lesson ? &*lesson : nullptr);
}

device::ArmSettings arm_of(std::string_view grip) {
  device::ArmSettings arm;
  if (grip == "rigid") arm.stiffness = INFINITY;
  if (grip == "light") arm = {.mass = 0.06, .damping = 5, .stiffness = 200};
  return arm;
}

void add_to(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// given: takes the findings; nullptr: it is printed.
Status run(MillOptions options, CommandResult* given) {
  if (options.path_csv.empty() == options.motion_name.empty())
    return error(Trouble::usage,
                 fmt::format("give either --path FILE.csv or --motion NAME (one of {}; with a case "
                             "also step:ID)",
                             fmt::join(surgeon::motion_names(), ", ")));
  std::vector<sim::PieceOrder> orders;
  for (const std::string& text : options.move_pieces) {
    auto order = report::piece_order(text);
    if (!order) return error(order.error().trouble, "--move-piece " + order.error().text);
    orders.push_back(*order);
  }
  std::optional<Carry> carry;
  if (!options.carry_piece.empty()) {
    auto read = read_carry(options.carry_piece);
    if (!read) return read.error();
    carry = std::move(*read);
  }
  const Status possible = check_outputs(
      {options.volume.source, options.volume.labels, options.volume.materials, options.path_csv,
       options.second.path_csv, carry ? carry->file : std::string()},
      {{"--record", options.record, {".mcap"}}, {"--picture", options.picture, {".png"}}},
      options.force);
  if (!possible) return possible;
  auto opened = open_volume(options);
  if (!opened) return opened.error();

  surgeon::WorkPlace place;
  std::optional<StepCut> cut;
  auto path = hand_path(options, *opened->bone, place, cut);
  if (!path) return path.error();
  const bool own_motion = options.path_csv.empty() && !options.motion_name.starts_with(kStepMotion);
  const double seconds = own_motion ? options.seconds : path->duration();
  if (carry) carry_on(*path, *carry);
  if (!orders.empty() || carry) rest_at_end(*path);

  sim::SessionSettings settings;
  if (const Status set = set_session(options, settings); !set) return set;
  if (options.heat) {
    auto warming = heat_settings(options, opened->bone->tissues());
    if (!warming) return warming.error();
    settings.heat = sim::HeatRequest{work_box(*opened->bone, place.at), std::move(*warming)};
  }
  edit::Mirror mirror;
  if (!options.mirror.empty()) {
    auto plane = tick::mirror_in_words(options.mirror, opened->bone->grid());
    if (!plane) return error(plane.error().trouble, "--mirror: " + plane.error().text);
    mirror = *plane;
  }
  const sim::FollowedPath followed{
      *path, options.path_csv.empty() ? "--motion " + options.motion_name : options.path_csv};
  auto made = workshop::begin_by_itself(std::move(opened->bone), std::move(*path), settings,
                                        progress(), arm_of(options.arm));
  if (!made) return made.error();
  sim::Session& session = **made;
  if (mirror.on()) session.command(tick::command_for(mirror));
  std::optional<sim::FollowedPath> second;
  if (const Status joined = add_second_hand(options.second, options.tool, seconds, session, second);
      !joined)
    return joined;
  std::vector<std::string> doubts = sim::doubts_before(session, followed);
  if (second) add_to(doubts, sim::doubts_before(session, *second));
  print_notices(doubts);

  Recording recording;
  if (!options.record.empty()) {
    recording.remember_scan_in(users_scan_list());
    Status started = recording.start(
        session, options.record, options.volume, opened->summary,
        options.path_csv.empty() ? options.motion_name : "hand path", options.embed,
        options.work_case
            ? std::optional(workshop::to_spare(session.bone_tissues(), options.work_case->spare))
            : std::nullopt,
        options.work_case);
    if (!started) return started;
  }
  session.run(seconds, progress());
  add_to(doubts, sim::doubts_after(session, followed));
  if (second) add_to(doubts, sim::doubts_after(session, *second));
  edit::PieceStore store;
  // before a piece is put into the plane
  const std::optional<CutLeft> left = left_of(cut, session.bone());
  Status put = interrupted() ? fine() : move_pieces(orders, session, store);
  if (put.ok() && carry && !interrupted()) put = carry_piece(*carry, session, store);
  const Status recorded = options.record.empty() ? fine() : recording.finish(session);
  if (!options.picture.empty()) {
    Status drawn = draw(options, place, session);
    if (!drawn) return drawn;
  }
  if (left && !left->sentence.empty()) doubts.push_back(left->sentence);
  Besides besides{std::move(doubts), pieces_of(options, store, session.bone()), left};
  if (options.heat) static_cast<void>(session.heat(besides.heat));
  CommandResult findings = result_of(options, session, recording, besides);
  tell(options, session, besides, std::move(findings), given);
  if (!put) return put;
  if (!recorded) return recorded;
  if (interrupted()) return error(Trouble::interrupted, "stopped; the results so far are kept");
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  add_mill(app,
           [&todo](auto options) { todo.work = [options] { return run(*options, nullptr); }; });
}

void add_row(CLI::App& app, RowTodo& todo) {
  add_mill(app, [&todo](auto options) {
    todo.work = [options](CommandResult& findings) { return run(*options, &findings); };
    todo.memory_mb = [options]() -> Result<double> {
      MillOptions own = *options;
      const auto opened = open_volume(own);
      if (!opened) return opened.error();
      return memory_mb(opened->bone->grid().size.cast<double>().prod());
    };
  });
}

const Command command{30, add};
const RowCommand row_command{"mill", add_row};

}  // namespace
}  // namespace burr::app
