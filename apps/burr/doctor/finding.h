// apps/burr/doctor/finding.h - what the doctor saw, line by line, each with what to do about it.
#pragma once

#include <string>
#include <vector>

namespace burr::app {

enum class Health {
  good,
  absent,   // it is not here, and need not be
  trouble,  // it is here, and does not work as it should
};

struct Finding {
  std::string group, what;  // "devices", "Touch"
  Health health = Health::good;
  std::string is;    // what was seen
  std::string todo;  // what to do; empty: nothing
};

// A table for people: group by group, what to do below each line.
[[nodiscard]] std::string text_of(const std::vector<Finding>& findings);
// An array for programs, as JSON.
[[nodiscard]] std::string json_of(const std::vector<Finding>& findings);

}  // namespace burr::app
