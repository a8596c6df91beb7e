// tests/scoring/known_bones.h - a built-in case whose bone is cut by shapes that share nothing with the regions and measures of
// burr (burr/proof/known_bone.h): the right value of each item follows from the numbers in the line.
//
//     KnownBone jaw("jaw");
//     jaw.cut("cyl 0 0 5 0 0 -11.2 2 ; ball 3 0 -4 1");
//     jaw.outcome("bed.width").value
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "burr/base/progress.h"
#include "burr/proof/known_bone.h"
#include "support/data.h"

namespace burr::scoring::test {

class KnownBone {
 public:
  explicit KnownBone(const std::string& name, double voxel_mm = 0)
      : bone_(made({.case_name = name, .voxel_mm = voxel_mm})) {}

  // Cuts a new bone of the case and scores it.
  void cut(const std::string& shapes) {
    const Status done = bone_.cut(shapes, quiet_);
    ASSERT_TRUE(done) << done.error().text;
  }
  // The result that the case calls its reference.
  void cut_reference() {
    const Status done = bone_.cut_reference(quiet_);
    ASSERT_TRUE(done) << done.error().text;
  }

  [[nodiscard]] const Outcome& outcome(const std::string& id) const {
    if (const Outcome* one = bone_.outcome(id); one != nullptr) return *one;
    throw std::out_of_range(id);
  }
  [[nodiscard]] double mm(const std::string& id) const { return *outcome(id).value * 1e3; }
  [[nodiscard]] bool met(const std::string& id) const {
    return outcome(id).verdict == Verdict::met;
  }
  [[nodiscard]] const volume::Bone& before() const { return bone_.before(); }
  [[nodiscard]] const volume::Bone& after() const { return bone_.after(); }
  [[nodiscard]] const scenario::CaseLesson& lesson() const { return bone_.lesson(); }

 private:
  static proof::KnownBone made(const proof::KnownBoneSettings& settings) {
    NoProgress quiet;
    auto bone = proof::KnownBone::make(settings, quiet);
    if (!bone) throw std::runtime_error(bone.error().text);
    return std::move(*bone);
  }

  NoProgress quiet_;
  proof::KnownBone bone_;
};

// The shapes of a bone in the shared data, by the name that begins its line; "": it is not there.
inline std::string known_line(const std::string& file, const std::string& name) {
  std::ifstream in(burr::test::data_dir() / "known_bones" / file);
  for (std::string line; std::getline(in, line);)
    if (line.rfind(name, 0) == 0) return line.substr(line.find('|') + 1);
  return {};
}

}  // namespace burr::scoring::test
