#include "burr/proof/tricks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>

#include "burr/base/check.h"
#include "burr/metrics/measured.h"
#include "burr/people/random_stream.h"
#include "burr/scoring/reference.h"
#include "burr/volume/copy_of_bone.h"
#include "burr/volume/cut_by_depth.h"
#include "burr/workshop/open_bone.h"

namespace burr::proof {
namespace {

using math::Vec3;
using metrics::Region;

constexpr double kEverywhere = 1;        // deeper than any bone [m]
constexpr double kSeal = 0.7e-3;         // of added bone over a structure [m]
constexpr double kShaft = 0.5e-3;        // radius of a peep-hole [m]
constexpr double kBetweenShafts = 3e-3;  // from one to the next [m]
constexpr double kBeside = 2e-3;         // from the plan to the half that goes [m]
constexpr double kStroke = 10e-3;        // length of a random one [m]
constexpr int kMostStrokes = 400;

Region everywhere() {
  return [](const Vec3&) { return kEverywhere; };
}

// Where the planned bone lies, seen by the surgeon: x and y across the look, z towards the surgeon.
struct Place {
  Vec3 across = Vec3::UnitX(), up = Vec3::UnitY(), towards = Vec3::UnitZ();
  Vec3 low = Vec3::Constant(1e9), high = Vec3::Constant(-1e9);  // of the planned bone [m]
  double planned = 0;                                           // volume of it [m^3]

  [[nodiscard]] Vec3 seen(const Vec3& p) const {
    return {p.dot(across), p.dot(up), p.dot(towards)};
  }
  [[nodiscard]] Vec3 world(const Vec3& s) const {
    return s.x() * across + s.y() * up + s.z() * towards;
  }
};

template <class Visit>
void for_each_solid(const volume::Bone& bone, const Visit& visit) {
  constexpr int kEdge = volume::kBrickEdge;
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::Field* field = bone.brick_field(brick);
    if (field == nullptr) continue;
    const math::Ijk first = bone.brick_ijk(brick);
    for (int n = 0; n < volume::kBrickVoxels; ++n)
      if (field[n] >= volume::kIso)
        visit(bone.grid().world_from_grid(
            (first + math::Ijk(n % kEdge, n / kEdge % kEdge, n / (kEdge * kEdge))).cast<double>()));
  }
}

Place place_of(const volume::Bone& before, const Region& plan, const Vec3& towards) {
  Place place;
  place.towards = towards.normalized();
  const Vec3 other = std::abs(place.towards.x()) < 0.9 ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitZ());
  place.up = place.towards.cross(other).normalized();
  place.across = place.up.cross(place.towards);
  const double voxel = std::pow(before.grid().voxel, 3);
  for_each_solid(before, [&](const Vec3& p) {
    if (plan(p) < 0) return;
    const Vec3 s = place.seen(p);
    place.low = place.low.cwiseMin(s);
    place.high = place.high.cwiseMax(s);
    place.planned += voxel;
  });
  return place;
}

Region shifted(Region region, const Vec3& by) {
  return [region = std::move(region), by](const Vec3& p) { return region(p - by); };
}

// Shafts along the look, in rows.
Region shafts(const Place& place) {
  return [place](const Vec3& p) {
    const Vec3 s = place.seen(p);
    const auto off = [](double x) { return x - kBetweenShafts * std::round(x / kBetweenShafts); };
    return kShaft - std::hypot(off(s.x()), off(s.y()));
  };
}

Region above(const Place& place, double height) {
  return metrics::in_half_space(height * place.towards, -place.towards);
}

// Strokes of the burr across the surface over the plan, until they are as much as the plan.
Region random_strokes(const Place& place, double burr, std::uint64_t seed) {
  people::RandomStream random(seed);
  const double volume = M_PI * 0.25 * burr * burr * kStroke;
  const int count =
      std::clamp(static_cast<int>(std::ceil(2 * place.planned / volume)), 1, kMostStrokes);
  const Vec3 size = place.high - place.low;
  Region all;
  for (int n = 0; n < count; ++n) {
    const auto one = [&random] { return random.uniform(); };
    const Vec3 at = place.low + size.cwiseProduct(Vec3(one(), one(), one()));
    const double angle = 2 * M_PI * one();
    const Vec3 way = 0.5 * kStroke * Vec3(std::cos(angle), std::sin(angle), 0);
    Region stroke = metrics::in_capsule(place.world(at - way), place.world(at + way), 0.5 * burr);
    all = all ? metrics::either(std::move(all), std::move(stroke)) : std::move(stroke);
  }
  return all;
}

