// tests/support/postgres_server.h - a PostgreSQL server of a test's own, in a temporary folder, reached through a socket
// there: started, stopped, killed and started again by the test.
//
// PostgreSQL refuses to run as root, so it then runs as the user `postgres`, or `nobody`. Where the server's programs
// are missing, a test leaves itself out with one line; with BURR_REQUIRE_TOOLS=1 it fails.
#pragma once

#include <gtest/gtest.h>
#include <pwd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "support/folder.h"

namespace burr::test {

class PostgresServer {
 public:
  // The folder of initdb and pg_ctl; empty: not here.
  static std::string programs() {
    std::vector<std::filesystem::path> found;
    std::error_code ignored;
    for (const auto& version : std::filesystem::directory_iterator("/usr/lib/postgresql", ignored))
      if (::access((version.path() / "bin/initdb").c_str(), X_OK) == 0)
        found.push_back(version.path() / "bin");
    std::sort(found.begin(), found.end());
    return found.empty() ? std::string() : found.back().string();
  }
  static bool required() {
    const char* said = std::getenv("BURR_REQUIRE_TOOLS");
    return said != nullptr && std::strcmp(said, "1") == 0;
  }

  // more: further words for initdb
  explicit PostgresServer(const std::vector<std::string>& more = {}) : programs_(programs()) {
    if (programs_.empty()) return;
    if (::geteuid() == 0) {
      const passwd* user = ::getpwnam("postgres");
      if (user == nullptr) user = ::getpwnam("nobody");
      if (user == nullptr) return;
      uid_ = user->pw_uid;
      gid_ = user->pw_gid;
      if (::chown(folder_.str().c_str(), uid_, gid_) != 0) return;
    }
    std::vector<std::string> words = {programs_ + "/initdb",
                                      "-D",
                                      data(),
                                      "-U",
                                      "burr",
                                      "-A",
                                      "trust",
                                      "-E",
                                      "UTF8",
                                      "--no-sync"};
    words.insert(words.end(), more.begin(), more.end());
    made_ = call(words);
    if (!made_) return;
    std::ofstream settings(data() + "/postgresql.conf", std::ios::app);
    settings << "listen_addresses = ''\nunix_socket_directories = '" << folder_.str()
             << "'\nfsync = off\nmax_connections = 40\nshared_buffers = 16MB\n";
    settings.close();
    runs_ = start();
  }
  ~PostgresServer() {
    if (runs_) stop("immediate");
  }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  [[nodiscard]] bool runs() const { return runs_; }
  bool start() {
    runs_ = call(
        {programs_ + "/pg_ctl", "-D", data(), "-l", folder_ / "log", "-w", "-t", "60", "start"});
    return runs_;
  }
  // how: "fast" ends every connection, "immediate" is a crash
  void stop(const std::string& how) {
    runs_ = !call({programs_ + "/pg_ctl", "-D", data(), "-w", "-t", "60", "-m", how, "stop"});
  }
  [[nodiscard]] std::string address() const {
    return "postgresql://burr@/postgres?host=" + folder_.str();
  }
  [[nodiscard]] std::string log() const {
    std::ifstream file(folder_ / "log");
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  [[nodiscard]] std::string data() const { return folder_ / "data"; }
  bool call(const std::vector<std::string>& words) const {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      // no handle of the test stays open in the server
      if (std::freopen("/dev/null", "w", stdout) == nullptr) ::_exit(126);
      if (std::freopen((folder_ / "said").c_str(), "a", stderr) == nullptr) ::_exit(126);
      if (uid_ != 0 && (::setgid(gid_) != 0 || ::setuid(uid_) != 0)) ::_exit(126);
      if (::chdir("/") != 0) ::_exit(126);
      ::execv(arguments[0], arguments.data());
      ::_exit(127);
    }
    int status = 0;
    return child > 0 && ::waitpid(child, &status, 0) == child && WIFEXITED(status) &&
           WEXITSTATUS(status) == 0;
  }

  Folder folder_;
  std::string programs_;
  uid_t uid_ = 0;
  gid_t gid_ = 0;
  bool made_ = false, runs_ = false;
};

}  // namespace burr::test

// First line of a test that needs a server.
#define BURR_NEEDS_POSTGRES(server)                                                         \
  if (burr::test::PostgresServer::programs().empty()) {                                     \
    if (burr::test::PostgresServer::required()) FAIL() << "PostgreSQL's server is missing"; \
    GTEST_SKIP() << "left out: PostgreSQL's server is missing (Debian: postgresql)";        \
  }                                                                                         \
  ASSERT_TRUE((server).runs()) << (server).log()
