// apps/burr/commands/case_new.h - a first case for a volume: what the labels give, and comments where
// something is missing.
//
// Thread: any.
#pragma once

#include <string>
#include <vector>

#include "burr/volume/bone.h"

namespace burr::app {

// What a person answered; empty: nothing, and the case says that it is missing.
struct CaseAnswers {
  std::string title;
  std::vector<std::string> spare;      // names of tissues
  std::vector<std::string> landmarks;  // "name = x, y, z", mm
  std::vector<std::string> steps;      // one sentence each
};

struct NewCase {
  std::string text;                  // TOML; parse_case() accepts it
  std::vector<std::string> missing;  // one phrase each
};

// source: as the case shall name it, a file or phantom:NAME.
[[nodiscard]] NewCase new_case(const volume::Bone& bone, const std::string& source,
                               const CaseAnswers& answers);

// "entry = 1, 2, 3" is a name and a point.
[[nodiscard]] bool is_landmark(const std::string& answer);

}  // namespace burr::app
