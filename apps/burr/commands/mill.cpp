// burr mill - a simulated hand mills a bone from a file or a formula; the result is measured,
// recorded and drawn.
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "batch/row_command.h"
#include "burr/base/printable.h"
#include "burr/device/simulated_hand.h"
#include "burr/importing/materials.h"
#include "burr/render/bone_scene.h"
#include "burr/render/picture.h"
#include "burr/report/piece_words.h"
#include "burr/sim/move_pieces.h"
#include "burr/sim/session.h"
#include "burr/surgeon/motion.h"
#include "burr/surgeon/path_check.h"
#include "burr/surgeon/plane_cut.h"
#include "burr/tick/flag_words.h"
#include "burr/tick/mirror_plane.h"
#include "burr/workshop/case_session.h"
#include "burr/workshop/label_check.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/prepare.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/work_view.h"
#include "commands/second_options.h"
#include "shared/command.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/law_options.h"
#include "shared/outputs.h"
#include "shared/picture_size.h"
#include "shared/recording.h"
#include "shared/tool_options.h"
#include "shared/volume_words.h"
#include "shared/work.h"

namespace burr::app {
namespace {

using math::Vec3;

struct Options {
  scenario::Recipe volume;
  PictureSize size;
  std::string path_csv, motion_name, record, picture, arm = "firm", touch = "constraint",
                                                      removal = "energy", mirror;
  ToolOptions tool;
  SecondOptions second;
  LawChoice law;
  std::string carry_piece;
  std::vector<double> at_mm, into;
  std::vector<std::string> move_pieces;
  double burr_mm = 5, rpm = 40000, rate_hz = 1000, seconds = 10, stiffness = 1000;
  std::size_t undo_bricks = tick::ServoSettings{}.undo_bricks;
  edit::RemovalSettings removing;
  double vibration = 0, torque_mnm = 1e3 * tool::Motor{}.torque, drag = 1;
  int teeth = tool::Burr{}.teeth;
  bool guarded = false, heat = false, irrigated = false;
  bool realtime = false, embed = false, json = false, diamond = false, force = false;
  bool burr_given = false, rpm_given = false, seconds_given = false;
  std::set<std::string> given;              // names of the options on the command line
  std::optional<scenario::Case> work_case;  // if the volume is one
};

constexpr std::string_view kStepMotion = "step:";
constexpr double kStepSeconds = 240;  // of a cut along a plane, if nobody says how long

// What [session] of the case says, unless the options do.
Status take_session(Options& options, const scenario::Case& work) {
  if (!work.session) return fine();
  tick::ServoSettings tried;
  if (const Status set = workshop::take_session(work, tried); !set) return set;
  const scenario::SessionWish& wish = *work.session;
  const auto open = [&](const char* option) { return !options.given.contains(option); };
  if (!wish.touch.empty() && open("--touch")) options.touch = wish.touch;
  if (!wish.removal.empty() && open("--removal")) options.removal = wish.removal;
  if (wish.rate_hz && open("--rate")) options.rate_hz = *wish.rate_hz;
  if (wish.stiffness_n_per_m && open("--stiffness")) options.stiffness = *wish.stiffness_n_per_m;
  if (wish.drag && open("--drag")) options.drag = *wish.drag;
  if (wish.vibration && open("--vibration")) options.vibration = *wish.vibration;
  if (wish.torque_mnm && open("--torque-mnm")) options.torque_mnm = *wish.torque_mnm;
  if (wish.teeth && open("--teeth")) options.teeth = static_cast<int>(*wish.teeth);
  if (wish.undo_bricks && open("--undo-bricks"))
    options.undo_bricks = static_cast<std::size_t>(*wish.undo_bricks);
  if (wish.guard && open("--guard")) options.guarded = *wish.guard;
  if (wish.irrigation && open("--irrigation")) options.irrigated = *wish.irrigation;
  return fine();
}

// A case says what is milled and, unless the options do, with which burr, where, and which way in.
Status take_case(Options& options) {
  if (!names_a_case(options.volume.source)) return fine();
  auto work = scenario::read_case(options.volume.source);
  if (!work) return work.error();
  options.volume = workshop::recipe_of(*work, options.volume);
  if (!options.burr_given) options.burr_mm = scenario::burr_mm(*work);
  if (!options.rpm_given) options.rpm = scenario::rpm(*work);
  options.diamond =
      options.diamond || (!options.burr_given && work->burr.kind == tool::BurrKind::diamond);
  if (options.tool.tool.empty() && !options.burr_given) options.tool.tool = work->tool;
  if (options.at_mm.empty() && work->at)
    options.at_mm = {1e3 * work->at->x(), 1e3 * work->at->y(), 1e3 * work->at->z()};
  if (options.into.empty() && work->into)
    options.into = {work->into->x(), work->into->y(), work->into->z()};
  options.tool.own = work->own_tools;
  if (const Status set = take_session(options, *work); !set) return set;
  options.work_case = std::move(*work);
  return fine();
}

// A cut along a plane: through what it should go.
struct StepCut {
  surgeon::CutPlane plane;
  double area = 0,
         seconds = 0;  // of bone in the plane before the cut [m^2]; the duration asked for
};

// The cut along the plane of a step of the case.
Result<device::HandPath> step_path(const Options& options, const volume::Bone& bone,
                                   surgeon::WorkPlace& place, std::optional<StepCut>& cut) {
  if (!options.work_case)
    return error(
        Trouble::usage,
        fmt::format("--motion {}: only a case has steps; name a case in place of \"{}\"",
                    base::printable(options.motion_name), base::printable(options.volume.source)));
  const auto lesson = workshop::placed_lesson(*options.work_case);
  if (!lesson) return lesson.error();
  const auto plane = surgeon::plane_of(*lesson, options.motion_name.substr(kStepMotion.size()));
  if (!plane) return plane.error();
  const auto tool = named_tool(options.tool);
  if (!tool) return tool.error();
  const surgeon::Blade blade =
      *tool ? surgeon::blade_of((*tool)->tool, (*tool)->cutter, (*tool)->lean)
            : surgeon::round_blade(0.5e-3 * options.burr_mm);
  const double seconds = options.seconds_given ? options.seconds : kStepSeconds;
  auto path = surgeon::cut_along(bone, *plane, blade, seconds);
  cut = {*plane, surgeon::bone_in_plane(bone, *plane), seconds};
  if (path) place = {path->points.front().world_from_tool.p, -plane->out};
  return path;
}

Result<device::HandPath> hand_path(const Options& options, const volume::Bone& bone,
                                   surgeon::WorkPlace& place, std::optional<StepCut>& cut) {
  if (options.motion_name.starts_with(kStepMotion)) return step_path(options, bone, place, cut);
  std::optional<Vec3> at, into;
  if (!options.at_mm.empty())
    at = Vec3(options.at_mm[0], options.at_mm[1], options.at_mm[2]) * 1e-3;
  if (!options.into.empty()) into = Vec3(options.into[0], options.into[1], options.into[2]);
  auto found = surgeon::find_work_place(bone, 0.5e-3 * options.burr_mm, at, into);
  if (!options.path_csv.empty()) {
    auto path = surgeon::read_path(options.path_csv);
    if (path && found) place = *found;
    if (path && !found) place.at = path->points.front().world_from_tool.p;
    return path;
  }
  if (!found) return found.error();
  place = *found;
  return surgeon::motion(options.motion_name, place, 0.5e-3 * options.burr_mm, options.seconds);
}

Status draw(const Options& options, const surgeon::WorkPlace& place, sim::Session& session) {
  render::Scene scene =
      workshop::scene_of_work(session.bone(), 0.5e-3 * options.burr_mm, place.at, -place.into);
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
Result<thermal::HeatSettings> heat_settings(const Options& options,
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

void print_heat(const sim::Session& session, const thermal::HeatSummary& heat, std::uint64_t lost) {
  const thermal::HeatLedger& ledger = heat.ledger;
  fmt::print(
      "heat: {:.2f} J of the burr's {:.2f} J stayed in the bone; {:.2f} J to the coolant; "
      "warmest now {:.1f} deg C\n",
      ledger.into, ledger.spent, ledger.convected, heat.hottest_c);
  for (std::size_t id = 1; id < heat.tissue.size(); ++id) {
    const thermal::TissueHeat& one = heat.tissue[id];
    if (!one.there) continue;
    fmt::print(
        "  {}: {:.1f} deg C at the most, dose {:.3g} CEM43 min, {:.2f} mm3 above 47 deg C "
        "now\n",
        session.bone_tissues()[static_cast<volume::TissueId>(id)].name, one.ever_c, one.cem43_min,
        1e9 * one.warm_m3);
  }
  if (lost > 0)
    fmt::print(
        "  {} rows of heat were lost because this machine is too slow: the bone was warmer than "
        "shown\n",
        lost);
}

nlohmann::json heat_json(const sim::Session& session, const thermal::HeatSummary& heat,
                         std::uint64_t lost) {
  nlohmann::json tissues = nlohmann::json::array();
  for (std::size_t id = 1; id < heat.tissue.size(); ++id) {
    const thermal::TissueHeat& one = heat.tissue[id];
    if (!one.there) continue;
    tissues.push_back({{"tissue", session.bone_tissues()[static_cast<volume::TissueId>(id)].name},
                       {"now_c", one.now_c},
                       {"ever_c", one.ever_c},
                       {"cem43_min", one.cem43_min},
                       {"warm_mm3", 1e9 * one.warm_m3}});
  }
  return {{"hottest_c", heat.hottest_c},
          {"spent_J", heat.ledger.spent},
          {"into_bone_J", heat.ledger.into},
          {"to_coolant_J", heat.ledger.convected},
          {"rows_lost", lost},
          {"tissues", tissues}};
}

// Is the cut through? A sentence if not, and how much of the bone in the plane is left, 0 to 1.
struct CutLeft {
  double share = 0, needs_s = 0;  // needs_s: 0: it is through
  std::string sentence;
};
std::optional<CutLeft> left_of(const std::optional<StepCut>& cut, const volume::Bone& bone) {
  if (!cut || cut->area <= 0) return std::nullopt;
  CutLeft left;
  left.share = std::min(1.0, surgeon::bone_in_plane(bone, cut->plane) / cut->area);
  if (left.share <= 0) return left;
  left.needs_s = surgeon::seconds_needed(cut->seconds, left.share);
  left.sentence = fmt::format(
      "{:.1f} % of the bone in the plane is left: this tool needs more than {:.0f} s, "
      "try --seconds {:.0f}",
      100 * left.share, cut->seconds, left.needs_s);
  return left;
}

// One after the other, while the hand rests where the motion ended.
Status move_pieces(const std::vector<sim::PieceOrder>& orders, sim::Session& session,
                   edit::PieceStore& store) {
  for (const sim::PieceOrder& order : orders) {
    const auto moved = sim::move_piece(session, store, order, progress());
    if (!moved) return moved.error();
  }
  return fine();
}

constexpr double kLiftTime = 10;  // in which a piece is out of the bone  [s]

// A path that carries a piece, from the place where the hand is when its motion is over.
struct Carry {
  math::Vec3 near = math::Vec3::Zero();  // of the piece
  std::string file;
  device::HandPath path;
};
Result<Carry> read_carry(const std::string& text) {
  const std::size_t colon = text.find(':');
  Carry carry;
  if (colon == std::string::npos || !report::point_of(text.substr(0, colon), carry.near))
    return error(Trouble::usage,
                 fmt::format("--carry-piece {}: give X,Y,Z:FILE.csv (mm), for example "
                             "10,0,5:carry.csv",
                             base::printable(text)));
  carry.file = text.substr(colon + 1);
  auto path = surgeon::read_path(carry.file);
  if (!path) return path.error();
  carry.path = std::move(*path);
  return carry;
}

// The hand waits with an open grip while the piece is lifted, then goes as the path says.
void carry_on(device::HandPath& path, const Carry& carry) {
  device::PathPoint last = path.points.back();
  last.pedal = 0;
  last.t += 1e-3;
  path.points.push_back(last);
  const double begins = last.t + kLiftTime;
  for (const device::PathPoint& point : carry.path.points) {
    device::PathPoint to = point;
    to.t += begins - carry.path.points.front().t;
    to.world_from_tool.p += last.world_from_tool.p - carry.path.points.front().world_from_tool.p;
    path.points.push_back(to);
  }
}

Status carry(const Carry& carry, sim::Session& session, edit::PieceStore& store) {
  const double began = session.outcome().seconds;
  const auto lifted = sim::lift_piece(session, store, carry.near, progress());
  if (!lifted) return lifted.error();
  const double rest = kLiftTime - (session.outcome().seconds - began);
  if (rest < 0) return error(Trouble::internal, "the piece was not lifted in time");
  session.run(rest + carry.path.duration() - carry.path.points.front().t, progress());
  if (interrupted()) return error(Trouble::interrupted, "stopped while a piece was carried");
  const auto put = sim::put_down(session, store, *lifted, progress());
  return put ? fine() : Status(put.error());
}

// The bone keeps the piece, also where it cannot be put down.
Status carry_piece(const Carry& way, sim::Session& session, edit::PieceStore& store) {
  const Status carried = carry(way, session, store);
  if (carried.ok()) return carried;
  const auto left = sim::leave_piece(session);
  if (!left) return left.error();
  if (!*left) return carried;
  return error(carried.error().trouble,
               fmt::format("{}; it was put back to where it lay", carried.error().text));
}

// The hand stays where the path ends, with the spindle off.
void rest_at_end(device::HandPath& path) {
  constexpr double kAtOnce = 1e-3, kLong = 24 * 3600;  // [s]
  device::PathPoint last = path.points.back();
  last.pedal = 0;
  for (const double wait : {kAtOnce, kLong}) {
    last.t = path.points.back().t + wait;
    path.points.push_back(last);
  }
}

struct Told {
  std::vector<std::string> doubts;
  std::vector<report::MovedPiece> pieces;  // that were moved
  std::optional<CutLeft> left;             // of a cut along a plane
  thermal::HeatSummary heat = {};
};

void print(const Options& options, sim::Session& session, const Told& told) {
  const sim::Outcome outcome = session.outcome();
  const rt::TickSummary& t = outcome.timing;
  fmt::print(
      "{:.2f} s, {} ticks: removed {:.3f} mm3 of {:.3f} mm3 asked; force {:.2f} N mean in "
      "contact, {:.2f} N peak\n",
      outcome.seconds, outcome.ticks, 1e9 * outcome.ledger.removed, 1e9 * outcome.ledger.asked,
      outcome.mean_force, outcome.peak_force);
  fmt::print("tick {:.1f} us median, {:.1f} p99, {:.1f} p99.9, {:.1f} worst (thread CPU){}\n",
             t.p50_us, t.p99_us, t.p999_us, t.max_us,
             options.realtime
                 ? fmt::format("; {} late, {} missed; {}", t.late, t.missed, outcome.scheduling)
                 : "");
  if (outcome.most_shed != tick::Shed::none)
    fmt::print("put off at times because this machine is too slow: {}\n",
               tick::name(outcome.most_shed));
  if (options.heat) print_heat(session, told.heat, outcome.heat_rows_lost);
  for (const std::string& line : report::pieces_text(told.pieces)) fmt::print("{}\n", line);
  for (const std::string& doubt : told.doubts) fmt::print("noted: {}\n", doubt);
  for (const std::string& sentence : tick::words(tick::worth_telling(outcome.flags)))
    fmt::print("noted: {}\n", sentence);
}

Account account_of(const Options& options, sim::Session& session, const Recording& recording,
                   const Told& told) {
  const sim::Outcome outcome = session.outcome();
  const rt::TickSummary& t = outcome.timing;
  Account account;
  nlohmann::json &out = account.result, &times = account.times;
  out["finished"] = !interrupted();
  out["ticks"] = outcome.ticks;
  out["seconds"] = outcome.seconds;
  out["removed_mm3"] = 1e9 * outcome.ledger.removed;
  out["asked_mm3"] = 1e9 * outcome.ledger.asked;
  out["not_cut_mm3"] = 1e9 * outcome.ledger.not_cut;
  out["owed_mm3"] = 1e9 * outcome.ledger.debt;
  if (!options.move_pieces.empty() || !options.carry_piece.empty()) {
    out["moved_loss_mm3"] = 1e9 * outcome.ledger.moved;
    out["pieces"] = nlohmann::json::parse(report::pieces_json(told.pieces));
  }
  if (told.left) {
    out["plane_left"] = told.left->share;
    out["plane_needs_s"] = told.left->needs_s;
  }
  out["peak_force_N"] = outcome.peak_force;
  out["mean_force_N"] = outcome.mean_force;
  times["tick_us"] = {{"p50", t.p50_us}, {"p99", t.p99_us}, {"p999", t.p999_us}, {"max", t.max_us}};
  out["rate_hz"] = options.rate_hz;
  out["realtime"] = options.realtime;
  times["late_us"] = {{"p50", t.late_p50_us},
                      {"p99", t.late_p99_us},
                      {"p999", t.late_p999_us},
                      {"max", t.worst_lateness_us}};
  times["late"] = t.late;
  times["missed"] = t.missed;
  times["worst_lateness_us"] = t.worst_lateness_us;
  out["bone_hash"] = record::hex(session.bone().content_hash());
  std::vector<std::string> noted = told.doubts;
  for (const std::string& sentence : tick::words(tick::worth_telling(outcome.flags)))
    noted.push_back(sentence);
  out["noted"] = noted;
  times["load_ticks"] = outcome.shed_ticks;
  if (options.heat) out["heat"] = heat_json(session, told.heat, outcome.heat_rows_lost);
  if (options.realtime) times["scheduling"] = outcome.scheduling;
  if (!options.record.empty()) times["recording"] = recording.account();
  return account;
}

// given: takes the account; nullptr: it is printed.
void tell(const Options& options, sim::Session& session, const Told& told, Account account,
          Account* given) {
  if (given != nullptr)
    *given = std::move(account);
  else if (options.json)
    fmt::print("{}\n", json_line(account.whole()));
  else
    print(options, session, told);
}

// The volume, or the bone of the case; with its notices on stderr.
Result<importing::Imported> open_volume(Options& options) {
  if (const Status taken = take_case(options); !taken) return taken.error();
  auto opened = workshop::open_bone(options.volume, progress());
  if (!opened) return opened.error();
  if (options.work_case) {
    const Status fits = scenario::check_tissues(*options.work_case, opened->bone->tissues());
    if (!fits) return fits.error();
    workshop::fit_burr(options.burr_mm, opened->bone->grid().voxel, opened->summary.notices);
  }
  for (const std::string& notice : opened->summary.notices) fmt::print(stderr, "{}\n", notice);
  return opened;
}

std::vector<report::MovedPiece> pieces_of(const Options& options, const edit::PieceStore& store,
                                          const volume::Bone& bone) {
  if (!options.work_case || (options.move_pieces.empty() && options.carry_piece.empty()))
    return report::moved_pieces(store, bone);
  const auto lesson = workshop::placed_lesson(*options.work_case);
  return report::moved_pieces(store, bone, lesson ? &*lesson : nullptr);
}

void set_servo(const Options& options, tick::ServoSettings& servo) {
  servo.rate_hz = options.rate_hz;
  servo.touch = *haptics::method_named(options.touch);
  servo.removal = options.removing;
  servo.removal.law = *edit::law_named(options.removal);
  servo.guarded = options.guarded;
  servo.vibration_gain = options.vibration;
  servo.burr.radius = 0.5e-3 * options.burr_mm;
  servo.burr.kind = options.diamond ? tool::BurrKind::diamond : tool::BurrKind::cutting;
  servo.spindle_rad_s = options.rpm * 2 * std::numbers::pi / 60;
  servo.motor.torque = 1e-3 * options.torque_mnm;
  servo.burr.teeth = options.teeth;
  servo.drag_gain = options.drag;
  servo.force.stiffness = options.stiffness;
  servo.undo_bricks = options.undo_bricks;
  servo.irrigated = options.irrigated;
}

Status set_session(const Options& options, sim::SessionSettings& settings) {
  settings.realtime = options.realtime;
  if (const Status taken = take_tool(options.tool, settings.servo); !taken) return taken;
  set_servo(options, settings.servo);
  auto law = own_law(options.law, options.realtime);
  if (!law) return law.error();
  settings.law = std::move(*law);
  return fine();
}

device::ArmSettings arm_of(std::string_view grip) {
  device::ArmSettings arm;
  if (grip == "rigid") arm.stiffness = INFINITY;
  if (grip == "light") arm = {.mass = 0.06, .damping = 5, .stiffness = 200};
  return arm;
}

// given: takes the account; nullptr: it is printed.
Status run(Options options, Account* given) {
  if (options.path_csv.empty() == options.motion_name.empty())
    return error(Trouble::usage,
                 fmt::format("give either --path FILE.csv or --motion NAME (one of {}; with a case "
                             "also step:ID)",
                             fmt::join(surgeon::motion_names(), ", ")));
  std::vector<sim::PieceOrder> orders;
  for (const std::string& text : options.move_pieces) {
    auto order = report::piece_order(text);
    if (!order) return order.error();
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
  std::vector<std::string> doubts;
  if (!options.path_csv.empty())
    doubts = surgeon::doubts(*path, *opened->bone, 0.5e-3 * options.burr_mm, options.path_csv);
  for (const std::string& doubt : doubts) fmt::print(stderr, "{}\n", doubt);

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
    if (!plane) return plane.error();
    mirror = *plane;
  }
  auto made = workshop::begin_by_itself(std::move(opened->bone), std::move(*path), settings,
                                        progress(), arm_of(options.arm));
  if (!made) return made.error();
  sim::Session& session = **made;
  if (mirror.on()) session.command(tick::command_for(mirror));
  if (const Status joined = add_second_hand(options.second, options.tool, seconds, session);
      !joined)
    return joined;

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
  Told told{std::move(doubts), pieces_of(options, store, session.bone()), left};
  if (options.heat) static_cast<void>(session.heat(told.heat));
  Account account = account_of(options, session, recording, told);
  tell(options, session, told, std::move(account), given);
  if (!put) return put;
  if (!recorded) return recorded;
  if (interrupted()) return error(Trouble::interrupted, "stopped; the results so far are kept");
  return fine();
}

void add_pieces(CLI::App* command, const std::shared_ptr<Options>& options) {
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

void add_results(CLI::App* command, const std::shared_ptr<Options>& options) {
  command->add_flag("--realtime", options->realtime,
                    "run at the speed of the clock (default: as fast as possible)");
  command->add_option("--record", options->record, "F.mcap: record the session");
  command->add_flag("--embed", options->embed, "with --record: store the bone in the file");
  command->add_option("--picture", options->picture, "F.png: picture of the bone afterwards");
  add_force(*command, options->force);
  add_law_options(*command, options->law);
  command
      ->add_option("--undo-bricks", options->undo_bricks, "memory for undo: bricks of 8^3 voxels")
      ->capture_default_str();
  command
      ->add_option("--reserve-bricks", options->volume.reserve_bricks,
                   "memory for added material: bricks of 8^3 voxels")
      ->capture_default_str();
  command->add_flag("--json", options->json, "one JSON object on the last line");
}

void add_motion(CLI::App* command, const std::shared_ptr<Options>& options) {
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

// chosen: gets the options when they were parsed.
void add_mill(CLI::App& app, const std::function<void(std::shared_ptr<const Options>)>& chosen) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("mill", "mill a bone with a simulated hand");
  command
      ->add_option("volume", options->volume.source,
                   "file, DICOM folder, phantom:NAME, or a case (jaw, ... or a .toml file)")
      ->required();
  add_motion(command, options);
  auto* burr = command
                   ->add_option("--burr-mm", options->burr_mm,
                                "diameter of the burr, 0.6 to 7 (with a case: that of the case)")
                   ->capture_default_str();
  add_tool_options(*command, options->tool);
  static_cast<void>(add_second_tool_option(*command, options->tool));
  add_second_options(*command, options->second);
  command->add_flag("--diamond", options->diamond, "diamond burr: a quarter of the removal rate");
  auto* rpm =
      command->add_option("--rpm", options->rpm, "speed of the spindle; below 0 it turns backwards")
          ->check(CLI::Range(-400000.0, 400000.0))
          ->capture_default_str();
  command
      ->add_option("--torque-mnm", options->torque_mnm,
                   "largest torque of the spindle [mN m]; 0: unlimited")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  command->add_option("--teeth", options->teeth, "cutting edges of the burr, for --removal chips")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command
      ->add_option(
          "--drag", options->drag,
          "gain of the force with which the bone pulls a turning burr along its surface; 0: none")
      ->check(CLI::Range(0.0, 10.0))
      ->capture_default_str();
  command->add_option("--rate", options->rate_hz, "ticks a second, 500 to 10000")
      ->capture_default_str();
  auto* seconds = command
                      ->add_option("--seconds", options->seconds,
                                   "duration of a built-in motion (of step:ID: 240)")
                      ->check(CLI::Range(1.0, 36'000.0))
                      ->capture_default_str();
  command
      ->add_option("--stiffness", options->stiffness,
                   "stiffness of the spring to the hand [N/m], limited by the device")
      ->capture_default_str();
  command->add_option("--arm", options->arm, "grip of the simulated hand: firm, light or rigid")
      ->check(CLI::IsMember({"firm", "light", "rigid"}))
      ->capture_default_str();
  auto* touch = command->add_option(
      "--touch", options->touch,
      "method of touch: constraint (burr's own), shaft (the burr's shaft touches too), or "
      "another for comparison");
  touch->check(CLI::IsMember(haptics::kMethodNames))->capture_default_str();
  command->add_option("--removal", options->removal, "law of removal")
      ->check(CLI::IsMember(edit::kLawNames))
      ->capture_default_str();
  command
      ->add_option("--thesis-rate", options->removing.thesis_rate,
                   "with --removal thesis: loss of a voxel's density, of which 1 is solid [1/s]")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  command
      ->add_option("--thesis-frame", options->removing.thesis_frame_ticks,
                   "with --removal thesis: remove bone every so many ticks; the thesis' own "
                   "picture loop: 33")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command
      ->add_option("--vibration", options->vibration,
                   "gain of the spindle's vibration in the hand; 0: none, 1: as designed")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  command->add_option("--mirror", options->mirror,
                      "sagittal, coronal or axial[,MM]: everything done on one side of a plane is "
                      "also done on the other; the plane goes through the middle of the volume, or "
                      "MM to the left of, behind or above it");
  add_pieces(command, options);
  command->add_flag("--guard", options->guarded,
                    "energy guard: the hand never gets back more energy than it gave");
  command->add_flag("--heat", options->heat,
                    "compute the temperature of the bone and the heat dose");
  command->add_flag("--irrigation", options->irrigated, "coolant runs over the burr")
      ->needs("--heat");
  add_results(command, options);
  add_picture_size(*command, options->size);
  add_volume_options(*command, options->volume);
  command->callback([options, command, touch, burr, rpm, seconds, chosen] {
    for (const CLI::Option* option : command->get_options())
      if (!option->empty()) options->given.insert(option->get_name());
    options->burr_given = !burr->empty();
    options->rpm_given = !rpm->empty();
    options->seconds_given = !seconds->empty();
    // two tools feel each other where all their parts do
    if (!options->tool.second.empty() && touch->empty()) {
      options->touch = "shaft";
      options->given.insert("--touch");
    }
    chosen(options);
  });
}

void add(CLI::App& app, Todo& todo) {
  add_mill(app,
           [&todo](auto options) { todo.work = [options] { return run(*options, nullptr); }; });
}

void add_row(CLI::App& app, RowTodo& todo) {
  add_mill(app, [&todo](auto options) {
    todo.work = [options](Account& account) { return run(*options, &account); };
    todo.memory_mb = [options]() -> Result<double> {
      Options own = *options;
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
