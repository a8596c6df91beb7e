#include "window/replay/playback.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <system_error>
#include <utility>

#include "burr/base/one_bar.h"
#include "burr/render/camera.h"
#include "burr/render/soft_scene.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/open_bone.h"
#include "burr/workshop/piece_look.h"
#include "burr/workshop/recorded_bone.h"
#include "burr/workshop/recording.h"
#include "shared/front_words.h"
#include "shared/word_names.h"
#include "window/parts/kept_sessions.h"

namespace burr::app {

namespace fs = std::filesystem;

bool is_recording(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".mcap";
}

Result<Recorded> open_recorded(const std::string& file, const fs::path& state,
                               const scenario::BoneRecipe& given, Progress& whole) {
  auto player = record::Player::open(file);
  if (!player) return player.error();
  Recorded out;
  out.player = std::move(*player);

  // a kept session has a title, and it says where its scan is
  scenario::BoneRecipe volume = given;
  out.title = fs::path(file).filename().string();
  std::error_code nobody_asks;
  for (const KeptSession& kept : kept_sessions(state)) {
    if (!fs::equivalent(kept.file, file, nobody_asks)) continue;
    out.title = shown_title(kept);
    if (given.source.empty() && !out.player->info().embedded &&
        fs::exists(kept.options.volume.source, nobody_asks) &&
        fs::path(kept.options.volume.source).extension() != ".toml")
      volume = kept.options.volume;
  }
  std::vector<base::OneBar::Step> steps =
      workshop::steps_to_bone(volume.source.empty() ? out.player->info().volume.recipe : volume);
  steps.push_back({{"reading what happened"}, 0.2});
  steps.push_back({{"making the surface"}, 0.2});
  base::OneBar progress(whole, std::move(steps));
  out.film.recording = file;
  out.film.volume = volume;
  out.film.plan.until = out.player->seconds();
  out.film.as_seen = !out.player->views().empty();
  auto watched = workshop::watch(*out.player, volume, progress);
  if (!watched) return watched.error();
  out.bone = std::move(watched->bone);
  out.settings = std::move(watched->settings);
  out.timeline = std::move(watched->timeline);
  out.notices = out.player->notices();

  out.scene.tissue_colours = render::colours_of(out.bone->tissues());
  out.scene.tissue_colours.push_back(workshop::PieceLook::kColour);
  if (const Status soft = render::add_soft(out.scene, *out.bone, progress); !soft)
    return soft.error();
  out.worker = std::make_unique<surface::Worker>(*out.bone, 1);
  const Status skinned = out.worker->first(
      progress, [&out](const surface::Skin& skin) { workshop::put_skin(out.scene, skin); });
  if (!skinned) return skinned.error();
  if (out.timeline.work) {
    const double height = std::clamp(30 * out.settings.settings.servo.burr.radius, 30e-3, 100e-3);
    out.scene.camera =
        render::view_of_work(out.timeline.work->at, out.timeline.work->outward, height);
    // the handpiece lies along this axis: look from farther aside
    constexpr double kAside = 0.5;  // [rad]
    if (std::abs(out.timeline.work->outward.z()) > 0.7)
      render::orbit(out.scene.camera, 0, -kAside);
    else
      render::orbit(out.scene.camera, kAside, 0);
    render::pan(out.scene.camera, 0, -0.1);  // the lower fifth is covered by the strip
  } else {
    out.scene.camera = render::whole_view(out.scene, 0.3, 0.4, 16.0 / 9);
  }
  return out;
}

// ---- the thread

Playback::Playback(Recorded& recorded)
    : player_(*recorded.player),
      bone_(*recorded.bone),
      traces_(player_),
      pieces_(player_),
      thread_([this] { work(); }) {}

Playback::~Playback() {
  const std::lock_guard lock(mutex_);
  end_ = true;
  wanted_changed_.notify_one();
}

void Playback::want(double t_s) {
  const std::lock_guard lock(mutex_);
  wanted_ = t_s;
  asked_ = true;
  wanted_changed_.notify_one();
}

bool Playback::take(Shown& shown) {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(fresh_, false)) return false;
  shown = newest_;
  return true;
}

bool Playback::take_early(Early& early) {
  const std::lock_guard lock(mutex_);
  if (!std::exchange(early_fresh_, false)) return false;
  early = early_;
  return true;
}

bool Playback::behind() const {
  const std::lock_guard lock(mutex_);
  return asked_ || working_;
}

void Playback::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wanted_changed_.wait(lock, [this] { return asked_ || end_; });
    if (end_) return;
    asked_ = false;
    working_ = true;
    Shown shown;
    shown.t = wanted_;
    lock.unlock();
    const auto step = player_.step_at(shown.t);
    if (step) {
      shown.row = step->row;
      shown.second = step->second;
      lock.lock();
      early_ = {shown.t, step->row};
      early_fresh_ = true;
      lock.unlock();
    }
    if (const Status there = player_.bone_at(shown.t, bone_); !there)
      shown.trouble = in_options(there.error()).text;
    else if (!step)
      shown.trouble = in_options(step.error()).text;
    else if (auto piece = pieces_.at(step->row, shown.t, bone_); piece)
      shown.piece = std::move(*piece);
    else
      shown.trouble = in_options(piece.error()).text;
    shown.changes = traces_.seek(shown.t);
    lock.lock();
    working_ = false;
    if (fresh_ && !shown.changes.anew) {  // the last result was not taken: keep its ticks, too
      workshop::Traces::Changes both = std::move(newest_.changes);
      both.append(shown.changes);
      shown.changes = std::move(both);
    }
    newest_ = std::move(shown);
    fresh_ = true;
  }
}

}  // namespace burr::app
