// serve/replays.h - recorded sessions for the instructor's page: bone, time line and the recording itself.
//
//     Replays replays;
//     auto response = replays.answer(store, request);      // of /api/replay, /api/replay/recording, /api/replay/bone
//
//     /api/replay?session=ID             202 {share, stage}: being prepared, ask again; 200: the time line
//     /api/replay/recording?session=ID&from=BYTE     at most kMostBytes of the file, from there on
//     /api/replay/bone?session=ID        the bone before the first tick (record/bone_blob.h), where the file has none
//
// A recording is shown only if it lies on this computer and its SHA-1 is that in the store, so no other file can be
// read through an address in the store. A session is prepared in a thread, one at a time, in seconds (it is scored, for
// steps and distances); the last few are kept. Of a session that has left the store nothing is answered, and what
// was kept of it goes.
//
// Thread: answer() in one; the destructor waits until the preparation has noticed that it is not wanted any more.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "burr/net/request.h"
#include "burr/school/store.h"

namespace burr::app {

class Replays {
 public:
  static constexpr std::size_t kMostBytes = 4U << 20;
  static constexpr std::size_t kKept = 4;  // sessions

  Replays();
  ~Replays();
  Replays(const Replays&) = delete;
  Replays& operator=(const Replays&) = delete;

  [[nodiscard]] net::Response answer(school::Store& store, const net::Request& request);

 private:
  struct Replay;
  using Shared = std::shared_ptr<Replay>;

  [[nodiscard]] Shared replay_of(const std::string& session, const std::string& uri,
                                 const std::string& hash);
  void drop(const std::string& session);
  void prepare(const std::stop_token& stop);
  [[nodiscard]] static net::Response recording(const Replay& replay, const std::string& from);

  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Shared> replays_;  // the newest last
  std::jthread thread_;         // the last member: it ends first
};

}  // namespace burr::app
