// apps/burr/commands/case_new.h - a first case for a volume: what the labels give, and comments where
// something is missing.
//
// Thread: any.
#pragma once

#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/volume/bone.h"
#include "burr/volume/tissue.h"

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

// A case tells labels apart by their names. Error: a label has no name, or the name of another.
[[nodiscard]] Status check_label_names(const volume::TissueTable& table);

// source: as the case shall name it, a file or phantom:NAME.
[[nodiscard]] NewCase new_case(const volume::Bone& bone, const std::string& source,
                               const CaseAnswers& answers);

// "entry = 1, 2, 3" is a name and a point.
[[nodiscard]] bool is_landmark(const std::string& answer);

}  // namespace burr::app
