#include "window/shell/file_dialog.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <vector>

#include "window/shell/helper_process.h"

extern char** environ;

namespace burr::app {
namespace {

std::vector<std::string> command(bool folder) {
  if (std::string zenity = program_in_path("zenity"); !zenity.empty()) {
    std::vector<std::string> words = {zenity, "--file-selection"};
    if (folder) words.emplace_back("--directory");
    return words;
  }
  if (std::string kdialog = program_in_path("kdialog"); !kdialog.empty())
    return {kdialog, folder ? "--getexistingdirectory" : "--getopenfilename"};
  return {};
}

std::vector<std::string> command_to_save(const std::string& suggested) {
  if (std::string zenity = program_in_path("zenity"); !zenity.empty())
    return {zenity, "--file-selection", "--save", "--filename=" + suggested};
  if (std::string kdialog = program_in_path("kdialog"); !kdialog.empty())
    return {kdialog, "--getsavefilename", suggested};
  return {};
}

// Returns what the program prints; "" if it failed, the user cancelled, or `progress` is cancelled.
Result<std::string> ask_program(const std::vector<std::string>& words, Progress& progress) {
  std::array<int, 2> pipe{};
  if (words.empty() || ::pipe2(pipe.data(), O_CLOEXEC) != 0) return std::string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
  std::vector<char*> arguments;
  for (const std::string& one : words) arguments.push_back(const_cast<char*>(one.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int started =
      posix_spawn(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(pipe[1]);
  std::string text;
  while (started == 0 && !progress.cancelled()) {
    pollfd waits = {pipe[0], POLLIN, 0};
    if (::poll(&waits, 1, 100) <= 0) continue;
    std::array<char, 4096> some{};
    const ssize_t got = ::read(pipe[0], some.data(), some.size());
    if (got <= 0) break;
    text.append(some.data(), static_cast<std::size_t>(got));
  }
  ::close(pipe[0]);
  if (started == 0) {
    if (progress.cancelled()) ::kill(child, SIGTERM);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (status != 0) text.clear();
  }
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace

bool FileDialog::there() { return !command(false).empty(); }

void FileDialog::ask(bool folder) {
  if (open()) return;
  asked_ = std::make_unique<Loading<std::string>>(
      [words = command(folder)](Progress& progress) { return ask_program(words, progress); });
}

void FileDialog::ask_where(const std::string& suggested) {
  if (open()) return;
  asked_ = std::make_unique<Loading<std::string>>(
      [words = command_to_save(suggested)](Progress& progress) {
        return ask_program(words, progress);
      });
}

std::optional<std::string> FileDialog::answer() {
  if (!open() || !asked_->finished()) return std::nullopt;
  const Result<std::string> said = asked_->take();
  asked_.reset();
  return said ? *said : std::string();
}

}  // namespace burr::app
