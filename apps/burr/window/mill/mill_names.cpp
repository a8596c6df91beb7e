// Names of structures on the page: under the pointer, in the list, pinned; and where the slices go.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include "shared/word_names.h"
#include "window/mill/mill.h"
#include "window/mill/side_panel.h"
#include "window/mill/task_panel.h"

namespace burr::app {

using math::Vec3;
using volume::TissueId;

// Ten times a second: what lies under the pointer, and, while the list is open, the distances.
void Mill::look_at_names() {
  const Clock::time_point now = Clock::now();
  if (now - named_ < std::chrono::milliseconds(100)) return;
  named_ = now;
  under_.reset();
  under_in_slice_.reset();
  if (!names_offered() || !panels_ || page_open() || pointer_.over_panel()) return;
  if (leaf_ == Leaf::structures && options_.allowed.distance)
    structures_->measure(scene_.burr.world_from_tool.p, scene_.burr.radius);
  const Eigen::Vector2d at = pointer_.in_picture();
  if (const auto point = slices_->point_at(scene_, at.x(), at.y())) {
    const TissueId id = structures_->at(*point);
    if (id != 0) under_in_slice_ = id;
    return;
  }
  if (!pressing()) under_ = structures_->under(scene_, pointer_.mouse());
}

// The slices go through the bone under the pointer while the burr hovers, and through the burr while
// it works. Where there is no bone they stay where bone was last: a black picture says nothing.
Vec3 Mill::slices_through() {
  const Vec3& tip = scene_.burr.world_from_tool.p;
  constexpr double kNear = 8e-3;  // of a patch of surface: the slices show bone [m]
  const auto near = [&](const render::ScenePatch& patch) {
    if (patch.mesh == nullptr) return false;
    const Vec3 beyond = (patch.box.lo - tip).cwiseMax(tip - patch.box.hi).cwiseMax(Vec3::Zero());
    return beyond.norm() < kNear;
  };
  if (aim_.bone_below() && hands_.real == nullptr)
    through_ = *aim_.bone_below();
  else if (std::any_of(scene_.patches.begin(), scene_.patches.end(), near))
    through_ = tip;
  return through_.value_or(tip);
}

void Mill::show_structures() {
  if (!names_offered()) return say_refused();
  leaf_ = leaf_ == Leaf::structures ? Leaf::none : Leaf::structures;
}

void Mill::toggle_structure(TissueId id) {
  structures_->toggle(id);
  show_labels(labels_);
}

// At the voxel nearest to the structure's middle.
void Mill::pin_structure(TissueId id) {
  if (const auto place = structures_->place(id)) pins_.toggle(id, *place);
}

// Where the pointer is, so that the line ends at what the user sees.
void Mill::pin_under_pointer() {
  if (!names_offered()) return say_refused();
  if (under_)
    pins_.toggle(under_->id, under_->at);
  else if (under_in_slice_)
    pin_structure(*under_in_slice_);
  else
    note(word(Word::names_nothing));
}

// Beside the pointer, and never while the burr works.
void Mill::draw_name() {
  const auto id = under_ ? std::optional(under_->id) : under_in_slice_;
  if (!id || pressing() || pointer_.over_panel()) return;
  const Ui& ui = desk_.ui();
  const float u = ui.unit(), high = 24 * u;
  const std::string name = structures_->name(*id);
  const float wide = ui.width_of(Ui::Letter::body, name) + 34 * u;
  const Eigen::Vector2d at = pointer_.in_picture();
  float x = static_cast<float>(at.x()) + 20 * u, y = static_cast<float>(at.y()) - 40 * u;
  x = std::min(x, ui.width() - wide - 4 * u);
  if (y < 4 * u) y = static_cast<float>(at.y()) + 26 * u;
  y = std::min(y, ui.height() - hud_height(ui) - high - 4 * u);  // the strip stays readable
  ImDrawList& draw = *ImGui::GetForegroundDrawList();
  draw.AddRectFilled({x, y}, {x + wide, y + high}, ink::kPanel, 5 * u);
  draw.AddRectFilled({x + 8 * u, y + 7 * u}, {x + 18 * u, y + 17 * u},
                     swatch_of(structures_->tissue(*id)), 2 * u);
  const ImFont* font = ui.font(Ui::Letter::body);
  draw.AddText(font, font->FontSize,
               {std::round(x + 26 * u), std::round(y + (high - font->FontSize) / 2)}, ink::kText,
               name.c_str());
}

void Mill::draw_pins() {
  if (pins_.empty() || !names_offered()) return;
  const Ui& ui = desk_.ui();
  const float u = ui.unit();
  const float left = leaf_ == Leaf::none ? kSideLeft : kSideLeft + kSideWide + 10;
  const float top = cube_top() + kCube + 8;  // the cube and the button above it stay free
  pins_.draw(
      ui, scene_.camera,
      {left * u, ui.width() - column() - 10 * u, top * u, ui.height() - hud_height(ui) - 44 * u},
      [this](TissueId id) { return structures_->name(id); },
      [this](TissueId id) { return swatch_of(structures_->tissue(id)); });
}

void Mill::draw_side_panel() {
  Ui& ui = desk_.ui();
  const bool task = options_.work_case.has_value(), steps = steps_offered();
  if (leaf_ == Leaf::task && !task) leaf_ = Leaf::none;
  if (leaf_ == Leaf::steps && !steps) leaf_ = Leaf::none;
  if (leaf_ == Leaf::structures && !names_offered()) leaf_ = Leaf::none;
  if (leaf_ == Leaf::none || menu_) return;  // the menu takes its place
  if (const auto pressed = draw_side_tabs(ui, leaf_, task, steps, names_offered()))
    leaf_ = *pressed;
  switch (leaf_) {
    case Leaf::none:
      break;
    case Leaf::task:
      if (draw_task(ui, *options_.work_case, options_.lesson ? &*options_.lesson : nullptr))
        leaf_ = Leaf::none;
      break;
    case Leaf::steps:
      draw_steps_panel();
      break;
    case Leaf::structures: {
      const StructuresPressed pressed =
          draw_structures(ui, *structures_, pins_, options_.allowed.distance);
      if (pressed.toggle) toggle_structure(*pressed.toggle);
      if (pressed.pin) pin_structure(*pressed.pin);
      break;
    }
  }
}

void Mill::draw_orientation() {
  Ui& ui = desk_.ui();
  const float u = ui.unit();
  if (const CubeFace* face =
          draw_cube(ui, scene_.camera, ui.width() - column() - 10 * u, cube_top() * u))
    view_turn_.begin(scene_.camera, *face, Clock::now());
}

}  // namespace burr::app
