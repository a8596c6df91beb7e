// apps/burr/window/mill/mill.h - the page for milling as one object: in each picture it connects
// the user, the session and the bone.
//
// Its parts: window.cpp (the loop of pictures), mill_hand.cpp (the mouse as a hand, and what each
// button does), mill_view.cpp (views and colours), mill_keys.cpp (the table of keys), mill_pads.cpp (gamepad, pedal, SpaceMouse),
// mill_status.cpp (what the user reads), mill_diary.cpp (what the recording keeps), mill_names.cpp
// (the names of structures), mill_tools.cpp (the rack), mill_pieces.cpp (free pieces), mill_steps.cpp (the steps of the case, and what the mode of the session allows). Parts with a state of their own
// are classes: Drill, Press, Pointer, OverPages, WornHeadset, TickWatch, SuctionTube, Steps,
// Technique, StepLight. Only these files include this header.
//
// Thread: main. Frame: world. Units: SI.
#pragma once

#include <SDL2/SDL.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "burr/guidance/injury.h"
#include "burr/guidance/step_watch.h"
#include "burr/guidance/steps.h"
#include "burr/guidance/technique.h"
#include "burr/mouse/grip.h"
#include "burr/mouse/mouse_aim.h"
#include "burr/mouse/mouse_hand.h"
#include "burr/render/held_tool.h"
#include "burr/sim/session.h"
#include "burr/surface/worker.h"
#include "burr/workshop/live_surface.h"
#include "burr/workshop/tool_looks.h"
#include "shared/word_names.h"
#include "window/mill/drill.h"
#include "window/mill/hand_plane.h"
#include "window/mill/instructor_notes.h"
#include "window/mill/menu_panel.h"
#include "window/mill/orientation_cube.h"
#include "window/mill/over_pages.h"
#include "window/mill/piece_mode.h"
#include "window/mill/pinned_labels.h"
#include "window/mill/pointer.h"
#include "window/mill/press.h"
#include "window/mill/saved_views.h"
#include "window/mill/side_panel.h"
#include "window/mill/step_light.h"
#include "window/mill/structures.h"
#include "window/mill/suction_tube.h"
#include "window/mill/tick_watch.h"
#include "window/mill/tool_rack.h"
#include "window/mill/window_options.h"
#include "window/mill/work_views.h"
#include "window/mill/worn_headset.h"
#include "window/parts/hud.h"
#include "window/parts/measuring.h"
#include "window/parts/mirror_mode.h"
#include "window/parts/slices.h"
#include "window/parts/toolbar.h"
#include "window/ui/desk.h"
#include "window/ui/help.h"
#include "window/ui/status_line.h"

namespace burr::app {

struct KeyReach;  // mill_keys.h

class Mill {
 public:
  Mill(Desk& desk, sim::Session& session, const mouse::Hands& hands, surface::Worker& worker,
       render::Scene& scene, const WindowOptions& options)
      : desk_(desk),
        session_(session),
        hands_(hands),
        worker_(worker),
        scene_(scene),
        options_(options),
        views_(options, scene.camera),
        panels_(desk.settings.panels),
        headset_(desk),
        pointer_(desk, scene),
        aim_(session.bone().grid().voxel),
        mirror_(session.bone().grid()),
        drill_(session, scene.burr),
        rack_(options.rack),
        looks_(session.settings().servo.tools) {
    grip_.take(rack_.tool(drill_.tool()));
    aim_.hold(&grip_);
    if (options_.lesson) steps_ = guidance::Steps(options_.lesson->steps);
    take_titles_of(options_.lesson ? &*options_.lesson : nullptr);
  }

  Result<Closed> run();

  [[nodiscard]] static std::vector<HelpRow> help_rows(bool left_handed);

 private:
  using Clock = std::chrono::steady_clock;

  // ---- window.cpp
  void begin();  // call it when the live surface is complete
  Status frame(workshop::LiveSurface& live);
  void end(workshop::LiveSurface& live);

  // ---- mill_keys.cpp
  static constexpr double kDeeper = 1.25;  // a key changes the depth of the press by this factor
  // How the mouse does what a key does: by a button of the bar, by an item of the menu, or by what
  // `other` names (a gesture, a button on another panel). Every key has one of these.
  struct Reach {
    std::optional<Action> button;
    std::string item;
    std::optional<Word> other;
    bool twin = false;  // the key before it in the row does the same
  };
  struct Key {
    SDL_Keycode code;
    unsigned held;  // modifiers, of which one must be down; 0: any or none
    std::function<void(Mill&)> does;
    Reach reach;
  };
  friend std::vector<KeyReach> key_reaches();
  static Key act_key(SDL_Keycode code, Action action);
  static Key item_key(SDL_Keycode code, std::function<void(Mill&)> does, std::string item,
                      unsigned held = 0);
  static Key other_key(SDL_Keycode code, std::function<void(Mill&)> does, Word other,
                       unsigned held = 0);
  static Key twin_key(SDL_Keycode code, std::function<void(Mill&)> does, unsigned held = 0);
  void draw_menu_panel();
  struct KeyRow {
    HelpBlock block;
    std::string label;
    Word says;
    std::vector<Key> keys;
  };
  using KeyRows = std::vector<KeyRow>;
  static KeyRows hand_keys(bool left_handed);
  static KeyRows view_keys(bool left_handed);
  static KeyRow saved_view_keys();
  static KeyRows tool_keys();
  static KeyRows program_keys();
  static KeyRows key_rows(bool left_handed);
  void key(const SDL_Keysym& pressed);

