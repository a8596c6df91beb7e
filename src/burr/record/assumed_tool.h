// record/assumed_tool.h - the tool in the hand, for recordings whose ticks do not contain it: those
// made before the columns 44 to 50 of burr.Ticks. Only this file derives the tool from commands.
//
// It is an ASSUMPTION: the session's settings, and then every command as if the servo had obeyed
// it. A command outside the servo's limits is ignored here, too. But the servo also refuses a
// larger burr where the bone leaves no room for it. An old recording does not contain that, so the
// radius may be too large from there to the next change of burr. Player::tool_is_recorded() returns
// whether the tool was recorded. Thread: any.
#pragma once

#include "burr/record/session_info.h"
#include "burr/tick/command.h"
#include "burr/tool/state.h"
#include "burr/volume/grid.h"

namespace burr::record {

class AssumedTool {
 public:
  // As the session began; radius 0 where its settings lack it.
  explicit AssumedTool(const SessionInfo& info);
  void obey(const tick::Command& command);
  [[nodiscard]] const tool::ToolState& now() const { return now_; }

 private:
  volume::Grid grid_;
  tool::ToolState now_;
};

}  // namespace burr::record
