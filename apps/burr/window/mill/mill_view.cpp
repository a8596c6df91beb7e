// How the user looks at the bone: views, microscope, colours of tissues.
#include <algorithm>
#include <cmath>

#include "shared/word_names.h"
#include "window/mill/mill.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kTurn = 0.006;  // of the view, per pixel of the mouse  [rad]

}  // namespace

// in pixels of the mouse; an arrow key counts as some of them
void Mill::turn_view(double right, double up, bool shift) {
  view_turn_.stop();
  if (shift)
    render::pan(scene_.camera, right / pointer_.height(), up / pointer_.height());
  else
    render::orbit(scene_.camera, kTurn * desk_.settings.turn_pace * right,
                  kTurn * desk_.settings.turn_pace * up);
}

// Shows each tissue in its own colour, or all as bone.
void Mill::show_labels(bool shown) {
  shown = shown && options_.allowed.colours;
  if (light_.is_on()) light_target();  // it has changed these colours
  labels_ = shown;
  scene_.tissue_colours = shown ? colours_ : render::as_bone(colours_);
  structures_->hide_in(scene_.tissue_colours);
}

double Mill::aspect() const {
  return static_cast<double>(desk_.renderer().width()) / std::max(1, desk_.renderer().height());
}

void Mill::take_view(ViewKind kind) {
  constexpr Word kNames[] = {Word::view_microscope, Word::view_whole, Word::view_endoscope,
                             Word::view_free};
  const Vec3 work =
      row_.contact.touching ? row_.contact.proxy : aim_.bone_below().value_or(scene_.camera.target);
  views_.go(kind, scene_, work, aspect());
  note(word(kNames[static_cast<int>(kind)]));
}

void Mill::first_view() { views_.first(scene_, aspect()); }

// A step of the microscope's, or nearer without steps. by: steps of the wheel.
void Mill::magnify(double by) {
  if (!views_.magnify(by, scene_)) return render::zoom(scene_.camera, std::pow(1.15, by));
  const double field = scene_.camera.view_height();
  note(say(Word::view_field, render::kFields[render::kFirstField] / field, 1e3 * field));
}

// Depth of field under the microscope, on or off.
void Mill::deep_or_not() {
  if (views_.kind() != ViewKind::microscope) return note(word(Word::focus_scope));
  views_.deep(!views_.deep());
  note(word(views_.deep() ? Word::focus_on : Word::focus_off));
}

void Mill::refocus(double by) {
  note(views_.refocus(by) ? say(Word::focus_at, 1e3 * views_.beyond()) : word(Word::focus_scope));
}

// Saves the present view, or returns to a saved one.
void Mill::saved_view(int slot, bool keep) {
  if (keep) {
    const Status kept =
        saved_views_->keep(slot, {scene_.camera, scene_.look.opacity, labels_, slices_shown_});
    return note(kept ? say(Word::view_kept, slot) : kept.error().text);
  }
  const auto view = saved_views_->at(slot);
  if (!view) return note(say(Word::view_none, slot, slot + 4));
  scene_.camera = view->camera;
  views_.placed(scene_);
  scene_.look.opacity = options_.allowed.see_through ? view->opacity : 1;
  show_labels(view->labels);
  slices_shown_ = view->slices;
  note(say(Word::view_shown, slot));
}

}  // namespace burr::app
