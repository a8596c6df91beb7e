#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "burr/base/check.h"
#include "burr/base/printable.h"
#include "burr/metrics/cover.h"
#include "burr/metrics/filled.h"
#include "burr/metrics/identified.h"
#include "burr/metrics/intact_plate.h"
#include "burr/metrics/intact_solid.h"
#include "burr/metrics/no_cells.h"
#include "burr/metrics/opened.h"
#include "burr/metrics/overhang.h"
#include "burr/metrics/removed.h"
#include "burr/metrics/skeletonised.h"
#include "burr/scoring/measure.h"
#include "burr/scoring/score.h"

namespace burr::scoring {
namespace {

constexpr std::size_t kSamples = 600, kSamplesOfArea = 5000;

// At most kMostSpots of all, evenly; those that are bare stay, as long as there is room.
std::vector<Spot> chosen(const std::vector<Spot>& all) {
  const auto is_bare = [](const Spot& spot) { return spot.kind == Spot::Kind::bare; };
  const auto bare = static_cast<std::size_t>(std::count_if(all.begin(), all.end(), is_bare));
  const bool keep_bare = bare < kMostSpots;
  const std::size_t room = keep_bare ? kMostSpots - bare : kMostSpots;
  const std::size_t others = keep_bare ? all.size() - bare : all.size();
  const std::size_t every = std::max<std::size_t>(1, (others + room - 1) / room);
  std::vector<Spot> some;
  std::size_t n = 0;
  for (const Spot& spot : all)
    if ((keep_bare && is_bare(spot)) || n++ % every == 0) some.push_back(spot);
  return some;
}

// lo, hi: of what `length` gives for a sample; at most lo is bare, more than hi is left [m]
template <class Length>
std::vector<Spot> spots_of(const metrics::Cover& cover, double lo, double hi,
                           const Length& length) {
  std::vector<Spot> all;
  for (const metrics::CoverSample& one : cover.samples)
    all.push_back({one.surface.place, length(one) <= lo   ? Spot::Kind::bare
                                      : length(one) <= hi ? Spot::Kind::good
                                                          : Spot::Kind::left});
  return chosen(all);
}

std::vector<Spot> spots_at(const std::vector<math::Vec3>& places) {
  std::vector<Spot> all;
  for (const math::Vec3& at : places) all.push_back({at, Spot::Kind::left});
  return chosen(all);
}

Outcome identified(const Item& item, Workpiece& scene) {
  const auto& cover = scene.cover(item.structure, item.region, kSamples, true);
  if (!cover) return not_assessable(item, cover.reason());
  metrics::IdentifiedSettings settings;
  settings.x = item.limit("cover_mm");
  settings.y = item.limit("share");
  if (!item.along.empty())
    settings.course = metrics::Course{scene.lesson().landmark(item.along)->points};
  const auto found = metrics::identified(*cover, settings);
  if (!found) return not_assessable(item, found.reason());
  Outcome out = decided(item, found->mark, "share seen through thin bone", true);
  if (std::isfinite(found->least_cover) || out.verdict == Verdict::unmet)
    out.place = out.verdict == Verdict::met ? found->least_at : found->worst_at;
  out.spots = spots_of(*cover, -1, settings.x, [](const auto& one) { return one.cover; });
  return out;
}

Outcome skeletonised(const Item& item, Workpiece& scene) {
  const auto& cover = scene.cover(item.structure, item.region, kSamples, true);
  if (!cover) return not_assessable(item, cover.reason());
  const auto thin = metrics::skeletonised(
      *cover, scene.worked(),
      {item.limit("lo_mm"), item.limit("hi_mm"), item.limit("share"), item.limit("over")});
  if (!thin) return not_assessable(item, thin.reason());
  // what failed decides: laid bare, or not thin enough
  const bool bare = thin->bare.value > thin->bare.threshold;
  Outcome out = bare ? decided(item, thin->bare, "share laid bare", false)
                     : decided(item, thin->even, "share thinned evenly", true);
  out.place = bare ? thin->thinnest_at : thin->thickest_at;
  out.spots = spots_of(*cover, item.limit("lo_mm"), item.limit("hi_mm"),
                       [](const auto& one) { return one.thickness; });
  return out;
}

Outcome intact_solid(const Item& item, Workpiece& scene) {
  metrics::IntactSolidSettings settings;
  const double voxel = scene.before().grid().voxel;
  settings.v = std::max(item.limit("most_mm3"), 3 * voxel * voxel * voxel);
  const auto lost = metrics::intact_solid(scene.before(), scene.after(),
                                          scene.voxels(item.structure), scene.worked(), settings);
  if (!lost) return not_assessable(item, lost.reason());
  Outcome out = decided(item, lost->mark, "volume cut away", false);
  if (lost->mark.value > 0) out.place = lost->at;
  return out;
}

Outcome intact_plate(const Item& item, Workpiece& scene) {
  const auto& cover = scene.cover(item.structure, item.region, kSamplesOfArea, false);
  if (!cover) return not_assessable(item, cover.reason());
  metrics::IntactPlateSettings settings;
  settings.most_area = item.limit("most_mm2");
  const auto plate = metrics::intact_plate(*cover, scene.worked(), settings);
  if (!plate) return not_assessable(item, plate.reason());
  Outcome out = decided(item, plate->mark, "area laid bare", false);
  if (!plate->holes.empty()) out.place = plate->holes.front().at;
  out.spots =
      spots_of(*cover, settings.bare, metrics::kUnseen, [](const auto& one) { return one.cover; });
  return out;
}

Outcome no_cells(const Item& item, Workpiece& scene) {
  metrics::NoCellsSettings settings;
  settings.towards = scene.towards();
  settings.glass = scene.glass();
  settings.hi = item.limit("from_mm");
  settings.d = item.limit("to_mm");
  settings.most_left = item.limit("left");
  settings.most_shut = item.limit("shut");
  const auto cells =
      metrics::no_cells(scene.before(), scene.after(), *scene.distance(item.structure),
                        scene.region(item.region), settings);
  if (!cells) return not_assessable(item, cells.reason());
  const bool walls = !cells->left.met || cells->shut.met;
  Outcome out = walls ? decided(item, cells->left, "share of the walls that stand", false)
                      : decided(item, cells->shut, "share of the air still shut", false);
  const auto& shown = walls ? cells->standing : cells->hidden;
  if (out.verdict == Verdict::unmet && !shown.empty()) out.place = shown[shown.size() / 2];
  out.spots = spots_at(shown);
  return out;
}

Outcome opened(const Item& item, Workpiece& scene) {
  // the label of a room is that of its air
  const metrics::VoxelSet air = metrics::VoxelSet::of_air(
      scene.before(), scene.tissues(item.structure), scene.region(item.region));
  if (scene.tissues(item.structure).empty() || air.count() == 0)
    return not_assessable(item, fmt::format("the bone has no air with the label of \"{}\"",
                                            base::printable(item.structure)));
  metrics::OpenedSettings settings;
  settings.towards = scene.towards();
  settings.glass = scene.glass();
  settings.rho = item.limit("radius_mm");
  const auto way = metrics::opened(scene.before(), scene.after(), {.label = &air}, settings);
  if (!way) return not_assessable(item, way.reason());
  Outcome out = decided(item, way->mark, "radius of the way", true);
  if (way->mark.value > 0) out.place = way->touch;
  return out;
}

Outcome overhang(const Item& item, Workpiece& scene) {
  metrics::OverhangSettings settings;
  settings.towards = scene.towards();
  settings.most_share = item.limit("share");
  const auto under =
      metrics::overhang(scene.before(), scene.after(), scene.region(item.region), settings);
  if (!under) return not_assessable(item, under.reason());
  metrics::Mark mark = under->mark;
  mark.earned = scene.worked() >= metrics::kLeastWork;
  mark.met = mark.met && mark.earned;
  Outcome out = decided(item, mark, "share of the new surface under bone", false);
  if (!under->under.empty()) out.place = under->under[under->under.size() / 2];
  out.spots = spots_at(under->under);
  return out;
}

// removed: at least that share is gone; kept: at most
Outcome removed(const Item& item, Workpiece& scene, bool at_least) {
  const auto& gone = scene.removed(item.region);
  if (!gone) return not_assessable(item, gone.reason());
  const double share = item.limit("share");
  metrics::Mark mark =
      at_least ? metrics::Mark{gone->share >= share, true, gone->share, share, gone->error}
               : metrics::intact_mark(gone->share, share, gone->error, scene.worked());
  return decided(item, mark, "share removed", at_least);
}

// filled: at least that share of the gap holds material now; filled_beside: of what was added, at most
// that share lies outside of the gap
Outcome filled(const Item& item, Workpiece& scene, bool inside) {
  const auto full = metrics::filled_of(scene.before(), scene.after(), scene.region(item.region),
                                       {.grown = inside ? 0 : item.limit("off_mm")});
  if (!full) return not_assessable(item, full.reason());
  const double share = item.limit("share");
  if (inside)
    return decided(item, {full->share >= share, true, full->share, share, full->error},
                   "share of the gap that was filled", true);
  Outcome out =
      decided(item, metrics::intact_mark(full->stray, share, full->stray_error, full->share),
              "share of what was added that lies beside the gap", false);
  if (!out.earned) out.reason = "too little was added to say";
  return out;
}

}  // namespace

Outcome not_assessable(const Item& item, std::string reason) {
  Outcome out;
  out.id = item.id;
  out.quantity = item.how->quantity;
  out.reason = std::move(reason);
  return out;
}

Outcome decided(const Item& item, const metrics::Mark& mark, const char* what, bool at_least) {
  if (item.grade) {
    const auto [none, full] = *item.grade;
    const bool agrees = at_least ? none < mark.threshold && mark.threshold <= full
                                 : full <= mark.threshold && mark.threshold < none;
    if (!agrees)
      return not_assessable(
          item,
          "its grade contradicts its threshold: the value that earns nothing must "
          "miss the threshold, and the one that earns everything must meet it");
  }
  Outcome out;
  out.id = item.id;
  out.verdict = mark.met ? Verdict::met : Verdict::unmet;
  // what was hurt is hurt, however little was removed
  const bool good = at_least ? mark.value >= mark.threshold : mark.value <= mark.threshold;
  out.earned = mark.earned || !good;
  out.borderline = mark.earned && mark.borderline();
  if (!out.earned) out.reason = "too little was removed to say";
  out.what = what;
  out.quantity = item.how->quantity;
  out.at_least = at_least;
  out.value = mark.value;
  out.threshold = mark.threshold;
  out.error = mark.error;
  return out;
}

Outcome measure_bone(const Item& item, Workpiece& scene) {
  const std::string_view how = item.how->name;
  if (!item.structure.empty() && scene.tissues(item.structure).empty())
    return not_assessable(
        item, fmt::format("the bone has no label of \"{}\"", base::printable(item.structure)));
  if (how == "identified") return identified(item, scene);
  if (how == "skeletonised") return skeletonised(item, scene);
  if (how == "intact_solid") return intact_solid(item, scene);
  if (how == "intact_plate") return intact_plate(item, scene);
  if (how == "no_cells") return no_cells(item, scene);
  if (how == "opened") return opened(item, scene);
  if (how == "overhang") return overhang(item, scene);
  if (how == "removed") return removed(item, scene, true);
  if (how == "kept") return removed(item, scene, false);
  if (how == "filled") return filled(item, scene, true);
  if (how == "filled_beside") return filled(item, scene, false);
  if (auto shape = measure_shape(item, scene)) return *std::move(shape);
  BURR_CHECK(needs_recording(item));  // every measure is in one of the two lists
  return not_assessable(item, "it needs a recording");
}

}  // namespace burr::scoring
