// serve/stations.h - pictures of running stations for the instructor's page, and the instructor's messages to them.
//
//     POST /api/station?name=&picture=&seen=&...     from a station: a picture of its window (JPEG; empty: none), or only that
//                                                    it is there. Answer: {watched, messages}
//     GET  /api/live                                 the stations, with the instructor's messages to each
//     GET  /api/live/picture?station=&after=         the newest picture; 202: none after that one
//     POST /api/live/say {station, text, mark, picture}    a word, and a place in that picture: x, y in 0..1
//
// Nothing is kept on a disk. A station is forgotten kSilent after its last word. Pictures come only while somebody looks.
// A station cannot be controlled from here: it shows the instructor's words and marks, and that it is watched.
// Thread: one.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "burr/net/request.h"

namespace burr::app {

class Stations {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kMost = 64;                             // stations
  static constexpr std::size_t kMostMessages = 20;                     // of a station
  static constexpr std::size_t kLongestName = 40, kLongestText = 200;  // letters
  static constexpr std::chrono::seconds kSilent{30}, kWatched{3};

  [[nodiscard]] net::Response answer(const net::Request& request, Clock::time_point now);

 private:
  struct Message {
    std::uint64_t id = 0;
    std::string text;
    std::optional<std::array<double, 2>> mark;
    std::uint64_t picture = 0;
    bool seen = false;  // the station has it
  };
  struct Station {
    std::map<std::string, std::string> words;
    std::string picture;
    std::uint64_t number = 0;  // of the picture
    Clock::time_point heard, watched;
    bool was_watched = false;
    std::deque<Message> messages;
  };
  [[nodiscard]] net::Response hear(const net::Request& request, Clock::time_point now);
  [[nodiscard]] net::Response list() const;
  [[nodiscard]] net::Response picture(const net::Request& request, Clock::time_point now);
  [[nodiscard]] net::Response say(const net::Request& request);

  std::map<std::string, Station> stations_;
  std::uint64_t last_message_ = 0;
};

}  // namespace burr::app
