// apps/burr/shared/left_session.h - what a session that was left goes on with when it is continued, beside its bone: its recording,
// the steps of its case, its declaration, its pieces, and the suction.
//
// Plain struct. Thread: any.
#pragma once

#include <memory>
#include <vector>

#include "burr/edit/piece_store.h"
#include "burr/record/course.h"
#include "burr/record/earlier_part.h"

namespace burr::app {

struct LeftSession {
  // Of its recording, which goes on; nullptr: this session is a new one.
  std::shared_ptr<const record::EarlierPart> part = {};
  std::vector<record::CourseEvent> course = {};  // of the recording
  bool declared_done = false;                    // and not taken back
  edit::PieceStore pieces = {};                  // that were moved
  bool suction = false;                          // the tube beside the burr draws in
};

}  // namespace burr::app
