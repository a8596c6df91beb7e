// apps/burr/doctor/finding.h - the findings of the doctor, line by line, each with advice.
#pragma once

#include <string>
#include <vector>

namespace burr::app {

enum class Health {
  good,
  absent,   // it is not there, and need not be
  trouble,  // it is there, and does not work as it should
};

struct Finding {
  std::string group, what;  // "devices", "Touch"
  Health health = Health::good;
  std::string value;  // what was found
  std::string todo;   // what to do; empty: nothing
};

// A table for people: group by group, with the advice below each line.
[[nodiscard]] std::string text_of(const std::vector<Finding>& findings);
// An array for programs, as JSON.
[[nodiscard]] std::string json_of(const std::vector<Finding>& findings);

}  // namespace burr::app
