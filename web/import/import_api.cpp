// What the worker of an import calls (pages/common/import_worker.js): a scan becomes bone, by burr's own
// readers. The worker lives for one scan, and is thrown away.
//
//     import_read("/in/scan") -> import_plan(recipe) -> import_make(recipe) -> import_bone(), import_bone_size()
//
// 0 or "" from a call: import_why() says why, in one sentence. What a call gives lies in the module's
// memory until its next call.
#include <emscripten.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "burr/importing/import.h"
#include "burr/io/read/readers.h"
#include "burr/record/bone_blob.h"

namespace {

using namespace burr;
using nlohmann::json;

struct Import {
  io::Scan scan;
  std::vector<std::uint8_t> blob;
  std::string why, plan;
};
Import& import() {
  static Import one;
  return one;
}

// {"iso": 300, "region": [i0, i1, j0, j1, k0, k1], "memory_mb": 1024, "allow_missing": true, "as_it_is": true}; each may be missing.
scenario::BoneRecipe recipe_of(const char* text) {
  scenario::BoneRecipe recipe;
  const json asked = json::parse(text, nullptr, false);
  recipe.memory_mb = 1024;
  if (!asked.is_object()) return recipe;
  const auto number = [](const json& from) { return from.is_number() ? from.get<double>() : 0.0; };
  if (asked.contains("iso") && asked["iso"].is_number()) recipe.iso = number(asked["iso"]);
  if (asked.contains("memory_mb")) recipe.memory_mb = number(asked["memory_mb"]);
  recipe.allow_missing = asked.contains("allow_missing") && asked["allow_missing"] == true;
  recipe.as_it_is = asked.contains("as_it_is") && asked["as_it_is"] == true;
  if (asked.contains("region") && asked["region"].is_array() && asked["region"].size() == 6) {
    scenario::Region region;
    const auto at = [&](std::size_t n) { return static_cast<int>(number(asked["region"][n])); };
    region.i = {at(0), at(1)};
    region.j = {at(2), at(3)};
    region.k = {at(4), at(5)};
    recipe.region = region;
  }
  return recipe;
}

const char* tell(const importing::ImportSummary& plan) {
  const auto of = [](const auto& v) { return json{v.x(), v.y(), v.z()}; };
  json out = {
      {"format", plan.format}, {"scan", of(plan.scan_size)},    {"spacing_mm", of(plan.spacing_mm)},
      {"labels", plan.labels}, {"hounsfield", plan.hounsfield}, {"low", plan.low},
      {"high", plan.high},     {"size", of(plan.size)},         {"voxel_mm", plan.voxel_mm},
      {"iso", plan.iso},       {"memory_mb", plan.memory_mb},   {"notices", plan.notices}};
  import().plan = out.dump(-1, ' ', false, json::error_handler_t::replace);
  return import().plan.c_str();
}

}  // namespace

extern "C" {

EMSCRIPTEN_KEEPALIVE const char* import_why() { return import().why.c_str(); }

EMSCRIPTEN_KEEPALIVE int import_read(const char* path) {
  NoProgress quiet;
  auto scan = io::read_unfenced(path, {}, quiet);
  if (!scan) {
    import().why = scan.error().text;
    return 0;
  }
  import().scan = std::move(*scan);
  return 1;
}

// What would become of it, as JSON.
EMSCRIPTEN_KEEPALIVE const char* import_plan(const char* recipe) {
  const auto plan = importing::plan_import(import().scan, recipe_of(recipe));
  if (plan) return tell(*plan);
  import().why = plan.error().text;
  return "";
}

EMSCRIPTEN_KEEPALIVE const char* import_make(const char* recipe) {
  NoProgress quiet;
  auto made = importing::import_bone(import().scan, recipe_of(recipe), quiet);
  if (!made) {
    import().why = made.error().text;
    return "";
  }
  import().scan = {};
  import().blob = record::bone_to_blob(*made->bone);
  return tell(made->summary);
}
EMSCRIPTEN_KEEPALIVE const void* import_bone() { return import().blob.data(); }
EMSCRIPTEN_KEEPALIVE int import_bone_size() { return static_cast<int>(import().blob.size()); }

}  // extern "C"
