#include "shared/helper_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace burr::app {
namespace {

namespace fs = std::filesystem;

std::vector<char*> arguments_of(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

}  // namespace

std::string burr_itself() {
  std::error_code nobody_asks;
  return (fs::read_symlink("/proc/self/exe", nobody_asks).parent_path() / "burr").string();
}

std::string program_in_path(const std::string& name) {
  const char* path = std::getenv("PATH");
  const std::string folders = path != nullptr ? path : "";
  for (std::size_t at = 0; at <= folders.size();) {
    std::size_t end = folders.find(':', at);
    if (end == std::string::npos) end = folders.size();
    const std::string file = folders.substr(at, end - at) + "/" + name;
    if (file.front() == '/' && ::access(file.c_str(), X_OK) == 0) return file;
    at = end + 1;
  }
  return {};
}

bool start_apart(const std::vector<std::string>& words) {
  // a shell starts it and ends at once, so that nobody has to wait for it
  std::vector<std::string> shell = {"/bin/sh", "-c", "\"$@\" >/dev/null 2>&1 </dev/null &", "sh"};
  shell.insert(shell.end(), words.begin(), words.end());
  std::vector<char*> arguments = arguments_of(shell);
  pid_t pid = -1;
  if (::posix_spawn(&pid, shell.front().c_str(), nullptr, nullptr, arguments.data(), environ) != 0)
    return false;
  int status = 0;
  return ::waitpid(pid, &status, 0) == pid && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

HelperProcess::HelperProcess(const std::vector<std::string>& words, int nice) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) return;
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
  std::vector<char*> arguments = arguments_of(words);
  if (::posix_spawn(&pid_, words.front().c_str(), &actions, nullptr, arguments.data(), environ) !=
      0)
    pid_ = -1;
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  said_at_ = ends[0];
  ::fcntl(said_at_, F_SETFL, O_NONBLOCK);
  if (pid_ > 0 && nice > 0) ::setpriority(PRIO_PROCESS, static_cast<id_t>(pid_), nice);
}

HelperProcess::~HelperProcess() {
  if (pid_ > 0 && !let_go_ && !ended()) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  if (said_at_ >= 0) ::close(said_at_);
}

void HelperProcess::stop() const {
  if (pid_ > 0 && !ended_) ::kill(pid_, SIGINT);
}

bool HelperProcess::ended() {
  char some[512];
  for (ssize_t got = 0; (got = ::read(said_at_, some, sizeof(some))) > 0;)
    said_.append(some, static_cast<std::size_t>(got));
  if (!ended_) ended_ = ::waitpid(pid_, &status_, WNOHANG) == pid_;
  return ended_;
}

bool HelperProcess::fine() const { return WIFEXITED(status_) && WEXITSTATUS(status_) == 0; }

std::string HelperProcess::last_line() const {
  std::string line = said_.substr(0, said_.rfind('\n') + 1);  // not half a line
  while (!line.empty() && line.back() == '\n') line.pop_back();
  if (const auto at = line.rfind('\n'); at != std::string::npos) line.erase(0, at + 1);
  return line;
}

std::string HelperProcess::complaint(const std::string& silent) const {
  std::string line = last_line();
  constexpr std::string_view kName = "burr: ";
  if (line.rfind(kName, 0) == 0) line.erase(0, kName.size());
  return line.empty() ? silent : line;
}

}  // namespace burr::app
