#include "window/mill/mill_view.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "shared/word_names.h"
#include "window/mill/views_bar.h"
#include "window/parts/hud.h"
#include "window/parts/see_through.h"

namespace burr::app {
namespace {

using math::Vec3;

constexpr double kTurn = 0.006;  // of the view, per pixel of the mouse  [rad]

}  // namespace

MillView::MillView(const MillSite& site, MillCase& work_case, const Pointer& pointer)
    : desk_(site.desk),
      bone_(site.session.bone()),
      scene_(site.scene),
      options_(site.options),
      notes_(site.notes),
      over_(site.over),
      case_(work_case),
      pointer_(pointer),
      views_(site.options, site.scene.camera) {}

void MillView::begin() {
  colours_ = scene_.tissue_colours;
  structures_.emplace(bone_, options_.lesson ? &*options_.lesson : nullptr,
                      options_.work_case ? &*options_.work_case : nullptr);
  through_ = scene_.camera.target;  // the work
  slices_.emplace(bone_, options_.greys);
  const std::filesystem::path& state = desk_.places().state;
  saved_views_.emplace(state.empty() ? state : state / "views.toml", key_of(bone_.grid()));
  notes_.note(saved_views_->trouble());
  show_labels(labels_);  // an exam begins without the colours of the tissues
  first();
  // without a graphics card it would cost every third picture
  views_.deep(!desk_.renderer().software());
}

void MillView::end() {
  views_.end(scene_);
  scene_.insets.clear();
  scene_.tissue_colours = colours_;
  scene_.look.opacity = 1;
}

void MillView::turn(double right, double up, bool shift) {
  view_turn_.stop();
  if (shift)
    render::pan(scene_.camera, right / pointer_.height(), up / pointer_.height());
  else
    render::orbit(scene_.camera, kTurn * desk_.settings.turn_pace * right,
                  kTurn * desk_.settings.turn_pace * up);
}

void MillView::show_labels(bool shown) {
  shown = shown && options_.allowed.colours;
  case_.light_off();  // it has changed these colours
  labels_ = shown;
  scene_.tissue_colours = shown ? colours_ : render::as_bone(colours_);
  structures_->hide_in(scene_.tissue_colours);
}

void MillView::toggle_labels() {
  if (!options_.allowed.colours) return case_.say_refused();
  show_labels(!labels_);
}

void MillView::step_opacity(bool back) {
  if (!options_.allowed.see_through) return case_.say_refused();
  notes_.note(step_see_through(scene_, back));
}

double MillView::aspect() const {
  return static_cast<double>(desk_.renderer().width()) / std::max(1, desk_.renderer().height());
}

void MillView::take(ViewKind kind, const Vec3& at) {
  constexpr Word kNames[] = {Word::view_microscope, Word::view_whole, Word::view_endoscope,
                             Word::view_free};
  views_.go(kind, scene_, at, aspect());
  notes_.note(word(kNames[static_cast<int>(kind)]));
}

void MillView::face(const Vec3& at, const Vec3& outward, double radius) {
  view_turn_.stop();
  views_.face(scene_, at, outward, radius);
}

void MillView::first() { views_.first(scene_, aspect()); }

void MillView::magnify(double by) {
  if (!views_.magnify(by, scene_)) return render::zoom(scene_.camera, std::pow(1.15, by));
  const double field = scene_.camera.view_height();
  notes_.note(say(Word::view_field, render::kFields[render::kFirstField] / field, 1e3 * field));
}

void MillView::deep_or_not() {
  if (views_.kind() != ViewKind::microscope) return notes_.note(word(Word::focus_scope));
  views_.deep(!views_.deep());
  notes_.note(word(views_.deep() ? Word::focus_on : Word::focus_off));
}

void MillView::refocus(double by) {
  notes_.note(views_.refocus(by) ? say(Word::focus_at, 1e3 * views_.beyond())
                                 : word(Word::focus_scope));
}

void MillView::saved(int slot, bool keep) {
  if (keep) {
    const Status kept =
        saved_views_->keep(slot, {scene_.camera, scene_.look.opacity, labels_, slices_shown_});
    return notes_.note(kept ? say(Word::view_kept, slot) : kept.error().text);
  }
  const auto view = saved_views_->at(slot);
  if (!view) return notes_.note(say(Word::view_none, slot, slot + 4));
  scene_.camera = view->camera;
  views_.placed(scene_);
  scene_.look.opacity = options_.allowed.see_through ? view->opacity : 1;
  show_labels(view->labels);
  slices_shown_ = view->slices;
  notes_.note(say(Word::view_shown, slot));
}

// The slices go through the bone under the pointer while the burr hovers, and through the burr while
// it works. Where there is no bone they stay where bone was last: a black picture says nothing.
void MillView::find_through(const std::optional<Vec3>& below) {
  const Vec3& tip = scene_.burr.world_from_tool.p;
  constexpr double kNear = 8e-3;  // of a patch of surface: the slices show bone [m]
  const auto near = [&](const render::ScenePatch& patch) {
    if (patch.mesh == nullptr) return false;
    const Vec3 beyond = (patch.box.lo - tip).cwiseMax(tip - patch.box.hi).cwiseMax(Vec3::Zero());
    return beyond.norm() < kNear;
  };
  if (below)
    through_ = *below;
  else if (std::any_of(scene_.patches.begin(), scene_.patches.end(), near))
    through_ = tip;
}

void MillView::step(const std::optional<Vec3>& below) {
  view_turn_.step(scene_.camera, ViewTurn::Clock::now());
  find_through(below);
  slices_->update(scene_, through_, slices_shown_ && over_.panels, labels_,
                  desk_.renderer().width(), desk_.renderer().height(),
                  static_cast<int>(hud_height(desk_.ui())));
}

void MillView::draw_bar(Ui& ui, const Vec3& at) {
  const ViewsBar bar =
      draw_views_bar(ui, views_.kind(), scene_.camera.view_height(),
                     views_.deep() ? std::optional(views_.beyond()) : std::nullopt);
  if (bar.view) take(*bar.view, at);
  if (bar.magnify != 0) magnify(bar.magnify);
  if (bar.refocus != 0) refocus(bar.refocus);
}

void MillView::draw_orientation(Ui& ui) {
  const float u = ui.unit();
  if (const CubeFace* face =
          draw_cube(ui, scene_.camera, ui.width() - column() - 10 * u, cube_top() * u))
    view_turn_.begin(scene_.camera, *face, ViewTurn::Clock::now());
}

float MillView::column() const {
  return scene_.insets.empty()
             ? 0
             : static_cast<float>(desk_.renderer().width() - scene_.insets.front().x);
}

}  // namespace burr::app