// A layer of added bone on all structures.
Region seal(const std::vector<scoring::SparedStructure>& structures) {
  Region all;
  for (const scoring::SparedStructure& one : structures) {
    Region layer = [distance = one.distance](const Vec3& p) {
      const double d = distance->at(p).distance;
      return std::isfinite(d) ? std::min(kSeal - d, d) : -kEverywhere;
    };
    all = all ? metrics::either(std::move(all), std::move(layer)) : std::move(layer);
  }
  return all;
}

// By the size of the plan, so that none of it is where it belongs. A smaller shift is an error that the items grade.
void add_shifted(const Place& place, const Region& plan, double burr, std::vector<Trick>& all) {
  const Vec3 size = place.high - place.low;
  const double aside = size.x() + burr, along = size.y() + burr;
  const std::pair<const char*, Vec3> ways[] = {{"to one side", aside * place.across},
                                               {"to the other side", -aside * place.across},
                                               {"upwards", along * place.up},
                                               {"downwards", -along * place.up}};
  for (const auto& [word, way] : ways)
    all.push_back({fmt::format("shifted {}", word),
                   fmt::format("the plan is cut exactly, {:.0f} mm {}", 1e3 * way.norm(), word),
                   {shifted(plan, way)},
                   {}});
}

// How deep the cut reaches into a structure, as a burr would that cut it [m]; 0: it does not.
double depth_into(const volume::Bone& before, const scoring::SparedStructure& structure,
                  const std::vector<Region>& cut) {
  double most = 0;
  const volume::Grid& grid = before.grid();
  for (volume::BrickIndex brick = 0; brick < before.brick_count(); ++brick) {
    const math::Ijk first = before.brick_ijk(brick);
    for (int n = 0; n < volume::kBrickVoxels; ++n) {
      const math::Ijk at = first + math::Ijk(n & 7, (n >> 3) & 7, n >> 6);
      if (!grid.contains(at)) continue;
      const volume::TissueId id = before.tissue(at.x(), at.y(), at.z());
      if (std::find(structure.tissues.begin(), structure.tissues.end(), id) ==
          structure.tissues.end())
        continue;
      const Vec3 p = grid.world_from_grid(at.cast<double>());
      for (const Region& one : cut) most = std::max(most, one(p));
    }
  }
  return most;
}

class Trial {
 public:
  Trial(const scoring::Rubric& rubric, const scenario::CaseLesson& lesson,
        const volume::Bone& before, std::vector<scoring::SparedStructure> spared)
      : rubric_(rubric),
        alone_(rubric),
        lesson_(lesson),
        before_(before),
        spared_(std::move(spared)) {
    for (scoring::Item& item : alone_.items)
      if (const scoring::Item* other = rubric.item(item.needs);
          other != nullptr && scoring::needs_recording(*other))
        item.needs.clear();
  }

  [[nodiscard]] Result<Tried> judge(const Trick& trick, const volume::Bone& after,
                                    Progress& progress) const {
    auto score = scoring::score(alone_, lesson_, before_, after, nullptr, progress);
    if (!score) return score.error();
    const bool worked = score->worked >= metrics::kLeastWork;
    for (std::size_t n = 0; n < rubric_.items.size(); ++n) {
      const scoring::Item& item = rubric_.items[n];
      if (item.part != scoring::Part::product || !scoring::needs_recording(item)) continue;
      scoring::Outcome& outcome = score->outcomes[n];
      const bool harmed = entered(item, trick);
      outcome = {};
      outcome.id = item.id;
      outcome.verdict = worked && !harmed ? scoring::Verdict::met : scoring::Verdict::unmet;
      outcome.earned = worked || harmed;
    }
    scoring::apply_requires(rubric_, score->outcomes);
    const scoring::Total product =
        scoring::total_of(rubric_, score->outcomes, scoring::Part::product);
    return Tried{trick.name, trick.how, std::move(score->outcomes), product, score->no_mark};
  }

 private:
  [[nodiscard]] bool entered(const scoring::Item& item, const Trick& trick) const {
    if (item.how->name != std::string("intact_soft")) return false;
    for (const scoring::SparedStructure& one : spared_)
      if (one.name == item.structure)
        return depth_into(before_, one, trick.cut) > item.limit("deep_mm");
    return false;
  }

