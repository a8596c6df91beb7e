// lrs/launch.h - burr as an assignable unit of cmi5: a learning management system starts it with an address, and is told
// when the session began, whether it was completed, and that it ended.
//
//     auto launch = lrs::Launch::begin(url, {});          // fetch, launch data, preferences, "initialized"
//     ... the session ...
//     launch->end(seconds, finished);                     // "completed" where it was finished, then "terminated"
//
// Neither "passed" nor "failed" is sent: a person decides that later (docs/xapi.md). The token is kept in memory alone and
// never printed. Thread: one. Cost: waits for the network, before and after a session and never in it.
#pragma once

#include <memory>
#include <string>

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
  // Tries again for `patience_s` where no answer comes. Error: what the system was not told.
  [[nodiscard]] Status end(double seconds, bool finished, double patience_s = 60);

 private:
  struct Parts;
  explicit Launch(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace burr::lrs
