#include "window/replay/film_job.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace burr::app {
namespace {

namespace fs = std::filesystem;

constexpr int kNice = 10;  // a lower priority than the running session
constexpr auto kLook = std::chrono::milliseconds(100);
constexpr auto kPatience = std::chrono::seconds(20);  // to end the current picture, when stopped

fs::path picture(const fs::path& folder, int number) {  // the names of render::Film
  return folder / fmt::format("frame_{:06d}.png", number);
}

std::vector<std::string> command_of(const FilmSource& source, const std::string& folder) {
  std::error_code nobody_asks;
  const fs::path program = fs::read_symlink("/proc/self/exe", nobody_asks).parent_path() / "burr";
  std::vector<std::string> words = {
      program.string(), "--quiet", "replay", source.recording,
      "--film",         folder,    "--fps",  fmt::format("{}", source.fps)};
  words.insert(words.end(),
               {"--picture-size", fmt::format("{},{}", source.size.width, source.size.height)});
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

// A program whose error messages are read from a pipe.
class Child {
 public:
  explicit Child(const std::vector<std::string>& words) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return;
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    if (::posix_spawn(&pid_, words.front().c_str(), &actions, nullptr, arguments.data(), environ) !=
        0)
      pid_ = -1;
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    said_at_ = ends[0];
    ::fcntl(said_at_, F_SETFL, O_NONBLOCK);
    if (pid_ > 0) ::setpriority(PRIO_PROCESS, static_cast<id_t>(pid_), kNice);
  }
  ~Child() {
    if (pid_ > 0 && !ended()) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    if (said_at_ >= 0) ::close(said_at_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] bool began() const { return pid_ > 0; }
  void stop() const { ::kill(pid_, SIGINT); }
  [[nodiscard]] bool ended() {
    char some[512];
    for (ssize_t got = 0; (got = ::read(said_at_, some, sizeof(some))) > 0;)
      said_.append(some, static_cast<std::size_t>(got));
    if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
    return ended_;
  }
  [[nodiscard]] bool fine() const { return WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }
  // The last line of the error messages, without the program's name.
  [[nodiscard]] std::string complaint() const {
    std::string line = said_;
    while (!line.empty() && line.back() == '\n') line.pop_back();
    if (const auto at = line.rfind('\n'); at != std::string::npos) line.erase(0, at + 1);
    constexpr std::string_view kName = "burr: ";
    if (line.rfind(kName, 0) == 0) line.erase(0, kName.size());
    return line.empty() ? "the film ended early, without a message" : line;
  }

 private:
  pid_t pid_ = -1;
  int said_at_ = -1, status_ = 0;
  bool ended_ = false;
  std::string said_;
};

}  // namespace

FilmSource film_of(sim::Session& session, const std::string& recording,
                   const scenario::Recipe& volume) {
  FilmSource source;
  source.recording = recording;
  source.volume = volume;
  std::error_code nobody_asks;  // for a case or formula the recording knows more than the path
  if (!fs::exists(volume.source, nobody_asks) || fs::path(volume.source).extension() == ".toml")
    source.volume.source.clear();
  tick::TickRow row;
  if (session.view(row))
    source.seconds = static_cast<double>(row.tick) / session.settings().servo.rate_hz;
  return source;
}

bool holds_film(const std::string& folder) {
  std::error_code nobody_asks;
  return fs::exists(picture(folder, 1), nobody_asks);
}

Result<int> write_film(const FilmSource& source, const std::string& folder, Progress& progress) {
  const int expected = std::max(1, static_cast<int>(source.seconds * source.fps));
  progress.report(0, "");
  std::error_code nobody_asks;
  for (int n = 1; fs::remove(picture(folder, n), nobody_asks); ++n) continue;

  Child child(command_of(source, folder));
  if (!child.began())
    return error(
        Trouble::io,
        "the process that makes the film could not be started; close other programs and try again");
  int made = 0;
  bool stopped = false;
  auto stopped_at = std::chrono::steady_clock::now();
  while (!child.ended()) {
    std::this_thread::sleep_for(kLook);
    while (fs::exists(picture(folder, made + 1), nobody_asks)) ++made;
    progress.report(std::min(1.0, static_cast<double>(made) / expected), "");
    if (progress.cancelled() && !std::exchange(stopped, true)) {
      child.stop();
      stopped_at = std::chrono::steady_clock::now();
    }
    if (stopped && std::chrono::steady_clock::now() - stopped_at > kPatience) break;
  }
  if (stopped) return error(Trouble::interrupted, "stopped");
  if (!child.fine()) return error(Trouble::io, child.complaint());
  while (fs::exists(picture(folder, made + 1), nobody_asks)) ++made;
  return made;
}

}  // namespace burr::app