  // ---- mill_hand.cpp
  void take_events();
  bool aim_key(const SDL_Keysym& pressed, bool down);
  void move(const SDL_MouseMotionEvent& motion);
  void button(const SDL_MouseButtonEvent& button);
  void wheel(const SDL_MouseWheelEvent& wheel);
  void act(Action action);
  void leave();
  void push(double factor);
  void deepen(double steps);
  void toggle_plane();
  void lift();
  void point();
  void point_in_plane(const render::Ray& ray);
  void align_real_hand();
  void lift_real_hand();
  void stop_or_go_on();
  void next_measure();
  void measure();
  void toggle_labels();
  void step_opacity(bool back);
  void toggle_sound();
  void change_loudness(int by);
  void toggle_suction();
  void hide_panels();
  void suck(workshop::LiveSurface& live);
  void toggle_menu(Menu menu);
  void mirror_at_tip();
  void mirror_next_plane();
  void note_mirror();
  void show_task();
  void go_back();
  void keep();
  void pick_point();
  [[nodiscard]] bool page_open() const { return pages_->open(); }
  [[nodiscard]] bool pressing() const {
    return !lifts_.stopped && press_.on() && !measuring_.picks() && !page_open() && !has_piece() &&
           !pointer_.over_panel() && !pointer_.over_slices();
  }
  // the lower of the settings' limit and the user's limit for this device  [N]
  [[nodiscard]] double user_limit() const {
    return std::min(desk_.settings.force_limit_n, hands_.max_force);
  }

  // ---- mill_view.cpp
  void turn_view(double right, double up, bool shift);
  void show_labels(bool shown);
  void saved_view(int slot, bool keep);
  void take_view(ViewKind kind);
  void first_view();
  void magnify(double by);
  void deep_or_not();
  void refocus(double by);
  [[nodiscard]] double aspect() const;

  // ---- mill_pads.cpp
  void take_hands();
  void look_for_hands();
  void take_pads(double dt);
  void pad_button(Uint8 button);
  void pedal_button(const SDL_Event& event);

  // ---- mill_tools.cpp
  void take_tool(int place);
  void next_tool(int by);
  void roll_tool(double steps);
  void lean_tool(double steps);
  [[nodiscard]] bool holds_by_mouse() const;
  void draw_rack_pictures();
  void draw_rack_panel();
  void look_at_pieces();
  void carry_piece();
  [[nodiscard]] std::optional<sim::PieceMover::Suction> splinter_suction() const;
  void see_cuts(workshop::LiveSurface& live);
  [[nodiscard]] bool other_hand_carries() const;
  void draw_pieces_panel();
  bool piece_key(const SDL_Keysym& pressed);
  void drag_piece(const SDL_MouseMotionEvent& motion);
  [[nodiscard]] bool has_piece() const { return pieces_ && pieces_->taken(); }
  // The axes of the hand stay as they are meanwhile: a turned view must not turn the piece.
  [[nodiscard]] bool carries_piece() const { return pieces_ && pieces_->carried(); }
  [[nodiscard]] std::optional<HudState::Nearest> nearest_spared();

  // ---- mill_station.cpp
  void talk();  // after a picture
  struct Shown {
    std::uint64_t number = 0;  // of the picture that was offered
    render::Camera camera;
    int width = 1, height = 1;
  };
  std::array<Shown, 64> shown_;  // the last ones: a mark of the instructor is in one of them
  InstructorNotes notes_;
  bool was_watched_ = false;
  std::string station_trouble_;  // the last one

  // ---- mill_diary.cpp
  void keep_diary();
  void declare_done();  // asks, if that ends the session; otherwise declares it or takes it back
  void answer_done() {
    if (pages_->asks_done()) end_as_done();
  }
  void end_as_done();
  [[nodiscard]] std::size_t open_steps() const;
  void end_diary();  // when the servo has stopped

  // ---- mill_steps.cpp
  // What the mode of the session refuses is refused here, whatever key, button or pad it came from.
  [[nodiscard]] bool allows(Action action) const;
  void say_refused();
  void begin_steps();
  void look_at_measure();
  void tell(const guidance::Steps::Events& events);
  void step_done();
  void light_target();
  void look_at_technique();
  void look_at_injury();
  [[nodiscard]] std::string cue_text() const;
  void draw_steps_panel();
  [[nodiscard]] bool steps_offered() const {
    return !steps_.empty() && options_.allowed.steps != workshop::Offer::never;
  }

