#include "burr/scoring/show_regions.h"

#include <string_view>
#include <utility>

namespace burr::scoring {
namespace {

void join(metrics::Region& all, metrics::Region one) {
  all = all ? metrics::either(std::move(all), std::move(one)) : std::move(one);
}

}  // namespace

void show_regions(const Rubric& rubric, Workpiece& scene, Shown& shown) {
  const auto& reference = scene.lesson().reference;
  if (reference) {
    for (const std::string& name : reference->remove) join(shown.remove, scene.region(name));
    for (const auto& [structure, thickness] : reference->leave)
      if (!scene.tissues(structure).empty())
        join(shown.keep, metrics::within(scene.distance(structure), thickness));
  }
  const bool by_items = !shown.remove;
  for (const Item& item : rubric.items) {
    if (item.region.empty()) continue;
    const metrics::Region region = scene.region(item.region);
    shown.regions.emplace(item.region, region);
    const std::string_view how = item.how->name;
    if (how == "kept") join(shown.keep, region);
    if (how == "removed" && by_items) join(shown.remove, region);
  }
}

}  // namespace burr::scoring
