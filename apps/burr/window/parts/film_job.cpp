#include "window/parts/film_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "shared/helper_process.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr auto kLook = std::chrono::milliseconds(100);
constexpr auto kPatience = std::chrono::seconds(20);  // to end the current picture, when stopped

fs::path picture(const fs::path& folder, int number) {  // the names of render::Film
  return folder / fmt::format("frame_{:06d}.png", number);
}

// What the process says while it works: "filming 12 %".
double share_in(const std::string& line) {
  int percent = 0;
  return std::sscanf(line.c_str(), "filming %d %%", &percent) == 1 ? percent / 100.0 : -1;
}

std::vector<std::string> command_of(const FilmSource& source, const std::string& path) {
  const FilmPlan& plan = source.plan;
  std::vector<std::string> words = {
      burr_itself(), "--percent", "replay", source.recording,
      "--film",      path,        "--fps",  fmt::format("{}", plan.fps)};
  words.insert(words.end(),
               {"--picture-size", fmt::format("{},{}", plan.size.width, plan.size.height)});
  if (plan.from > 0) words.insert(words.end(), {"--from", fmt::format("{}", plan.from)});
  if (plan.until > plan.from) words.insert(words.end(), {"--until", fmt::format("{}", plan.until)});
  const auto add = [&words](const char* option, const std::string& value) {
    if (value.empty()) return;
    words.emplace_back(option);
    words.push_back(value);
  };
  if (source.effects) words.emplace_back("--effects");
  add("--volume", source.volume.source);
  add("--series", source.volume.series);
  add("--tissues", source.volume.labels);
  add("--materials", source.volume.materials);
  return words;
}

}  // namespace

FilmSource film_of(sim::Session& session, const std::string& recording,
                   const scenario::BoneRecipe& volume) {
  FilmSource source;
  source.recording = recording;
  source.volume = volume;
  std::error_code nobody_asks;  // for a case or formula the recording knows more than the path
  if (!fs::exists(volume.source, nobody_asks) || fs::path(volume.source).extension() == ".toml")
    source.volume.source.clear();
  tick::TickRow row;
  if (session.view(row))
    source.plan.until = static_cast<double>(row.tick) / session.settings().servo.rate_hz;
  return source;
}

bool holds_film(const std::string& path) {
  std::error_code nobody_asks;
  return fs::exists(is_film_file(path) ? fs::path(path) : picture(path, 1), nobody_asks);
}

Result<int> write_film(const FilmSource& source, const std::string& path, Progress& progress) {
  progress.report(0, "");
  std::error_code nobody_asks;
  if (!is_film_file(path))
    for (int n = 1; fs::remove(picture(path, n), nobody_asks); ++n) continue;

  HelperProcess child(command_of(source, path));
  if (!child.began())
    return error(
        Trouble::io,
        "the process that makes the film could not be started; close other programs and try again");
  bool stopped = false;
  auto stopped_at = std::chrono::steady_clock::now();
  while (!child.ended()) {
    std::this_thread::sleep_for(kLook);
    if (const double share = share_in(child.last_line()); share >= 0) progress.report(share, "");
    if (progress.cancelled() && !std::exchange(stopped, true)) {
      child.stop();
      stopped_at = std::chrono::steady_clock::now();
    }
    if (stopped && std::chrono::steady_clock::now() - stopped_at > kPatience) break;
  }
  if (stopped) return error(Trouble::interrupted, "stopped");
  if (!child.fine())
    return error(Trouble::io, child.complaint("the film ended early, without a message"));
  if (is_film_file(path)) return source.plan.frames();
  int made = 0;
  while (fs::exists(picture(path, made + 1), nobody_asks)) ++made;
  return made;
}

}  // namespace burr::app
