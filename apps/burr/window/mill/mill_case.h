// apps/burr/window/mill/mill_case.h - the case on the page for milling: its steps, the sentence about
// technique, the warning of an injury, what goes into the recording about the user, whether the work is
// done, and what the mode of the session allows.
//
//     MillCase work(bone, rate_hz, scene, options, row, notes);
//     work.begin();                                  // before the session starts
//     if (!work.allows(action)) work.say_refused();  // whatever key, button or pad it came from
//     work.look_at_steps(asked);                     // in each picture with a tick
//     work.end(time_over);                           // when the servo has stopped
//
// It knows nothing of windows, mice and devices: where a hand must be lifted it returns that. Thread:
// main; the measure of a step is taken on a thread of its own. Frame: world. Units: SI.
#pragma once

#include <optional>
#include <string>

#include "burr/guidance/injury.h"
#include "burr/guidance/step_watch.h"
#include "burr/guidance/steps.h"
#include "burr/guidance/technique.h"
#include "burr/record/diary.h"
#include "burr/render/scene.h"
#include "burr/tick/rows.h"
#include "window/mill/mill_notes.h"
#include "window/mill/step_light.h"
#include "window/mill/window_options.h"
#include "window/parts/hud.h"
#include "window/parts/toolbar.h"

namespace burr::app {

class MillCase {
 public:
  using Nearest = std::optional<HudState::Nearest>;  // of the structures to spare; none: too far

  // All of them outlive this. row: the newest one, so another at each picture.
  MillCase(volume::Bone& bone, double rate_hz, render::Scene& scene, const WindowOptions& options,
           const tick::TickRow& row, MillNotes& notes);

  void begin();
  void end(bool time_over);

  // ---- what the mode of the session allows
  [[nodiscard]] bool allows(Action action) const;
  [[nodiscard]] bool steps_offered() const {
    return !steps_.empty() && options_.allowed.steps != workshop::Offer::never;
  }
  // In an exam without the tissues' colours there are no names either.
  [[nodiscard]] bool names_offered() const { return options_.allowed.colours; }
  void say_refused();

  // ---- the steps
  // The first call begins the first step. asks_done: the question whether the work is done is open.
  void look_at_steps(bool asks_done);
  void step_done();
  // Lights the target of the current step, or puts the light out. The recording counts it.
  void light_target();
  void light_off() {
    if (light_.is_on()) light_target();
  }
  void draw_steps_panel(Ui& ui);
  void draw_light(const Ui& ui, float covered) const { light_.draw(ui, scene_.camera, covered); }
  [[nodiscard]] const scenario::Step* step() const { return steps_.now(); }
  // Where the work of the current step lies (step_follower.h). Rises with each step that becomes the
  // current one, and where the user wants to see its target.
  [[nodiscard]] int turns() const { return turns_; }
  // True: view and tool follow the steps, since the mode shows them or the user uses them.
  [[nodiscard]] bool follows() const;
  // Asks for the target of the current step, or of the first; radius: of the burr that suits [m].
  void seek_target(double radius);
  // Once for each answer: the step and its target. The light shows it from now on.
  [[nodiscard]] std::optional<guidance::StepWatch::Seen> look_at_target();
  // What the panel says of the step's press [m].
  void tell_press(double depth) { press_ = depth; }
  // How many the user is to be reminded of. An exam shows no steps, so of none.
  [[nodiscard]] std::size_t open_steps() const;

  // ---- technique and injury
  // tool: in the hand; nullptr: the round burr
  void look_at_technique(const Nearest& nearest, const scenario::RackTool* tool);
  [[nodiscard]] std::string cue_text() const;  // what is to be read now; "": nothing
  // full_speed: of the tool [rad/s]. True: an injury begins, and the session stops at one: lift the
  // hand, then say_injury().
  [[nodiscard]] bool look_at_injury(const Nearest& nearest, double full_speed);
  void say_injury(const std::string& structure);

  // ---- the recording
  // sight: what the page shows, without the warning. panels: the figures are seen.
  void keep_diary(record::Sight sight, const Nearest& nearest, bool panels);
  enum class Done {
    answered,  // it was declared or taken back, or it cannot be
    asks,      // it would end the session: ask the user
    ends,      // the session ends: mark_done()
  };
  // asked: the question is open, so this is its answer.
  [[nodiscard]] Done declare_done(bool asked);
  void mark_done();

 private:
  void tell(const guidance::Steps::Events& events);
  void look_at_measure(bool asks_done);
  void light_step();
  void write(record::CourseKind kind, const std::string& what, const std::string& where,
             const std::string& value = {});

  volume::Bone& bone_;
  double rate_hz_;
  render::Scene& scene_;
  const WindowOptions& options_;
  const tick::TickRow& row_;
  MillNotes& notes_;
  guidance::Steps steps_;
  std::optional<guidance::StepWatch> watch_;
  bool steps_begun_ = false;
  std::string lit_step_;  // whose target is lit, or was lit last
  StepLight light_;
  std::optional<guidance::StepWatch::Seen> target_;  // the newest
  int turns_ = 1;
  bool wanted_ = false;          // the user uses the steps
  std::optional<double> press_;  // of the step, as it was proposed [m]
  guidance::Technique technique_;
  guidance::Technique::Cue cue_ = guidance::Technique::Cue::none;
  double removed_before_ = 0;  // up to the picture before [m^3]
  guidance::InjuryWatch injury_;
  std::string near_;  // the structure that the user is warned of; empty: none
};

}  // namespace burr::app
