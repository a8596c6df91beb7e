#include "burr/proof/assistant.h"

#include <cmath>
#include <optional>

#include "burr/record/course.h"
#include "burr/tool/state.h"

namespace burr::proof {
namespace {

using math::Vec3;

constexpr double kFieldOfView = 0.2;  // of the recorded view, as through a microscope [rad]
constexpr double kEye = 0.3;          // from the eye to the bone [m]

record::View view_from(const surgeon::Eye& eye, std::uint64_t tick) {
  record::View view;
  view.tick = tick;
  view.eye = eye.at;
  view.back = eye.back;
  // upright as far as the look allows
  const Vec3 up = std::abs(eye.back.z()) < 0.9 ? Vec3(Vec3::UnitZ()) : Vec3(-Vec3::UnitY());
  view.right = up.cross(eye.back).normalized();
  view.up = view.back.cross(view.right).normalized();
  view.field_of_view = kFieldOfView;
  view.magnification = record::magnification_of(2 * kEye * std::tan(0.5 * kFieldOfView));
  view.slices = view.panels = view.colours = false;
  return view;
}

}  // namespace

void Assistant::work() {
  const std::uint64_t tick = session_.ticks();
  if (tick == 0) session_.command({tick::CommandKind::irrigation, 1});
  const surgeon::Consulted consulted = surgeon_.consult(session_.bone());
  if (consulted.burr) {
    session_.command({tick::CommandKind::burr_kind,
                      consulted.burr->kind == tool::BurrKind::diamond ? 1.0 : 0.0});
    session_.command({tick::CommandKind::burr_radius, consulted.burr->radius});
  }
  if (consulted.adds)
    session_.command({tick::CommandKind::tool_mode,
                      static_cast<double>(*consulted.adds ? tool::Mode::add : tool::Mode::cut)});
  for (const surgeon::SurgeonNote& note : consulted.notes) tell(note, tick);
  if (consulted.eye && diary_ != nullptr) diary_->look({.view = view_from(*consulted.eye, tick)});
}

void Assistant::tell(const surgeon::SurgeonNote& note, std::uint64_t tick) {
  if (note.kind == surgeon::NoteKind::done) {
    done_ = true;
    if (diary_ != nullptr) diary_->declare_done(tick, true);
    return;
  }
  const bool begins = note.kind == surgeon::NoteKind::step_begun;
  const double seconds = static_cast<double>(tick) / session_.settings().servo.rate_hz;
  if (begins) {
    steps_.push_back({note.step, seconds, std::nullopt, 0});
  } else {
    steps_.back().to_s = seconds;
    steps_.back().left = note.left;
  }
  if (diary_ != nullptr)
    static_cast<void>(
        diary_->note({tick, begins ? record::CourseKind::step_begun : record::CourseKind::step_done,
                      note.step}));
}

}  // namespace burr::proof
