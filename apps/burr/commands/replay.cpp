// burr replay - opens a recording: what happened, the bone at any moment, and whether a new
// simulation gives the same result.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "burr/base/printable.h"
#include "burr/render/bone_scene.h"
#include "burr/render/held_tool.h"
#include "burr/render/picture.h"
#include "burr/render/soft_scene.h"
#include "burr/sim/replay.h"
#include "burr/sim/session_words.h"
#include "burr/sound/synth.h"
#include "burr/sound/wav.h"
#include "burr/surface/worker.h"
#include "burr/workshop/opening.h"
#include "burr/workshop/out_piece.h"
#include "burr/workshop/piece_look.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "burr/workshop/second_tool.h"
#include "burr/workshop/seen.h"
#include "burr/workshop/sound_tracker.h"
#include "burr/workshop/spared.h"
#include "burr/workshop/spared_distance.h"
#include "burr/workshop/tool_looks.h"
#include "burr/workshop/traces.h"
#include "burr/workshop/work_view.h"
#include "shared/film_file.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/json_line.h"
#include "shared/law_options.h"
#include "shared/outputs.h"
#include "shared/picture_size.h"
#include "shared/subcommand.h"
#include "shared/views.h"
#include "window/shell/pages.h"

namespace burr::app {
namespace {

// "burr 5.00 mm", or "tool flame"
std::string tool_text(const tool::ToolState& tool, const record::SessionInfo& info) {
  if (tool.number < 0 || tool.number >= static_cast<int>(info.tools.size()))
    return fmt::format("burr {:.2f} mm", 2e3 * tool.radius);
  const std::string& name = info.tools[static_cast<std::size_t>(tool.number)].name;
  return "tool " + base::printable(name);
}

struct Options {
  std::string file, beside, picture, film, sound;
  ViewOptions view;
  scenario::BoneRecipe volume;
  PictureSize size;
  LawChoice law;
  double at = -1, fps = 25;
  double from = -1, until = -1;  // of the film; below 0: start, end
  bool effects = false;
  bool check = false, json = false, window = false;
  double seconds = 0;  // shown in the window
  std::string screenshot;
};

// Whether the picture is seen from where the session looked: the user asked for no other view.
bool as_seen(const Options& options) { return options.view.view.empty(); }

ViewOptions view_of(const Options& options, const record::Player& player) {
  ViewOptions view = options.view;
  const record::SessionInfo& info = player.info();
  if (info.work_case) {
    if (const auto work = record::case_of(info)) view.opening = workshop::opening_of(*work);
  } else {
    view.opening = workshop::opening_of_phantom(info.volume.recipe.source);
  }
  return view;
}

// The tool of a tick. That of a mouse, which has no orientation, is drawn as the window draws it.
void put_drawn_tool(render::Scene& scene, const record::Step& step, const record::Player& player,
                    bool contact, render::HeldTool& held, workshop::SecondTool& second,
                    double seconds) {
  const tick::TickRow& row = step.row;
  workshop::put_tool(scene, row, contact);
  second.put(scene, step.second ? &*step.second : nullptr, record::tool_of(player.info().second));
  if (row.tool.number >= 0) {  // its direction matters to what it cuts: drawn as it was held
    workshop::ToolLooks(player.info().tools).put(scene, row.tool.number);
    return;
  }
  const auto device = player.info().words.find("device");
  if (device == player.info().words.end() || device->second != "mouse") return;
  scene.burr.world_from_tool = held.at(scene, scene.burr.world_from_tool.p, false, seconds);
}

// A piece that was out of the bone.
Status put_piece(render::Scene& scene, const tick::TickRow& row, double t,
                 workshop::OutPieces& pieces, workshop::PieceLook& look, volume::Bone& bone) {
  const auto piece = pieces.at(row, t, bone);
  if (!piece) return piece.error();
  look.put(scene, piece->mesh, piece->by, bone.tissues().tissues.size());
  return fine();
}

// Draws the bone and the burr at one moment.
Status draw(const Options& options, record::Player& player) {
  auto bone = workshop::bone_of(player, options.volume, progress());
  if (!bone) return bone.error();
  const double t = options.at < 0 ? player.seconds() : options.at;
  Status there = player.bone_at(t, **bone);
  if (!there) return there;
  auto step = player.step_at(t);
  if (!step) return step.error();
  const tick::TickRow* tick = &step->row;

  const math::Vec3 shaft = tick->hand.world_from_tool.q * math::Vec3::UnitZ();
  render::Scene scene =
      workshop::scene_of_work(**bone, tick->tool.radius, tick->contact.proxy, shaft);
  const Status skinned = render::skin_bone(scene, **bone, 2, progress());
  if (!skinned) return skinned;
  const ViewOptions view = view_of(options, player);
  const std::vector<record::View> views =
      as_seen(options) ? player.views() : std::vector<record::View>();
  if (const record::View* seen = workshop::view_at(views, tick->tick))
    look_as_seen(scene, workshop::camera_of(*seen), view);
  render::HeldTool held;
  workshop::SecondTool second;
  put_drawn_tool(scene, *step, player, false, held, second, 0);
  workshop::OutPieces pieces(player);
  workshop::PieceLook look;
  if (const Status drawn = put_piece(scene, *tick, t, pieces, look, **bone); !drawn) return drawn;
  if (options.effects) {
    render::Wound wound((*bone)->grid().voxel, render::bleeding_of((*bone)->tissues()));
    workshop::Traces(player).until(t).show(wound);
    wound.stain_still(scene);
  }
  return draw_view(std::move(scene), **bone, tick->contact.proxy, -shaft, view, options.size,
                   options.picture);
}

Result<FilmPlan> plan_of(const Options& options, const record::Player& player) {
  FilmPlan plan;
  plan.from = std::max(0.0, options.from);
  plan.until = options.until < 0 ? player.seconds() : std::min(options.until, player.seconds());
  plan.fps = options.fps;
  plan.size = options.size;
  plan.one_file = is_film_file(options.film);
  if (plan.from >= plan.until && player.seconds() > 0)
    return error(Trouble::usage,
                 fmt::format("--from {} --until {}: a film must end after it begins; the recording "
                             "is {:.1f} s long",
                             plan.from, plan.until, player.seconds()));
  const Status possible = check_film(options.film, options.size);
  if (!possible) return possible.error();
  return plan;
}

// Draws the session as a film: from where the session looked, or, in another view, from the viewpoint
// of its end.
Status film(const Options& options, record::Player& player) {
  const auto plan = plan_of(options, player);
  if (!plan) return plan.error();
  if (!options.json) {
    fmt::print("{}: {:.1f} s, {} pictures of {} x {} pixels, {} a second, about {}\n", options.film,
               plan->seconds(), plan->frames(), plan->size.width, plan->size.height, plan->fps,
               in_megabytes(plan->bytes()));
    std::fflush(stdout);  // before the work
  }
  auto bone = workshop::bone_of(player, options.volume, progress());
  if (!bone) return bone.error();
  auto last = player.tick_at(player.seconds());
  if (!last) return last.error();
  const math::Vec3 shaft = last->hand.world_from_tool.q * math::Vec3::UnitZ();
  render::Scene scene =
      workshop::scene_of_work(**bone, last->tool.radius, last->contact.proxy, shaft);
  scene.tissue_colours = render::colours_of((*bone)->tissues());
  if (const Status soft = render::add_soft(scene, **bone, progress()); !soft) return soft;
  surface::Worker worker(**bone, 1);
  const auto show = [&scene](const surface::Skin& skin) {
    render::set_patch(scene, skin.patch, *skin.mesh);
  };
  const Status skinned = worker.first(progress(), show);
  if (!skinned) return skinned;
  const ViewOptions view = view_of(options, player);
  const Status possible = set_view(scene, last->contact.proxy, -shaft, view);
  if (!possible) return possible;
  const std::vector<record::View> views =
      as_seen(options) ? player.views() : std::vector<record::View>();
  render::HeldTool held;
  workshop::SecondTool second;
  workshop::OutPieces pieces(player);
  workshop::PieceLook look;
  auto reel = FilmFile::open(options.film, options.size, options.fps);
  if (!reel) return reel.error();
  render::Wound wound((*bone)->grid().voxel, render::bleeding_of((*bone)->tissues()));
  workshop::Traces traces(player);
  for (int n = 0; n < plan->frames(); ++n) {
    if (interrupted())
      return error(Trouble::interrupted, plan->one_file
                                             ? "stopped; no film was written"
                                             : "stopped; the pictures made so far are kept");
    progress().report(static_cast<double>(n) / plan->frames(), "filming");
    const double t = plan->moment(n);
    Status there = player.bone_at(t, **bone);
    if (!there) return there;
    worker.settle(show);
    if (options.effects) {
      traces.until(t).show(wound);
      wound.stain(scene);
    }
    auto step = player.step_at(t);
    if (!step) return step.error();
    if (const record::View* seen = workshop::view_at(views, step->row.tick))
      look_as_seen(scene, workshop::camera_of(*seen), view);
    put_drawn_tool(scene, *step, player, true, held, second, 1 / options.fps);
    if (const Status put = put_piece(scene, step->row, t, pieces, look, **bone); !put) return put;
    Status written = reel->frame(scene);
    if (!written) return written;
  }
  progress().report(1, "filming");
  const Status whole = reel->finish();
  if (!whole) return whole;
  if (!options.json) fmt::print("{}: written\n", options.film);
  return fine();
}

// Writes the sound of the whole session, each sample at the time of its tick.
Status sound_of(const Options& options, record::Player& player, const sim::Recorded& recorded) {
  sound::Synth synth, second({.seed = 2});
  auto file = sound::WavFile::create(options.sound, static_cast<int>(synth.settings().rate_hz));
  if (!file) return file.error();
  workshop::SparedDistance spared_distance;
  if (const workshop::Tissues spared = workshop::read_spared(player.info()); !spared.empty()) {
    auto bone = workshop::bone_of(player, options.volume, progress());
    if (bone) {
      auto measured = workshop::SparedDistance::make(**bone, spared, progress());
      if (!measured) return measured.error();
      spared_distance = std::move(*measured);
    } else if (interrupted()) {
      return bone.error();
    } else {
      fmt::print(stderr, "no warnings near structures to spare: {}\n",
                 in_options(bone.error()).text);
    }
  }
  const auto& other = player.info().second;
  workshop::SoundTracker tracker(recorded.settings.servo, spared_distance.distances(),
                                 other && !other->tools.empty() ? &other->tools.front() : nullptr);
  const double per_tick = synth.settings().rate_hz / player.info().rate_hz;
  std::vector<float> samples(4096);
  record::StepCursor steps = player.steps();
  record::Step step;
  while (steps.next(step)) {
    if (step.row.tick % 1024 == 0) {
      if (interrupted()) return error(Trouble::interrupted, "stopped; no sound was written");
      progress().report(static_cast<double>(step.row.tick) / static_cast<double>(player.end_tick()),
                        "computing the sound");
    }
    synth.update(tracker.update(step.row, step.second ? &*step.second : nullptr));
    if (tracker.second() != nullptr) second.update(*tracker.second());
    // up to the end of this tick; where rows are missing, the last sound continues
    const double end = static_cast<double>(step.row.tick + 1 - player.first_tick()) * per_tick;
    if (end > static_cast<double>(sound::WavFile::kMostSamples))
      return error(Trouble::data,
                   fmt::format("{}: is longer than a .wav can hold ({:.0f} h)", options.file,
                               static_cast<double>(sound::WavFile::kMostSamples) / 3600 /
                                   synth.settings().rate_hz));
    while (file->samples() < static_cast<std::uint64_t>(end)) {
      const auto left = static_cast<std::uint64_t>(end) - file->samples();
      const auto some = std::span(samples).first(std::min<std::uint64_t>(left, samples.size()));
      synth.make(some);
      if (tracker.second() != nullptr) second.mix(some);
      file->write(some);
    }
  }
  progress().report(1, "computing the sound");
  Status written = file->put_in_place();
  if (written && !options.json)
    fmt::print("{}: {:.3f} s of sound\n", options.sound,
               static_cast<double>(file->samples()) / synth.settings().rate_hz);
  return written;
}

// Plays it in a window; errors of the file are reported here, not on a page.
Status show(const Options& options) {
  auto desk = Desk::open(users_places());
  if (!desk) return desk.error();
  const auto left = watch_file(**desk, options.file, options.volume,
                               {.seconds = options.seconds,
                                .screenshot = options.screenshot,
                                .from = options.at,
                                .beside = options.beside});
  return left ? fine() : Status(left.error());
}

Status run(const Options& options) {
  const Status possible =
      check_outputs({options.file, options.beside, options.volume.source, options.volume.labels,
                     options.volume.materials},
                    {{"--picture", options.picture, {".png"}},
                     {"--film", is_film_file(options.film) ? options.film : "", {".mp4"}},
                     {"--sound", options.sound, {".wav"}},
                     {"--screenshot", options.screenshot, {".png"}}});
  if (!possible) return possible;
  if (options.window) return show(options);
  if (!options.beside.empty()) return error(Trouble::usage, "--beside needs --window");
  auto opened = record::Player::open(options.file);
  if (!opened) return opened.error();
  record::Player& player = **opened;
  print_notices(player.notices());
  auto recorded = sim::settings_of(player.info(), player.path());
  if (!recorded) return recorded.error();
  if (options.at > player.seconds())
    return error(Trouble::usage, fmt::format("--at {} is after the end; {} lasts {:.3f} s",
                                             options.at, options.file, player.seconds()));

  tool::ToolState first;
  first.radius = recorded->settings.servo.burr.radius;
  first.number = recorded->settings.servo.tool;
  std::string tool = tool_text(first, player.info());  // the last
  nlohmann::json out;
  std::uint64_t lost = 0;
  nlohmann::json holes = nlohmann::json::array();
  for (const record::Player::Hole& hole : player.holes()) {
    lost += hole.end - hole.first;
    holes.push_back({hole.first, hole.end});
  }
  out["ticks"] = player.end_tick() - player.first_tick() - lost;
  out["damaged_ticks"] = holes;
  out["seconds"] = player.seconds();
  out["finished"] = player.finished();
  if (player.end_tick() > player.first_tick()) {
    auto last = player.tick_at(player.seconds());
    if (!last) return last.error();
    out["removed_mm3"] = 1e9 * last->ledger.removed;
    out["asked_mm3"] = 1e9 * last->ledger.asked;
    tool = tool_text(last->tool, player.info());
  }
  if (!options.json)
    fmt::print("{:.3f} s, {} ticks{} at {} Hz, {}; removed {:.3f} mm3\n", player.seconds(),
               player.end_tick() - lost, lost > 0 ? fmt::format(" of {}", player.end_tick()) : "",
               player.info().rate_hz, tool, out.value("removed_mm3", 0.0));

  if (options.check) {
    const record::SessionInfo& info = player.info();
    if (!info.volume.recipe.materials.empty() && !info.embedded && options.volume.materials.empty())
      return error(
          Trouble::usage,
          fmt::format("{}: was made with a table of materials; give that table with --materials",
                      options.file));
    auto law = own_law(options.law, false);
    if (!law) return law.error();
    if (const Status same = sim::check_law(info, law->get(), options.file); !same) return same;
    if (const Status texts = player.check_texts(); !texts) return texts;
    auto bone = workshop::bone_of(player, options.volume, progress());
    if (!bone) return bone.error();
    auto outcome = sim::replay(player, std::move(*bone), progress(), nullptr, law->get());
    if (!outcome) return outcome.error();
    out["checked_ticks"] = outcome->ticks;
    out["checked_bricks"] = outcome->bricks;
    out["same"] = !outcome->first_different_tick && outcome->gaps == 0;
    out["bone_hash"] = record::hex(outcome->bone->content_hash());
    if (outcome->first_different_tick) out["parted_at"] = *outcome->first_different_tick;
    if (options.json) fmt::print("{}\n", json_line(out));
    if (outcome->first_different_tick)
      return error(
          fmt::format("{}: comes out differently at tick {} ({:.3f} s): {}; recorded by {}",
                      options.file, *outcome->first_different_tick,
                      static_cast<double>(*outcome->first_different_tick) / player.info().rate_hz,
                      outcome->difference, player.info().build));
    if (outcome->gaps > 0) return error(fmt::format("{}: {}", options.file, outcome->difference));
    if (!options.json)
      fmt::print("the same to the bit: {} ticks and {} bricks simulated again and compared\n",
                 outcome->ticks, outcome->bricks);
  } else if (options.json) {
    fmt::print("{}\n", json_line(out));
  }
  if (!options.picture.empty()) {
    Status drawn = draw(options, player);
    if (!drawn) return drawn;
  }
  if (!options.sound.empty()) {
    Status heard = sound_of(options, player, *recorded);
    if (!heard) return heard;
  }
  return options.film.empty() ? fine() : film(options, player);
}

void add(CLI::App& app, Todo& todo) {
  auto options = std::make_shared<Options>();
  auto* command = app.add_subcommand("replay",
                                     "open a recording: figures, pictures, film, sound, or a check "
                                     "that replay gives the same bits");
  command->add_option("recording", options->file, "F.mcap")->required();
  auto* check = command->add_flag("--check", options->check,
                                  "simulate it again and compare every tick and brick");
  add_law_options(*command, options->law)->needs(check);
  command->add_option("--picture", options->picture,
                      "F.png: picture of the bone and the burr (see --at)");
  command->add_option("--film", options->film,
                      "F.mp4: the session as a film, made by ffmpeg; or DIR: as numbered pictures");
  command->add_option("--from", options->from, "the film begins at this second")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--until", options->until, "the film ends at this second")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--sound", options->sound, "F.wav: the sound of the whole session");
  command->add_option("--fps", options->fps, "pictures of the film per second")
      ->check(CLI::Range(0.1, 240.0))
      ->capture_default_str();
  add_view_options(*command, options->view);
  command->add_flag("--effects", options->effects,
                    "picture and film show fresh bone, coolant, dust and blood");
  add_picture_size(*command, options->size);
  command->add_flag("--window", options->window,
                    "play it in a window: time line, bone, tool and force at any moment");
  command->add_option(
      "--beside", options->beside,
      "G.mcap: a second recording in the right half of the window, at the same moment");
  command->add_option("--seconds", options->seconds, "close the window after this many seconds")
      ->check(CLI::Range(0.1, 36'000.0));
  command->add_option("--screenshot", options->screenshot,
                      "PNG of the window when it closed, with panels");
  command->add_option("--at", options->at, "seconds from the start (default: the end)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--volume", options->volume.source,
                      "the scan it was made from, if burr does not find it");
  command->add_option("--series", options->volume.series,
                      "series of the DICOM folder, if the recording was made with --series");
  command->add_option("--tissues,--labels", options->volume.labels,
                      "TOML table of tissues, if the recording was made with --tissues");
  command->add_option("--materials", options->volume.materials,
                      "TOML table of materials, if the recording was made with --materials");
  command->add_flag("--json", options->json, "one JSON object on the last line");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{40, add};

}  // namespace
}  // namespace burr::app
