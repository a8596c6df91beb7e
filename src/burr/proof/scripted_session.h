// proof/scripted_session.h - a scripted surgeon's session of a case as a recording, like anybody's.
//
//     ScriptedSession session;  session.skill = surgeon::skill_of(surgeon::Level::careless);
//     proof::record_scripted(work, {}, session, "s.mcap", progress);
//
// Thread: any; seconds to minutes. Errors: one sentence; interrupted.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/case.h"
#include "burr/scenario/recipe.h"
#include "burr/surgeon/skill.h"

namespace burr::proof {

struct ScriptedSession {
  std::optional<surgeon::Skill> skill;  // none: the hand rests beside the bone
  std::uint64_t seed = 1;
  double seconds = 5400;  // the longest, by the session's clock
  bool leaves = false;    // declares the work done then, whatever is done
};

// recipe: its voxel size and materials replace those of the case.
[[nodiscard]] Status record_scripted(const scenario::Case& work, const scenario::BoneRecipe& recipe,
                                     const ScriptedSession& how, const std::string& file,
                                     Progress& progress);

}  // namespace burr::proof
