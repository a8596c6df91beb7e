#include "burr/dataset/dataset.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "burr/dataset/crossings.h"
#include "burr/dataset/eye.h"
#include "burr/dataset/layout.h"
#include "burr/dataset/pictures.h"

namespace burr::dataset {
namespace {

// The first tick of a sample. A rate that is no multiple of fps gives unequal steps, no drift.
std::uint64_t tick_of(std::uint64_t sample, double rate_hz, double fps) {
  // a hair less: 20 must not become 21 because a quotient was rounded up
  return static_cast<std::uint64_t>(std::ceil(static_cast<double>(sample) * rate_hz / fps - 1e-6));
}

std::uint64_t samples_in(const record::Player& player, double fps) {
  const std::uint64_t ticks = player.end_tick() - player.first_tick();
  const double rate = player.info().rate_hz;
  auto many = static_cast<std::uint64_t>(static_cast<double>(ticks) * fps / rate);
  while (tick_of(many, rate, fps) < ticks) ++many;
  while (many > 0 && tick_of(many - 1, rate, fps) >= ticks) --many;
  return many;
}

// Writes one recording: goes through its ticks, and begins a new file where the last one is full.
class Writer {
 public:
  Writer(record::Player& player, const volume::Bone& before, const Options& options, Eyes eyes,
         Crossings crossings)
      : player_(player),
        options_(options),
        eyes_(std::move(eyes)),
        crossings_(std::move(crossings)) {
    const record::SessionInfo& info = player.info();
    facts_ = {&before,          info.rate_hz,    eyes_.field_of_view(),
              eyes_.recorded(), crossings_.late, info.work_case ? info.work_case->name : ""};
  }

  Result<Written> write(const std::string& out, Progress& progress);

 private:
  [[nodiscard]] double time_of(std::uint64_t tick) const {
    return options_.begins + static_cast<double>(tick) / facts_.rate_hz;
  }
  // The sample that the first tick at or after its moment gives.
  [[nodiscard]] bool is_due(std::uint64_t tick) const {
    return tick - player_.first_tick() >= tick_of(sample_, facts_.rate_hz, options_.fps);
  }
  void cross_until(std::uint64_t tick);
  [[nodiscard]] volume::TissueId tissue_of(const sim::CrossedVoxel& voxel) const;
  Status next_file();
  Status sample(const record::Step& step, const math::Pose& camera);

  record::Player& player_;
  const Options& options_;
  Eyes eyes_;
  Crossings crossings_;
  Facts facts_;
  Written account_;
  std::vector<std::string> names_;
  std::unique_ptr<Layout> file_;
  std::unique_ptr<Pictures> pictures_;  // nullptr: none are wanted
  std::uint64_t sample_ = 0;            // the next
  std::size_t crossed_ = 0;             // of crossings_.voxels, those written
};

volume::TissueId Writer::tissue_of(const sim::CrossedVoxel& voxel) const {
  const volume::TissueId was = facts_.bone->tissue(voxel.i, voxel.j, voxel.k);
  return was != 0 ? was : crossings_.after->tissue(voxel.i, voxel.j, voxel.k);
}

void Writer::cross_until(std::uint64_t tick) {
  const std::vector<sim::CrossedVoxel>& all = crossings_.voxels;
  std::vector<CrossedLabel> out, in;
  while (crossed_ < all.size() && all[crossed_].tick <= tick) {
    const std::uint64_t now = all[crossed_].tick;
    out.clear();
    in.clear();
    for (; crossed_ < all.size() && all[crossed_].tick == now; ++crossed_) {
      const sim::CrossedVoxel& voxel = all[crossed_];
      (voxel.out ? out : in).push_back({{voxel.i, voxel.j, voxel.k}, tissue_of(voxel)});
    }
    if (!out.empty()) file_->removed(time_of(now), out);
    if (!in.empty()) file_->added(time_of(now), in);
    account_.removed += out.size();
    account_.added += in.size();
  }
}

Status Writer::next_file() {
  if (file_) {
    Status whole = file_->finish();
    if (!whole) return whole;
  }
  const std::string& name = names_[account_.files.size()];
  file_ = std::make_unique<Layout>(name, facts_, options_);
  account_.files.push_back(name);
  return fine();
}

Status Writer::sample(const record::Step& step, const math::Pose& camera) {
  const std::uint64_t tick = step.row.tick;
  ++account_.samples;
  if (!pictures_) {
    file_->sample(time_of(tick), step.row, camera, nullptr);
    return fine();
  }
  const auto drawn =
      pictures_->draw(static_cast<double>(tick) / facts_.rate_hz, step, eyes_.at(tick));
  if (!drawn) return drawn.error();
  file_->sample(time_of(tick), step.row, camera, &*drawn);
  return fine();
}

Result<Written> Writer::write(const std::string& out, Progress& progress) {
  names_ = files_of(player_, out, options_);
  account_.late = crossings_.late;
  if (options_.width > 0) {
    auto pictures = Pictures::make(player_, *facts_.bone, options_, facts_.field_of_view, progress);
    if (!pictures) return pictures.error();
    pictures_ = std::move(*pictures);
  }
  Status going = next_file();
  if (!going) return going.error();
  record::StepCursor steps = player_.steps();
  for (record::Step step; steps.next(step);) {
    const std::uint64_t tick = step.row.tick;
    const bool due = is_due(tick);
    const std::uint64_t full = account_.files.size() * options_.samples_per_file;
    if (due && options_.samples_per_file > 0 && sample_ >= full &&
        account_.files.size() < names_.size()) {
      if (tick > 0) cross_until(tick - 1);
      going = next_file();
      if (!going) return going.error();
    }
    const math::Pose camera = ambf_camera(eyes_.at(tick));
    file_->tick(time_of(tick), step.row, camera);
    cross_until(tick);
    ++account_.ticks;
    if (due) {
      going = sample(step, camera);
      if (!going) return going.error();
      while (is_due(tick)) ++sample_;
    }
    if (account_.ticks % 1024 == 0) {
      if (progress.cancelled())
        return error(Trouble::interrupted, "stopped; the file under way was not kept");
      progress.report(static_cast<double>(tick) / static_cast<double>(player_.end_tick()),
                      "writing the data set");
    }
  }
  cross_until(player_.end_tick());
  going = file_->finish();
  if (!going) return going.error();
  progress.report(1, "writing the data set");
  return std::move(account_);
}

}  // namespace

std::vector<std::string> files_of(const record::Player& player, const std::string& out,
                                  const Options& options) {
  const std::uint64_t samples = samples_in(player, options.fps), each = options.samples_per_file;
  if (each == 0 || samples <= each) return {out};
  const std::size_t dot = out.rfind('.');
  std::vector<std::string> names;
  for (std::uint64_t n = 1; n <= (samples + each - 1) / each; ++n)
    names.push_back(fmt::format("{}_{:05}{}", out.substr(0, dot), n, out.substr(dot)));
  return names;
}

Result<Written> write(record::Player& player, const volume::Bone& before, const std::string& out,
                      const Options& options, Progress& progress) {
  if (player.end_tick() == player.first_tick())
    return error(player.path() + ": this recording holds no tick");
  auto eyes = Eyes::of(player, before);
  if (!eyes) return eyes.error();
  auto crossings = crossings_of(player, before, progress);
  if (!crossings) return crossings.error();
  return Writer(player, before, options, std::move(*eyes), std::move(*crossings))
      .write(out, progress);
}

}  // namespace burr::dataset
