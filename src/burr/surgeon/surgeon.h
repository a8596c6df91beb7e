// surgeon/surgeon.h - a scripted surgeon: does the steps of a case on a bone, looking at the bone as
// it is now.
//
//     auto surgeon = Surgeon::make(bone, lesson, burr, at, skill, seed, rate_hz, progress);
//     auto session = Session::make(bone, (*surgeon)->take_hand(), settings, progress);
//     every kConsultTicks ticks:  Consulted c = (*surgeon)->consult(bone);   // between two ticks
//
// It knows what a surgeon knows: tissues, the steps of the case with their regions, the thickness
// of bone that the case leaves, the way in. It does not know how it will be judged: this room
// includes neither metrics nor scoring (scripts/rooms.py). Everything follows from the seed and the
// bone, so the same seed gives the same session to the bit, and its recording replays.
//
// What surgeons of this kind prove and what they do not: docs/understand/surgeon.md.
// Frame: world (LPS). Units: SI. Thread: make() anywhere; consult() on the thread that runs the
// ticks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/scenario/lesson.h"
#include "burr/surgeon/believed.h"
#include "burr/surgeon/fill_work.h"
#include "burr/surgeon/plan.h"
#include "burr/surgeon/skill.h"
#include "burr/surgeon/surgeon_hand.h"
#include "burr/surgeon/surgeon_work.h"
#include "burr/tool/burr_tool.h"

namespace burr::surgeon {

inline constexpr std::uint64_t kConsultTicks = 250;

enum class NoteKind { step_begun, step_done, done };
struct SurgeonNote {
  NoteKind kind = NoteKind::step_begun;
  std::string step;  // its id; empty for done
  double left = 0;   // step_done: share of its plan that is still there
};

// From where the surgeon looks.
struct Eye {
  math::Vec3 at = math::Vec3::Zero();     // [m]
  math::Vec3 back = math::Vec3::UnitZ();  // unit, from the bone to the eye
};

// What happened at a consultation.
struct Consulted {
  std::vector<SurgeonNote> notes;
  std::optional<HeldBurr> burr;  // is taken into the hand now
  std::optional<Eye> eye;        // the surgeon looks from here from now on
  std::optional<bool> adds;      // from now on the burr adds material, or cuts again
};

class Surgeon {
 public:
  // lesson: placed (scenario::place), copied. burr: of the case, in the hand at the start. start: a
  // point on the bone above which the hand begins. Errors: a case without steps that have a region;
  // interrupted.
  [[nodiscard]] static Result<std::unique_ptr<Surgeon>> make(const volume::Bone& bone,
                                                             const scenario::CaseLesson& lesson,
                                                             const tool::Burr& burr,
                                                             const math::Vec3& start,
                                                             const Skill& skill, std::uint64_t seed,
                                                             double rate_hz, Progress& progress);

  // The hand, for a session; once. It lives at most as long as the surgeon.
  [[nodiscard]] std::unique_ptr<SurgeonHand> take_hand();

  // The work is declared done at this consultation at the earliest: who is ready before looks on, so
  // that time need not tell who stopped early.
  void stay_until(std::uint64_t consultation) { earliest_end_ = consultation; }

  [[nodiscard]] Consulted consult(const volume::Bone& bone);

  [[nodiscard]] const Believed& believed() const { return believed_; }
  [[nodiscard]] const Skill& skill() const { return skill_; }
  // The present step: how much of its plan is left; 0 between two steps.
  [[nodiscard]] double left() const { return work_ ? work_->left() : 0; }

 private:
  Surgeon(const scenario::CaseLesson& lesson, const tool::Burr& burr, const Skill& skill,
          std::uint64_t seed);
  void begin_step(const volume::Bone& bone, Consulted& out);
  void end_step(Consulted& out);
  void look_from(const volume::Bone& bone, const NextStroke& next, Consulted& out);

  scenario::CaseLesson lesson_;
  HeldBurr held_;
  double case_diameter_;
  Skill skill_;
  people::RandomStream random_;
  Believed believed_;
  Spare spare_;
  FieldGrid allowed_;  // the goals of this step and of those before it
  Filling filling_;    // of a step that adds
  bool adds_ = false;  // the burr adds material
  std::unique_ptr<SurgeonHand> hand_;
  SurgeonHand* working_ = nullptr;
  std::unique_ptr<Work> work_;
  std::size_t step_ = 0;  // of the lesson
  std::optional<HeldBurr> wanted_;
  std::uint64_t consultations_ = 0, earliest_end_ = 0;
  std::size_t remaining_ = 0;  // of the plan, when looked at last
  std::uint64_t changed_ = 0;  // and the consultation in which it changed last
  int pause_ = 0;              // consultations until the other burr turns
  math::Vec3 out_;
  Eye eye_;
};

}  // namespace burr::surgeon
