// lrs/launch.h - burr as an assignable unit of cmi5: a learning management system starts it with an address, and is told
// when the session began, whether it was completed, and that it ended.
//
//     auto launch = lrs::Launch::begin(url, {});          // fetch, launch data, preferences, "initialized"
//     ... the session ...
//     launch->end(seconds, finished, folder);             // "completed" where it was finished, then "terminated"
//     lrs::tell_waiting(folder);                          // later: what could not be said then
//
// Neither "passed" nor "failed" is sent: a person decides that later (docs/teach/xapi.md). The
// token is never printed. It is kept in memory; it goes into a file, for this user alone, only
// where the system does not answer at the end: cmi5 lets it be used until the session is terminated
// or abandoned, and its best practice 17 keeps it where a program that ends does not lose it.
// Thread: one. Cost: waits for the network, before and after a session and never in it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "burr/base/result.h"

namespace burr::lrs {

class Launch {
 public:
  // url: "...?endpoint=&fetch=&actor=&registration=&activityId=". Error: a part is missing, or the system refuses. wait_s:
  // for each answer.
  [[nodiscard]] static Result<std::unique_ptr<Launch>> begin(const std::string& url,
                                                             double wait_s = 15);
  ~Launch();
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;

  // False in the modes Browse and Review: nothing is said of completion there.
  [[nodiscard]] bool counts() const;
  // Tries again for `patience_s` where no answer comes; what is not said by then waits as a file in the folder `wait_in`,
  // from the first one on, so that the order stays. Returns a sentence about that; empty: all was said. Error: the system
  // refuses something, or it cannot wait either.
  [[nodiscard]] Result<std::string> end(double seconds, bool finished,
                                        const std::filesystem::path& wait_in,
                                        double patience_s = 60);

 private:
  struct Parts;
  explicit Launch(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

// After so long nobody waits for it any more, and the file with its token goes.
inline constexpr int kDaysToWait = 7;

struct SentLater {
  std::size_t launches = 0;          // of which all was said
  std::size_t left = 0;              // that wait on
  std::vector<std::string> notices;  // sentences about those that were given up, and why
};
// Says what waits in `folder`, each once. A system that refuses has ended the session by itself; that launch is given up.
// It does no harm that another burr does the same.
[[nodiscard]] SentLater tell_waiting(const std::filesystem::path& folder, double wait_s = 15);
[[nodiscard]] std::size_t count_waiting(const std::filesystem::path& folder);

}  // namespace burr::lrs
