// A Polhem that the test plays on a pseudo terminal: it answers each line of burr with one of its
// own, as the maker's program expects, and misbehaves on request.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "burr/math/vec3.h"
#include "device/fake/answers.h"

namespace burr::test {

class FakePolhem {
 public:
  struct Commands {
    double mm[3] = {0, 0, 0};
    double turns[4] = {0, 0, 0, 0};
    int info = 0;
    bool silent = false, pieces = false, swallow = false;  // swallow: drops the next line, once
    int stall_ms = 0;                                      // once
    double rate_hz = 0;                                    // largest rate of answers; 0: every line
                                                           // is answered at once
    std::vector<std::string> instead;                      // the next answers
    // ---- received
    math::Vec3 force = math::Vec3::Zero();  // its own axes [N]
    double largest = 0;
    std::uint64_t lines = 0, odd = 0;
    Answers answers;  // mm, N
  };

  FakePolhem() {
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY);
    ::grantpt(master_);
    ::unlockpt(master_);
    path = ::ptsname(master_);
    // kept open, so that the line survives when burr closes its end
    slave_ = ::open(path.c_str(), O_RDWR | O_NOCTTY);
    termios raw{};
    ::tcgetattr(slave_, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(slave_, TCSANOW, &raw);
    thread_ = std::thread([this] { run(); });
  }
  ~FakePolhem() { unplug(); }
  FakePolhem(const FakePolhem&) = delete;
  FakePolhem& operator=(const FakePolhem&) = delete;

  template <class F>
  auto with(F look) {
    const std::lock_guard lock(mutex_);
    return look(commands_);
  }
  math::Vec3 force() {
    return with([](Commands& w) { return w.force; });
  }
  // The line does not come back.
  void unplug() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    if (slave_ >= 0) ::close(slave_);
    if (master_ >= 0) ::close(master_);
    slave_ = master_ = -1;
  }

  std::string path;

 private:
  static void put(int fd, const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t done = ::write(fd, text.data() + at, text.size() - at);
      if (done <= 0) return;
      at += static_cast<std::size_t>(done);
    }
  }
  void answer() {
    std::string line;
    int stall = 0;
    bool pieces = false;
    {
      const std::lock_guard lock(mutex_);
      Commands& w = commands_;
      char text[128];
      const int n =
          std::snprintf(text, sizeof text, "% 8.3f % 8.3f % 8.3f % 7.4f % 7.4f % 7.4f % 7.4f %hd\n",
                        w.mm[0], w.mm[1], w.mm[2], w.turns[0], w.turns[1], w.turns[2], w.turns[3],
                        static_cast<short>(w.info));
      line.assign(text, static_cast<std::size_t>(n));
      w.answers.tell(w.mm);
      if (line.size() < 64) {  // padded, with a second newline at its end
        line.resize(64, ' ');
        line[63] = '\n';
      }
      if (!w.instead.empty()) {
        line = w.instead.front();
        w.instead.erase(w.instead.begin());
      }
      stall = w.stall_ms;
      w.stall_ms = 0;
      pieces = w.pieces;
      if (w.silent) return;
      if (w.rate_hz > 0) stall = std::max(stall, static_cast<int>(1000 / w.rate_hz));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(stall));
    if (!pieces) return put(master_, line);
    for (std::size_t at = 0; at < line.size(); at += 7) {
      put(master_, line.substr(at, 7));
      std::this_thread::sleep_for(std::chrono::microseconds(30));
    }
  }
  void run() {
    std::string heard;
    while (!stop_) {
      pollfd waits{master_, POLLIN, 0};
      if (::poll(&waits, 1, 5) <= 0) continue;
      char some[512];
      const ssize_t got = ::read(master_, some, sizeof some);
      if (got <= 0) continue;
      heard.append(some, static_cast<std::size_t>(got));
      for (std::size_t end = heard.find('\n'); end != std::string::npos; end = heard.find('\n')) {
        int x = 0, y = 0, z = 0, command = 0, a = 0, b = 0, c = 0;
        bool answers = true;
        {
          const std::lock_guard lock(mutex_);
          const bool good = end == 63 && std::sscanf(heard.c_str(), "%d %d %d %d %d %d %d", &x, &y,
                                                     &z, &command, &a, &b, &c) == 7;
          ++(good && command == 2 ? commands_.lines : commands_.odd);
          if (good && command == 2) {
            commands_.force = 1e-3 * math::Vec3(x, y, z);
            commands_.answers.take(commands_.force.data());
            commands_.largest = std::max(commands_.largest, commands_.force.norm());
          }
          answers = !commands_.swallow;
          commands_.swallow = false;
        }
        heard.erase(0, end + 1);
        if (answers) answer();
      }
    }
  }

  int master_ = -1, slave_ = -1;
  std::mutex mutex_;
  Commands commands_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace burr::test
