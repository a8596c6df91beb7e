#include "window/parts/toolbar.h"

#include <fmt/format.h>

#include <string>

#include "shared/word_names.h"
#include "window/parts/icons.h"
#include "window/ui/printed_keys.h"

namespace burr::app {
namespace {

using Button = BarButton;
using Line = BarLine;

class Bar {
 public:
  Bar(Ui& ui, std::optional<Action>& pressed, std::vector<BarPlace>* places)
      : ui_(ui), pressed_(pressed), places_(places), u_(ui.unit()) {}

  // the icon above its name
  void tall(const Button& b, bool chosen = false) {
    const ImVec2 p = ImGui::GetCursorScreenPos(), size = {66 * u_, 34 * u_};
    body(b, p, size, chosen);
    const ImU32 shade = chosen ? ink::kAccent : ink::kText;
    icon(*ImGui::GetWindowDrawList(), b.action, {p.x + size.x / 2, p.y + 11 * u_}, 8 * u_, shade);
    ui_.write(p.x + size.x / 2, p.y + 19 * u_, Ui::Letter::small, chosen ? ink::kText : ink::kDim,
              word(b.name), 0.5F);
  }

  // two buttons side by side, for less and more, below the name of what they change
  void pair(Word name, const Button& less, const Button& more, bool less_chosen = false,
            bool more_chosen = false) {
    const ImVec2 p = ImGui::GetCursorScreenPos();
    ui_.write(p.x + 33 * u_, p.y + 1 * u_, Ui::Letter::small, ink::kDim, word(name), 0.5F);
    two({p.x, p.y + 18 * u_}, less, more, less_chosen, more_chosen);
  }

  // the same without a name
  void row(const Button& left, const Button& right, bool left_chosen = false,
           bool right_chosen = false) {
    two(ImGui::GetCursorScreenPos(), left, right, left_chosen, right_chosen);
  }

  void gap(float points) { ImGui::Dummy({1, points * u_}); }

 private:
  void two(ImVec2 p, const Button& left, const Button& right, bool left_chosen, bool right_chosen) {
    int n = 0;
    for (const Button* b : {&left, &right}) {
      const ImVec2 at = {p.x + static_cast<float>(n++) * 35 * u_, p.y};
      ImGui::SetCursorScreenPos(at);
      const bool chosen = b == &left ? left_chosen : right_chosen;
      body(*b, at, {31 * u_, 26 * u_}, chosen);
      icon(*ImGui::GetWindowDrawList(), b->action, {at.x + 15.5F * u_, at.y + 13 * u_}, 7 * u_,
           chosen ? ink::kAccent : ink::kText);
    }
  }

