// web/page_recorder.h - records the session of the page, by record/pen.h, into a file in the memory of
// the module. One thread: rings and pen belong to it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/device/hand_state.h"
#include "burr/record/course.h"
#include "burr/record/identity.h"
#include "burr/record/pen.h"
#include "burr/record/session_info.h"
#include "burr/rt/ring.h"
#include "burr/scenario/case.h"
#include "burr/tick/servo_outbox.h"
#include "burr/tick/settings.h"
#include "burr/volume/bone.h"

namespace burr::web {

// What the session is for. A case without a name: there is none.
struct PageTask {
  record::CaseInfo work_case;  // its hash is not needed
  record::Mode mode = record::Mode::free;
  std::uint64_t rubric_hash = 0;
  std::string phantom;           // "phantom:" and the name of the bone; empty: it is no phantom
  const char* motion = "mouse";  // what moves the hand
};

class PageRecorder {
 public:
  static constexpr const char* kFile = "/burr.mcap";  // in the module's own file system

  // bone: as it is before the first tick, after the surface was made; it goes into the file.
  // settings: as the servo has them. voxel_mm: of a phantom; 0: a bone of the user's.
  // file: in the module's own file system; each recording that is being made has one of its own.
  [[nodiscard]] static Result<std::unique_ptr<PageRecorder>> begin(
      const volume::Bone& bone, const tick::ServoSettings& settings,
      const device::DeviceSpec& device, double voxel_mm, const PageTask& task,
      const char* file = kFile);

  [[nodiscard]] tick::RecorderRings rings() { return {&ticks_, &commands_, &bricks_, nullptr}; }
  // Writes what waits. Call it at least every kDue ticks.
  static constexpr int kDue = 200;
  [[nodiscard]] Status drain() { return pen_->drain(); }
  // The file kCopy: complete, with everything so far; the recording goes on.
  static constexpr const char* kCopy = "/copy.mcap";
  [[nodiscard]] Status copy() {
    const Status drained = pen_->drain();
    return drained.ok() ? pen_->writer().copy_to(kCopy, kCopy) : drained;
  }
  // A step, a mark, the end: beside the ticks.
  void note(const record::CourseEvent& event) {
    if (record::check(event).ok()) pen_->notes().put({false, event.tick, record::to_json(event)});
  }
  // The file is complete after this; nothing more can be recorded. flush: the servo's last bricks.
  template <class Flush>
  [[nodiscard]] Status finish(const Flush& flush) {
    while (flush())
      if (Status drained = pen_->drain(); !drained.ok()) return drained;
    if (Status last = pen_->drain_last(false); !last.ok()) return last;
    return pen_->finish();
  }

 private:
  PageRecorder() = default;
  rt::Ring<tick::TickRow> ticks_{1024};
  rt::Ring<tick::CommandRow> commands_{256};
  rt::Ring<tick::BrickRow> bricks_{4096};
  std::unique_ptr<record::Pen> pen_;
};

}  // namespace burr::web
