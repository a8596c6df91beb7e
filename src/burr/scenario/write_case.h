// scenario/write_case.h - a scene becomes the text of a case, which parse_case() reads again.
//
//     CaseFile file;
//     file.phantom = "block"; file.burr_mm = 4; file.rpm = 40000;
//     auto text = write_case(file);
//
// What the case that it was made from teaches (steps, landmarks ...) stays; its comments go. The same
// content gives the same text. Thread: any. Errors: one sentence with line and field.
#pragma once

#include <string>

#include "burr/base/result.h"
#include "burr/scenario/case.h"

namespace burr::scenario {

struct CaseFile {
  std::string name = "scene";   // for errors
  std::string from;             // the text of the case that it was made from; empty: none
  std::string title;            // empty: that of `from`
  std::string phantom, volume;  // one of them
  std::string rubric;           // empty: none
  double voxel_mm = 0;          // 0: what suits the bone
  double burr_mm = 5, rpm = 40000;
  bool diamond = false;
  std::string tool;  // empty: the round burr
  // The text of a file of tools. If `tool` is among them, it becomes a tool of the case's own.
  std::string tools;
  CaseSettings session;
  std::string motion;   // of the demonstration; empty: that of `from`
  double seconds = 20;  // of a named motion
};

[[nodiscard]] Result<std::string> write_case(const CaseFile& file);

}  // namespace burr::scenario