  void body(const Button& b, ImVec2 p, ImVec2 size, bool chosen) {
    ImGui::PushID(static_cast<int>(b.action));
    if (ImGui::InvisibleButton("##b", size)) pressed_ = b.action;
    if (places_ != nullptr) places_->push_back({b.action, p.x, p.y, size.x, size.y});
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 q = {p.x + size.x, p.y + size.y};
    if (ImGui::IsItemHovered()) {
      draw.AddRectFilled(p, q, ink::kOver, 6 * u_);
      std::string name = word(b.name);
      if (name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
      ImGui::SetTooltip("%s  ( %s )", name.c_str(), b.key);
    } else if (size.x < 40 * u_) {
      draw.AddRectFilled(p, q, ink::kButton, 6 * u_);
    }
    if (chosen) {  // a frame, so that not only colour shows the choice
      draw.AddRectFilled(p, q, ink::rgb(86, 180, 233, 40), 6 * u_);
      draw.AddRect(p, q, ink::kAccent, 6 * u_, 0, 1.5F * u_);
    }
    ImGui::PopID();
  }

  Ui& ui_;
  std::optional<Action>& pressed_;
  std::vector<BarPlace>* places_;
  float u_;
};

// The order of an operation: burr, water, view, what is read and kept; then what changes bone in
// other ways; then the program.
std::vector<Line> lines() {
  return {
      {{}, {Action::cut, Word::cut, "1"}, {}},
      {{}, {Action::rack, Word::rack, "7"}, {}},
      {Word::burr,
       {Action::smaller, Word::smaller, smaller_key()},
       Button{Action::larger, Word::larger, larger_key()}},
      {{}, {Action::kind, Word::help_kind, "K"}, Button{Action::coolant, Word::help_coolant, "I"}},
      {{}, {Action::suction, Word::help_suction, "6"}, Button{Action::touch, Word::touch, "3"}},
      {Word::speed, {Action::slower, Word::slower, ","}, Button{Action::faster, Word::faster, "."}},
      {Word::stroke, {Action::undo, Word::undo, "U"}, Button{Action::redo, Word::redo, "Y"}},
      {Word::help_view,
       {Action::slices, Word::help_slices, "V"},
       Button{Action::see_through, Word::help_see_through, "T"}},
      {{},
       {Action::views, Word::menu_views, "F, F5 - F8"},
       Button{Action::structures, Word::help_names, "F4"}},
      {Word::bar_session,
       {Action::task, Word::help_task, "O"},
       Button{Action::keep, Word::key_save, "S"}},
      {{},
       {Action::picture, Word::help_picture, "P"},
       Button{Action::sound, Word::help_sound, "M"}},
      {Word::help_tools,
       {Action::measure, Word::measure, "D"},
       Button{Action::mirror, Word::mirror, "X"}},
      {{}, {Action::add, Word::add, "2"}, Button{Action::smooth, Word::smooth, "5"}},
      {{}, {Action::back, Word::back, "4"}, Button{Action::reset, Word::reset, "R"}, 4},
      {{},
       {Action::export_, Word::export_word, "E"},
       Button{Action::settings, Word::settings, "F2"}},
      {{}, {Action::menu, Word::menu_all, "F10"}, Button{Action::help, Word::help, "F1"}},
      {{}, {Action::leave, Word::leave, "Q"}, {}},
  };
}

bool is_on(const ToolbarState& state, Action action) {
  switch (action) {
    case Action::cut:
      return state.mode == tick::ToolMode::cut;
    case Action::add:
      return state.mode == tick::ToolMode::add;
    case Action::touch:
      return state.mode == tick::ToolMode::touch;
    case Action::back:
      return state.mode == tick::ToolMode::restore;
    case Action::smooth:
      return state.mode == tick::ToolMode::smooth;
    case Action::measure:
      return state.measures;
    case Action::mirror:
      return state.mirrors;
    case Action::kind:
      return state.diamond;
    case Action::coolant:
      return state.coolant;
    case Action::suction:
      return state.suction;
    case Action::slices:
      return state.slices;
    case Action::see_through:
      return state.see_through;
    case Action::views:
      return state.views;
    case Action::structures:
      return state.structures;
    case Action::task:
      return state.task;
    case Action::sound:
      return state.sound;
    case Action::menu:
      return state.menu;
    case Action::rack:
      return state.rack;
    default:
      return false;
  }
}

}  // namespace

std::vector<Action> toolbar_actions() {
  std::vector<Action> all;
  for (const Line& line : lines()) {
    all.push_back(line.left.action);
    if (line.right) all.push_back(line.right->action);
  }
  return all;
}

std::optional<Action> draw_bar(Ui& ui, const std::vector<BarLine>& lines, float high, float free,
                               const std::function<bool(Action)>& is_on,
                               std::vector<BarPlace>* places) {
  std::optional<Action> pressed;
  const float u = ui.unit();
  const float h = high * u, w = 82 * u;
  const float y = std::max(6 * u, (free - h) / 2);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * u, 8 * u});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4 * u, 3 * u});
  ui.panel("##tools", 10 * u, y, w, h);
  Bar bar(ui, pressed, places);
  for (const Line& line : lines) {
    const bool left = is_on(line.left.action);
    if (!line.right)
      bar.tall(line.left, left);
    else if (line.heading)
      bar.pair(*line.heading, line.left, *line.right, left, is_on(line.right->action));
    else
      bar.row(line.left, *line.right, left, is_on(line.right->action));
    if (line.gap > 0) bar.gap(line.gap);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return pressed;
}

std::optional<Action> draw_toolbar(Ui& ui, const ToolbarState& state) {
  constexpr float kHigh = 645, kStrip = 78;  // [points]
  return draw_bar(ui, lines(), kHigh, ui.height() - kStrip * ui.unit(),
                  [&state](Action action) { return is_on(state, action); });
}

}  // namespace burr::app