  const scoring::Rubric& rubric_;
  scoring::Rubric alone_;  // no item requires one that needs a recording
  const scenario::CaseLesson& lesson_;
  const volume::Bone& before_;
  std::vector<scoring::SparedStructure> spared_;
};

Status leave(const Trick& trick, volume::Bone& bone, Progress& progress) {
  for (const Region& one : trick.cut)
    if (const Status cut = volume::cut_by_depth(bone, one, progress); !cut) return cut;
  for (const Region& one : trick.fill)
    if (const Status filled = volume::fill_by_depth(bone, one); !filled) return filled;
  return fine();
}

}  // namespace

Result<std::vector<Trick>> tricks_of(const volume::Bone& before, const scenario::CaseLesson& lesson,
                                     double burr, std::uint64_t seed, Progress& progress) {
  const auto plan = scoring::reference_plan(before, lesson, progress);
  if (!plan) return plan.error();
  const auto spared = scoring::spared_structures(before, lesson, progress);
  if (!spared) return spared.error();
  const Region remove = scoring::all_of(plan->remove);
  const Place place =
      place_of(before, remove, lesson.approach.empty() ? Vec3(Vec3::UnitZ()) : lesson.approach[0]);
  std::vector<Region> fill;
  if (!plan->fill.empty()) fill.push_back(scoring::all_of(plan->fill));
  const double middle = 0.5 * (place.low.z() + place.high.z());

  std::vector<Trick> all;
  all.push_back({"nothing", "the bone is left as it was", {}, {}});
  all.push_back({"everything", "all bone is cut away", {everywhere()}, {}});
  if (const Region layer = seal(*spared))
    all.push_back({"everything, sealed",
                   "all bone is cut away, and each structure gets 0.7 mm of added bone",
                   {everywhere()},
                   {layer}});
  all.push_back({"flat to the floor",
                 "all bone above the deepest point of the plan is cut away",
                 {above(place, place.low.z())},
                 fill});
  all.push_back({"flat to the middle",
                 "all bone above the middle of the plan is cut away",
                 {above(place, middle)},
                 fill});
  all.push_back({"peep-holes",
                 "shafts of 1 mm every 3 mm are cut through the plan",
                 {metrics::both(remove, shafts(place))},
                 {}});
  for (const scoring::ReferencePlan::Part& one : plan->remove)
    if (plan->remove.size() + plan->fill.size() > 1)
      all.push_back({fmt::format("only \"{}\"", one.name),
                     "this part is cut exactly, and no other is begun",
                     {one.region},
                     {},
                     true});
  if (!fill.empty())
    all.push_back({"only what is filled", "what is to be added is added", {}, fill});
  add_shifted(place, remove, burr, all);
  const Vec3 edge = place.world({place.high.x() + kBeside, 0, 0});
  all.push_back({"exact, and half of the bone gone",
                 "the plan is cut exactly, and all bone on one side of it is cut away",
                 {remove, metrics::in_half_space(edge, -place.across)},
                 fill});
  all.push_back({"random strokes",
                 "strokes of 10 mm at random over the plan, twice as much as it",
                 {random_strokes(place, burr, seed)},
                 {}});
  return all;
}

Result<std::vector<Tried>> try_tricks(const scoring::Rubric& rubric,
                                      const scenario::CaseLesson& lesson,
                                      const scenario::BoneRecipe& recipe, double burr,
                                      std::uint64_t seed, Progress& progress) {
  const auto before = workshop::open_bone(recipe, progress);
  if (!before) return before.error();
  const auto tricks = tricks_of(*before->bone, lesson, burr, seed, progress);
  if (!tricks) return tricks.error();
  auto spared = scoring::spared_structures(*before->bone, lesson, progress);
  if (!spared) return spared.error();
  const Trial trial(rubric, lesson, *before->bone, std::move(*spared));
  std::vector<Tried> all;
  for (const Trick& trick : *tricks) {
    const auto after = volume::copy_of(*before->bone);
    if (const Status left = leave(trick, *after, progress); !left) return left.error();
    auto tried = trial.judge(trick, *after, progress);
    if (!tried) return tried.error();
    // a region that holds some of every other part is no part, but the work
    if (!trick.leaves_parts || tried->no_mark) all.push_back(std::move(*tried));
  }
  return all;
}

}  // namespace burr::proof
