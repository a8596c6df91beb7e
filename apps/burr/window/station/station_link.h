// window/station/station_link.h - shows this station's window on the instructor's page (`burr serve --live`), and brings the
// instructor's words and marks.
//
//     auto link = StationLink::open({url, token, "station 4"});
//     link->is(words);                                     // each picture of the window
//     if (link->wants_picture()) number = link->offer(renderer.shown());
//     for (auto& message : link->news()) ...
//
// A thread of its own asks the server; the window never waits for it, and a server that is away changes nothing. Pictures
// are made smaller and sent only while somebody looks, at most kPerSecond. The haptic thread has no part in it.
// Thread: main, one for all calls.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "burr/base/result.h"
#include "burr/render/image.h"

namespace burr::app {

class StationLink {
 public:
  static constexpr int kPerSecond = 30;
  static constexpr int kWide = 640;                       // of the picture that is sent  [pixel]
  static constexpr std::size_t kLargestPicture = 60'000;  // the server takes 64 KiB  [byte]

  struct To {
    std::string url;  // "https://school.example:8231"
    std::string token, name;
  };
  // Error, Trouble::usage: the address cannot be one.
  [[nodiscard]] static Result<std::unique_ptr<StationLink>> open(const To& to);
  ~StationLink();  // waits for a question that is under way, at most kWait

  struct Words {
    std::string learner, work, mode, step;  // "" where there is none
    double seconds = 0, force = 0;          // [s], the largest lately [N]
  };
  void is(Words words);

  [[nodiscard]] bool watched() const;
  [[nodiscard]] bool wants_picture() const;
  // The number of the picture; marks name it.
  std::uint64_t offer(render::Image picture);

  struct Message {
    std::uint64_t id = 0;
    std::string text;                           // "" where there is only a mark
    std::optional<std::array<double, 2>> mark;  // in the picture: x, y in 0..1
    std::uint64_t picture = 0;
  };
  // What came since the last call.
  [[nodiscard]] std::vector<Message> news();
  // Why the server cannot be reached; "" while it can.
  [[nodiscard]] std::string trouble() const;

 private:
  explicit StationLink(To to);
  void run(const std::stop_token& stop);
  [[nodiscard]] Result<bool> ask(const Words& words, std::uint64_t number, std::string picture);

  To to_;
  mutable std::mutex mutex_;
  std::condition_variable_any changed_;
  // under mutex_
  Words words_;
  std::optional<render::Image> picture_;  // to be sent
  std::uint64_t number_ = 0;
  bool watched_ = false, known_ = false;
  std::chrono::steady_clock::time_point due_;  // the next picture
  std::vector<Message> news_;
  std::string trouble_;
  // of the thread
  std::uint64_t seen_ = 0;
  std::jthread thread_;  // the last member: it ends first
};

// Half as wide again and again until it is at most `wide`.
[[nodiscard]] render::Image smaller(render::Image image, int wide);

}  // namespace burr::app
