// io/sandbox/fence_asker.h - the asking side of the fence: starts burr-read, lends it memory, watches it, and checks
// every message that it sends. For use of this room only.
//
//     FenceAsker asker(path);
//     if (Status status = asker.ask(request, progress); !status) return status.error();
//     asker.letter(), asker.memory(loan)           // what it answered, still to be checked
//
// Thread: one. Cancelling ends the reader within 0.05 s; so does the end of this object.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/handle.h"
#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/io/sandbox/fence_letter.h"
#include "burr/io/sandbox/fence_walls.h"

namespace burr::io {

class FenceAsker {
 public:
  explicit FenceAsker(const std::filesystem::path& path);
  FenceAsker(const FenceAsker&) = delete;
  FenceAsker& operator=(const FenceAsker&) = delete;
  ~FenceAsker() { stop(); }

  // Returns when the reader has ended and has said what it read, or why it could not.
  [[nodiscard]] Status ask(const FenceRequest& request, Progress& progress);

  // The letter, if that is the answer; empty: the answer is not in bounds.
  [[nodiscard]] std::vector<std::uint8_t> letter() const;
  // The last message: `done`, the outcome is in the letter, or `mesh`.
  [[nodiscard]] const FenceMessage& last() const { return *last_; }

  struct Loan {
    base::Handle memory;
    std::uint64_t bytes = 0;
  };
  // Nothing: the reader holds no such loan.
  [[nodiscard]] Loan* loan(std::uint32_t number);
  // "the reader sent an invalid answer", with the file.
  [[nodiscard]] Error lies() const;

 private:
  [[nodiscard]] Status start(const FenceRequest& request);
  [[nodiscard]] Status watch(Progress& progress);
  bool listen(Progress& progress);
  void take(FenceMessage& message, Progress& progress);
  void lend(std::uint64_t bytes);
  [[nodiscard]] double processor_seconds() const;
  bool reap(int how);
  void stop();
  void end_soon();
  [[nodiscard]] Error took_too_long() const;
  [[nodiscard]] Error stood_still() const;
  [[nodiscard]] Error why_it_ended() const;

  std::string file_;
  bool mesh_ = false;  // a mesh is read, no scan
  base::Handle letter_, socket_;
  std::vector<Loan> loans_;
  FenceLimits limits_{0, 60};                   // until the reader has reported them
  std::chrono::steady_clock::time_point mark_;  // when it was last seen to make progress
  double worked_at_mark_ = 0;                   // processor time then [s]
  pid_t child_ = -1;
  int status_ = 0;
  bool misbehaved_ = false;
  std::uint32_t refusal_ = 0;
  std::optional<FenceMessage> last_;
};

}  // namespace burr::io
