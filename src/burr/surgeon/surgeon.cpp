#include "burr/surgeon/surgeon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "burr/surgeon/step_work.h"
#include "burr/volume/sample.h"

namespace burr::surgeon {
namespace {

using math::Vec3;

constexpr std::uint64_t kPolicyStream = 3;  // of random numbers
constexpr double kAboveStart = 20e-3;       // where the hand begins [m]
constexpr double kEyeAway = 0.3;            // of a microscope's objective [m]
constexpr double kEyeSide = 0.6;            // tangent of the largest tilt of a look
constexpr int kLooks = 12;                  // that are tried for a clear one
constexpr double kSeenFar = 60e-3;          // bone beyond hides nothing [m]
constexpr int kChange = 4;                  // consultations that a change of burr takes
// A bout that has removed nothing of the plan for so long is given up.
constexpr double kIdle = 1;              // [s]
constexpr std::uint64_t kIdleLooks = 3;  // consultations

bool works(const scenario::Step& step) { return !step.region.empty(); }

bool clear(const volume::Bone& bone, const Vec3& from, const Vec3& towards) {
  for (double s = 1e-3; s < kSeenFar; s += 1e-3)
    if (volume::depth_at(bone, from + s * towards) > 0) return false;
  return true;
}

}  // namespace

Surgeon::Surgeon(const scenario::CaseLesson& lesson, const tool::Burr& burr, const Skill& skill,
                 std::uint64_t seed)
    : lesson_(lesson),
      held_{burr.radius, burr.kind},
      case_diameter_(2 * burr.radius),
      skill_(skill),
      random_(seed, kPolicyStream),
      out_(approach_of(lesson).front()) {}

Result<std::unique_ptr<Surgeon>> Surgeon::make(const volume::Bone& bone,
                                               const scenario::CaseLesson& lesson,
                                               const tool::Burr& burr, const Vec3& start,
                                               const Skill& skill, std::uint64_t seed,
                                               double rate_hz, Progress& progress) {
  if (std::none_of(lesson.steps.begin(), lesson.steps.end(), works))
    return error(
        "the case has no step with a region, so a scripted surgeon has nothing to do; add [[step]] "
        "with region (docs/use/cases.md)");
  std::unique_ptr<Surgeon> out(new Surgeon(lesson, burr, skill, seed));
  auto believed = Believed::make(bone, out->lesson_, skill.perception, seed, progress);
  if (!believed) return believed.error();
  out->believed_ = std::move(*believed);
  out->spare_ = spare_of(bone.grid(), out->lesson_, out->believed_, skill.margin_less);
  out->eye_ = {start + kEyeAway * out->out_, out->out_};
  out->hand_ = std::make_unique<SurgeonHand>(skill, 1 / rate_hz, seed,
                                             start + kAboveStart * out->out_, out->out_);
  out->working_ = out->hand_.get();
  return out;
}

std::unique_ptr<SurgeonHand> Surgeon::take_hand() { return std::move(hand_); }

void Surgeon::begin_step(const volume::Bone& bone, Consulted& out) {
  while (step_ < lesson_.steps.size() && !works(lesson_.steps[step_])) ++step_;
  if (step_ >= lesson_.steps.size()) return;
  const scenario::Step& step = lesson_.steps[step_];
  out.notes.push_back({NoteKind::step_begun, step.id, 1});
  const std::vector<Vec3> approach = approach_of(lesson_, step);
  if (step.adds != adds_) out.adds = adds_ = step.adds;
  if (step.adds) {
    out_ = approach.front();
    filling_ = filling_of(*lesson_.region(step.region), believed_, spare_, out_);
    work_ = std::make_unique<FillWork>(bone, step, filling_, out_, skill_, case_diameter_);
    working_->look_at(&filling_.rise, &spare_.near, true);
    return;
  }
  const FieldGrid goal = goal_of(*lesson_.region(step.region), approach, believed_, spare_);
  if (allowed_.nodes() == 0) allowed_ = goal;
  for (std::size_t n = 0; n < goal.nodes(); ++n)
    allowed_.value[n] = std::max(allowed_.value[n], goal.value[n]);
  work_ = std::make_unique<StepWork>(bone, step, lesson_, goal, allowed_, spare_, skill_,
                                     case_diameter_);
  working_->look_at(&allowed_, &spare_.near);
}

void Surgeon::end_step(Consulted& out) {
  out.notes.push_back({NoteKind::step_done, lesson_.steps[step_].id, work_->left()});
  working_->retreat(out_, kAboveStart);
  working_->look_at(nullptr, nullptr);
  work_.reset();
  wanted_.reset();
  ++step_;
}

void Surgeon::look_from(const volume::Bone& bone, const NextStroke& next, Consulted& out) {
  if (random_.uniform() >= skill_.clear_view) return;  // stays where the eye was
  const Vec3 from = next.stroke.start;
  Vec3 back = next.out;
  const Vec3 u = back.unitOrthogonal(), v = back.cross(u);
  for (int n = 0; n < kLooks && !clear(bone, from, back); ++n) {
    const double angle = 2 * M_PI * n / kLooks, side = kEyeSide * random_.uniform();
    back = (next.out + side * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
  }
  eye_ = {from + kEyeAway * back, back};
  out.eye = eye_;
}

Consulted Surgeon::consult(const volume::Bone& bone) {
  Consulted out;
  ++consultations_;
  if (!work_) {
    begin_step(bone, out);
    if (!work_) {
      if (consultations_ < earliest_end_) return out;
      out.notes.push_back({NoteKind::done, {}, 0});
      working_->finish();
      return out;
    }
    out.eye = eye_;
  }
  work_->look(bone, working_->intended());
  if (work_->remaining() != remaining_) {
    remaining_ = work_->remaining();
    changed_ = consultations_;
  }
  if (pause_ > 0 && --pause_ > 0) return out;
  if (wanted_) {  // the burr is changed outside the bone
    if (!working_->waiting()) return out;
    held_ = *wanted_;
    out.burr = held_;
    wanted_.reset();
    pause_ = kChange;
    return out;
  }
  const bool idle = working_->stroked() > kIdle && consultations_ - changed_ > kIdleLooks;
  if (!working_->free() && !idle) return out;
  if (work_->left() < skill_.unfinished) {
    end_step(out);
    return out;
  }
  const auto next = work_->next(bone, working_->intended(), held_, random_);
  if (!next) {
    if (work_->left() <= 0 || work_->exhausted()) end_step(out);
    return out;
  }
  if (!(next->burr == held_)) {
    wanted_ = next->burr;
    working_->retreat(out_, kAboveStart);  // on the way out of the place that is left
    return out;
  }
  out_ = next->out;
  look_from(bone, *next, out);
  working_->begin(next->stroke, held_.radius);
  return out;
}

}  // namespace burr::surgeon
