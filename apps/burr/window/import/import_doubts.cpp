// What burr assumed about a scan and cannot know, each with what the user can do about it.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "shared/word_names.h"
#include "window/import/import_page.h"

namespace burr::app {
namespace {

constexpr double kCrumb = 0.01;  // of the largest part: smaller ones are crumbs

}  // namespace

std::vector<ImportPage::Doubt> ImportPage::doubts() {
  std::vector<Doubt> all;
  const auto now = level();
  if (planned_ && (planned_->import.iso_by_otsu || planned_->import.iso_estimated) && !level_ &&
      now)
    all.push_back({say(Word::import_level_estimate, number_text(*now), unit_of_values()),
                   true,
                   {{word(Word::import_level_right), [this, value = *now] { set_level(value); }}}});
  for (const io::Question& question : opened_.scan->questions)
    if (question.ask == io::Ask::spacing && !(volume_.spacing_mm.array() > 0).all()) {
      const math::Vec3& mm = opened_.scan->spacing_mm;
      all.push_back({word(Word::import_spacing_missing),
                     true,
                     {{say(Word::import_spacing_take, mm.x(), mm.y(), mm.z()), [this] {
                         volume_.spacing_mm = opened_.scan->spacing_mm;
                         changed();
                       }}}});
    }
  add_parts(all);
  const auto assumed = std::count_if(labels_.begin(), labels_.end(),
                                     [](const LabelChoice& one) { return one.assumed; });
  if (assumed > 0)
    all.push_back({say(Word::import_labels_assumed, assumed, labels_.size()),
                   true,
                   {{word(Word::import_labels_right), [this] {
                       // the choices stay, so no table is needed and no new plan
                       for (LabelChoice& one : labels_) one.assumed = false;
                     }}}});
  return all;
}

void ImportPage::add_parts(std::vector<Doubt>& all) {
  const bool chosen = !volume_.keep.all() || volume_.drop_islands_mm3 > 0;
  const Remedy pick{word(Word::import_pick), [this] { picking_ = !picking_; }, picking_},
      keep_all{word(Word::import_keep_all), [this] { keep({}, 0); }};
  if (!chosen_ || recount_) {
    if (chosen) all.push_back({word(Word::import_counting), false, {pick, keep_all}});
    return;
  }
  const importing::PartsFound& found = chosen_->found;
  if (chosen) {
    std::string text = say(Word::import_parts_left, found.removed, found.count,
                           found.removed_mm3 < 10 ? fmt::format("{:.3g}", found.removed_mm3)
                                                  : fmt::format("{:.0f}", found.removed_mm3));
    if (picking_) text += std::string(" ") + word(Word::import_pick_hint);
    all.push_back({std::move(text), false, {pick, keep_all}});
    return;
  }
  if (found.count < 2) return;
  std::string text = say(Word::import_parts, found.count, 100 * found.largest_mm3 / found.mm3);
  if (found.islands > 0)
    text += " " + say(Word::import_islands, importing::kIslandMm3, found.islands);
  Doubt doubt{picking_ ? std::string(word(Word::import_pick_hint)) : std::move(text),
              true,
              {{word(Word::import_keep_largest), [this] {
                  keep({1, {}}, 0);
                }}}};
  // streaks of metal and noise leave crumbs of all sizes; a part of the anatomy is larger
  doubt.remedies.push_back({say(Word::import_crumbs, 100 * kCrumb),
                            [this, below = kCrumb * found.largest_mm3] { keep({}, below); }});
  doubt.remedies.push_back(pick);
  all.push_back(std::move(doubt));
}

void ImportPage::count() {
  if (counting_ && recount_) counting_->progress().cancel();
  if (counting_ && counting_->finished()) {
    auto found = counting_->take();
    counting_.reset();
    // what was counted while the user chose something else is forgotten
    if (found && !recount_) {
      parts_ = std::move(*found);
      choose_parts();
    }
  }
  if (!recount_ || counting_ || stale_ || planning_ || !plan_trouble_.empty() ||
      ImGui::IsMouseDown(0))
    return;
  recount_ = false;
  parts_.reset();
  chosen_.reset();
  parts_trouble_.clear();
  counting_ = std::make_unique<Loading<importing::FoundParts>>(
      [scan = opened_.scan, recipe = volume_](Progress& progress) {
        return importing::parts_of(*scan, recipe, progress);
      });
}

void ImportPage::choose_parts() {
  parts_trouble_.clear();
  chosen_.reset();
  if (parts_) {
    auto chosen = importing::choose_parts(parts_->parts, volume_, parts_->place);
    if (chosen)
      chosen_ = std::move(*chosen);
    else
      parts_trouble_ = chosen.error().text;
  }
  for (View& view : views_) view.coloured = false;
}

void ImportPage::keep(const scenario::Keep& parts, double drop_islands_mm3) {
  volume_.keep = parts;
  volume_.drop_islands_mm3 = drop_islands_mm3;
  picking_ = false;
  trouble_.clear();
  choose_parts();
}

void ImportPage::keep_here(const math::Vec3& voxel) {
  if (!parts_ || recount_) return;
  const io::Scan& scan = *opened_.scan;
  scenario::BoneRecipe here = volume_;
  here.keep = {0, {scan.origin_mm + scan.axes * voxel.cwiseProduct(scan.spacing_mm)}};
  here.drop_islands_mm3 = 0;
  if (!importing::choose_parts(parts_->parts, here, parts_->place)) {
    trouble_ = word(Word::import_no_bone_here);
    return;
  }
  trouble_.clear();
  volume_.keep.largest = 0;
  volume_.keep.at_mm.push_back(here.keep.at_mm.front());
  choose_parts();
}

}  // namespace burr::app