  // ---- mill_names.cpp
  // In an exam without the tissues' colours there are no names either.
  [[nodiscard]] bool names_offered() const { return options_.allowed.colours; }
  void look_at_names();
  [[nodiscard]] math::Vec3 slices_through();
  void show_structures();
  void pin_under_pointer();
  void draw_name();
  void draw_pins();
  void draw_side_panel();
  void toggle_structure(volume::TissueId id);
  void pin_structure(volume::TissueId id);
  void draw_orientation();
  // Below the button at the top right [points].
  [[nodiscard]] float cube_top() const { return options_.done_ends ? 66.0F : 10.0F; }

  // ---- mill_status.cpp
  void look_at_session();
  void draw_tool();
  void keep_device_preferences();
  void keep_fault_of(const device::Device& hand, const tick::FaultReport& fault);
  void update_status();
  void note(std::string text);             // "": no message
  [[nodiscard]] std::string hint() const;  // how the mouse mills
  void note_troubles();
  void panels();
  void pages();
  void leave_picture();
  [[nodiscard]] HudState hud() const;
  [[nodiscard]] ToolbarState bar_state() const;
  [[nodiscard]] float column() const;  // width at the right that slices cover [pixel]

  Desk& desk_;
  sim::Session& session_;
  mouse::Hands hands_;
  surface::Worker& worker_;
  render::Scene& scene_;
  WindowOptions options_;
  Views views_;

  // the page
  bool open_ = true, picture_ = false, panels_;
  bool time_over_ = false;
  bool leaves_ = false;  // leave, even if a file is still being written
  Closed closed_ = Closed::window;
  std::optional<OverPages> pages_;  // these three: made by begin()
  std::optional<Slices> slices_;
  std::optional<SavedViews> saved_views_;
  Leaf leaf_ = Leaf::task;  // of the panel beside the tools
  bool task_read_ = false;  // bone has been removed
  guidance::Steps steps_;
  std::optional<guidance::StepWatch> watch_;   // made by begin(), before the session starts
  std::optional<PieceMode> pieces_;            // likewise
  std::optional<tick::ToolMode> mode_before_;  // of the tool, while a piece is taken by a real hand
  bool steps_begun_ = false;
  std::string lit_step_;       // whose target is lit, or was lit last
  double removed_before_ = 0;  // up to the picture before [m^3]
  StepLight light_;
  guidance::Technique technique_;
  guidance::Technique::Cue cue_ = guidance::Technique::Cue::none;
  bool slices_shown_ = true, labels_ = true, pulls_window_ = false;
  std::vector<render::Colour> colours_;    // of the tissues, while labels are shown
  std::optional<Structures> structures_;   // made by begin(), before the session starts
  std::optional<Structures::Seen> under_;  // the pointer, in the bone
  std::optional<volume::TissueId> under_in_slice_;
  Clock::time_point named_{};  // when these two were found, and distances measured
  PinnedLabels pins_;
  ViewTurn view_turn_;
  std::optional<Menu> menu_;                      // which one is open
  static constexpr double kSuctionBeside = 3e-3;  // its reach beyond the burr [m]
  bool suction_ = false;
  Clock::time_point sucked_{};
  std::optional<math::Vec3> through_;  // the slices, where bone was last
  int picture_step_ = 0;
  int renewed_ = 0;  // the window, so far: its textures are new
  Clock::time_point window_drawn_{};

  // the hand
  WornHeadset headset_;
  Pointer pointer_;
  Press press_;
  std::optional<std::uint32_t> to_front_;  // when the window came to the front, in SDL's time [ms]
  HandPlane plane_;
  struct Lifts {  // haptic device: stopped by the user; lifted by key or foot, to be moved
    bool stopped = false, by_key = false, by_foot = false;
  } lifts_;
  std::array<bool, 4> aim_keys_ = {};  // these keys are held: left, right, down, up
  bool pad_lifts_ = false;
  int hands_there_ = -1;
  Clock::time_point hands_taken_{};
  mouse::MouseAim aim_;
  SuctionTube tube_;

  // the work
  Measuring measuring_;
  MirrorMode mirror_;
  Drill drill_;
  ToolRack rack_;
  mouse::Grip grip_;
  std::vector<math::Vec3> places_;  // on the cutting parts of the tool `placed_` [m]
  int placed_ = -1;
  workshop::ToolLooks looks_;  // of tools other than the round burr
  render::HeldTool held_;      // how a tool without an orientation of its own is drawn
  Clock::time_point held_at_{};

  // what the user reads
  tick::TickRow row_;
  TickWatch ticks_;
  std::optional<HudState::Nearest> nearest_;
  std::string near_;  // the structure that the user is warned of; empty: none
  guidance::InjuryWatch injury_;
  StatusLine status_;
  std::string note_, warning_;  // as shown
  Clock::time_point said_{};
};

// As flag_words(), in the user's language, without the flags that the page shows in other ways.
[[nodiscard]] std::string flag_texts(std::uint32_t flags);

}  // namespace burr::app
