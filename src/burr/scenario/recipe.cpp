#include "burr/scenario/recipe.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "burr/base/printable.h"

namespace burr::scenario {
namespace {

using nlohmann::json;

constexpr std::string_view kPhantom = "phantom:";
constexpr int kMostVoxels = 1'000'000;  // along an axis
constexpr int kMostParts = 1'000'000;   // that can be asked for
constexpr double kFarMm = 1e6;          // no point of a scan lies farther

// "0.3,0.3,0.6"
bool numbers(std::string_view text, std::vector<double>& out) {
  for (std::size_t at = 0; at <= text.size();) {
    std::size_t end = text.find(',', at);
    if (end == std::string_view::npos) end = text.size();
    double value = 0;
    const auto result = std::from_chars(text.data() + at, text.data() + end, value);
    if (result.ec != std::errc() || result.ptr != text.data() + end) return false;
    out.push_back(value);
    at = end + 1;
  }
  return true;
}

// One field of a JSON object; a field that is not there leaves `out` as it is.
class Fields {
 public:
  explicit Fields(const json& object) : object_(object) {}

  void text(const char* name, std::string& out) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_string()) return fail(name);
    out = found->get<std::string>();
  }
  void number(const char* name, double& out, double least) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_number()) return fail(name);
    const auto value = found->get<double>();
    if (!std::isfinite(value) || value < least) return fail(name);
    out = value;
  }
  void level(const char* name, std::optional<double>& out) {
    if (find(name) != nullptr) number(name, out.emplace(), -1e300);
  }
  void spacing(const char* name, math::Vec3& out) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_array() || found->size() != 3) return fail(name);
    for (std::size_t a = 0; a < 3; ++a) {
      const json& one = (*found)[a];
      if (!one.is_number() || !(one.get<double>() >= 0 && one.get<double>() <= 100))
        return fail(name);
      out[static_cast<Eigen::Index>(a)] = one.get<double>();
    }
  }
  void region(const char* name, std::optional<Region>& out) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_array() || found->size() != 6) return fail(name);
    std::array<int, 6> box{};
    for (std::size_t n = 0; n < 6; ++n) {
      const json& one = (*found)[n];
      if (!one.is_number_unsigned() || one.get<std::uint64_t>() >= kMostVoxels) return fail(name);
      box[n] = one.get<int>();
    }
    out = Region{{box[0], box[1]}, {box[2], box[3]}, {box[4], box[5]}};
  }
  void yes(const char* name, bool& out) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_boolean()) return fail(name);
    out = found->get<bool>();
  }
  void count(const char* name, std::size_t& out) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_number_unsigned()) return fail(name);
    out = found->get<std::size_t>();
  }
  void keep(const char* name, Keep& out) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_object()) return fail(name);
    for (const auto& [key, value] : found->items()) {
      if (key == "largest" && value.is_number_unsigned() &&
          value.get<std::uint64_t>() <= kMostParts) {
        out.largest = value.get<int>();
      } else if (key == "at_mm" && value.is_array() && value.size() <= kMostParts) {
        for (const json& point : value) {
          if (!point.is_array() || point.size() != 3) return fail(name);
          for (const json& one : point)
            if (!one.is_number() || !(std::abs(one.get<double>()) <= kFarMm)) return fail(name);
          out.at_mm.emplace_back(point[0].get<double>(), point[1].get<double>(),
                                 point[2].get<double>());
        }
      } else {
        return fail(name);
      }
    }
  }
  void yes_or_no(const char* name, bool& out) {
    const json* found = find(name);
    if (found == nullptr) return;
    if (!found->is_boolean()) return fail(name);
    out = found->get<bool>();
  }
  [[nodiscard]] const std::string& wrong() const { return wrong_; }

 private:
  const json* find(const char* name) const {
    const auto at = object_.find(name);
    return at == object_.end() || at->is_null() ? nullptr : &*at;
  }
  void fail(const char* name) {
    if (wrong_.empty()) wrong_ = name;
  }
  const json& object_;
  std::string wrong_;
};

}  // namespace

bool Keep::operator==(const Keep& other) const {
  return largest == other.largest && at_mm == other.at_mm;
}

bool BoneRecipe::operator==(const BoneRecipe& other) const {
  return source == other.source && series == other.series && spacing_mm == other.spacing_mm &&
         allow_missing == other.allow_missing && as_it_is == other.as_it_is &&
         region == other.region && voxel_mm == other.voxel_mm && iso == other.iso &&
         smooth == other.smooth && labels == other.labels && materials == other.materials &&
         memory_mb == other.memory_mb && read_seconds == other.read_seconds &&
         read_memory_mb == other.read_memory_mb && reserve_bricks == other.reserve_bricks &&
         margin == other.margin && check_values == other.check_values &&
         check_scan == other.check_scan && bone_law == other.bone_law && keep == other.keep &&
         drop_islands_mm3 == other.drop_islands_mm3;
}

bool is_phantom(const std::string& source) { return source.starts_with(kPhantom); }
std::string phantom_name(const std::string& source) {
  return is_phantom(source) ? source.substr(kPhantom.size()) : "";
}
std::string phantom_source(const std::string& name) { return std::string(kPhantom) + name; }
std::string without_variant(const std::string& phantom) {
  return phantom.substr(0, phantom.find('?'));
}

namespace {

// A number in the list of series, or an energy ("70 keV"): it tells nothing of the patient. Unlike the
// beginning of a UID, which is long or has dots.
bool tells_nothing(const std::string& series) {
  constexpr std::size_t kLongest = 6, kUnit = 3;
  if (series.starts_with('#')) return true;
  std::string number = series;
  for (const char* unit : {"keV", "kev", "KEV"})
    if (number.ends_with(unit)) number.resize(number.size() - kUnit);
  if (number.size() < series.size() && number.ends_with(' ')) number.pop_back();
  return number.size() <= kLongest &&
         std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

BoneRecipe without_paths(BoneRecipe recipe) {
  if (!is_phantom(recipe.source)) recipe.source.clear();
  if (!tells_nothing(recipe.series)) recipe.series = kOwn;
  if (!recipe.labels.empty()) recipe.labels = kOwn;
  if (!recipe.materials.empty()) recipe.materials = kOwn;
  return recipe;
}

std::string to_json(const BoneRecipe& recipe) {
  json out = {{"source", recipe.source},
              {"voxel_mm", recipe.voxel_mm},
              {"smooth", recipe.smooth},
              {"memory_mb", recipe.memory_mb},
              {"reserve_bricks", recipe.reserve_bricks},
              {"margin", recipe.margin},
              {"check_values", recipe.check_values},
              {"check_scan", recipe.check_scan},
              {"bone_law", recipe.bone_law}};
  const auto text = [&out](const char* name, const std::string& value) {
    if (!value.empty()) out[name] = value;
  };
  text("series", recipe.series);
  text("labels", recipe.labels);
  text("materials", recipe.materials);
  if (!recipe.spacing_mm.isZero(0))
    out["spacing_mm"] = {recipe.spacing_mm.x(), recipe.spacing_mm.y(), recipe.spacing_mm.z()};
  if (recipe.allow_missing) out["allow_missing"] = true;
  if (recipe.as_it_is) out["as_it_is"] = true;
  if (recipe.region) {
    const Region& r = *recipe.region;
    out["region"] = {r.i[0], r.i[1], r.j[0], r.j[1], r.k[0], r.k[1]};
  }
  if (recipe.iso) out["iso"] = *recipe.iso;
  if (recipe.keep.largest > 0) out["keep"]["largest"] = recipe.keep.largest;
  for (const math::Vec3& mm : recipe.keep.at_mm)
    out["keep"]["at_mm"].push_back({mm.x(), mm.y(), mm.z()});
  if (recipe.drop_islands_mm3 != 0) out["drop_islands_mm3"] = recipe.drop_islands_mm3;
  if (recipe.read_seconds != 0) out["read_seconds"] = recipe.read_seconds;
  if (recipe.read_memory_mb != 0) out["read_memory_mb"] = recipe.read_memory_mb;
  // a file may be called what is no UTF-8
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<BoneRecipe> recipe_from_json(std::string_view text, const std::string& where) {
  const json object = json::parse(text, nullptr, false);
  if (!object.is_object())
    return error(where + ": the recipe of the bone is not JSON; the file is damaged");
  BoneRecipe out;
  Fields fields(object);
  fields.text("source", out.source);
  fields.text("series", out.series);
  fields.spacing("spacing_mm", out.spacing_mm);
  fields.yes("allow_missing", out.allow_missing);
  fields.yes("as_it_is", out.as_it_is);
  fields.region("region", out.region);
  fields.number("voxel_mm", out.voxel_mm, 0);
  fields.level("iso", out.iso);
  fields.number("smooth", out.smooth, -1e300);
  fields.text("labels", out.labels);
  fields.text("materials", out.materials);
  fields.number("memory_mb", out.memory_mb, 0);
  fields.keep("keep", out.keep);
  fields.number("drop_islands_mm3", out.drop_islands_mm3, 0);
  fields.number("read_seconds", out.read_seconds, 0);
  fields.number("read_memory_mb", out.read_memory_mb, 0);
  fields.count("reserve_bricks", out.reserve_bricks);
  out.margin = false;
  fields.yes_or_no("margin", out.margin);
  out.check_values = false;
  fields.yes_or_no("check_values", out.check_values);
  out.check_scan = false;
  fields.yes_or_no("check_scan", out.check_scan);
  std::size_t law = 1;
  fields.count("bone_law", law);
  if (law < 1 || law > static_cast<std::size_t>(BoneRecipe{}.bone_law))
    return error(fmt::format(
        "{}: its bone was made by law {}, and this burr knows laws 1 to {}; use a newer burr",
        where, law, BoneRecipe{}.bone_law));
  out.bone_law = static_cast<int>(law);
  if (!fields.wrong().empty())
    return error(
        fmt::format("{}: recipe.{} has the wrong type or is out of range; the file is damaged",
                    where, fields.wrong()));
  return out;
}

Result<Region> parse_region(std::string_view text) {
  std::vector<double> box;
  if (!numbers(text, box) || box.size() != 6)
    return error(Trouble::usage,
                 fmt::format("`region`: \"{}\" is not six whole numbers, as in 10,200,0,99,5,80",
                             base::printable(text)));
  std::array<int, 6> voxel{};
  for (std::size_t n = 0; n < 6; ++n) {
    if (!(box[n] >= 0 && box[n] < kMostVoxels))
      return error(Trouble::usage,
                   "`region`: voxels are counted from 0; give numbers of 0 or more");
    voxel[n] = static_cast<int>(box[n]);
  }
  return Region{{voxel[0], voxel[1]}, {voxel[2], voxel[3]}, {voxel[4], voxel[5]}};
}

Result<double> parse_level(std::string_view text) {
  std::vector<double> level;
  if (!numbers(text, level) || level.size() != 1)
    return error(Trouble::usage,
                 fmt::format("`iso`: \"{}\" is not a number", base::printable(text)));
  return level[0];
}

Result<math::Vec3> parse_spacing(std::string_view text) {
  std::vector<double> mm;
  bool good = numbers(text, mm) && mm.size() == 3;
  for (std::size_t a = 0; good && a < 3; ++a) good = mm[a] > 0 && mm[a] <= 100;
  if (!good)
    return error(Trouble::usage,
                 fmt::format("`spacing_mm`: \"{}\" is not three numbers above 0, as in 0.3,0.3,0.6",
                             base::printable(text)));
  return math::Vec3(mm[0], mm[1], mm[2]);
}

Result<Keep> parse_keep(std::string_view text) {
  const auto wrong = [text] {
    return error(Trouble::usage,
                 fmt::format("`keep`: \"{}\" is not known; use largest, a number of parts as in 3, "
                             "or points in mm as in \"at 10,-20,30; 1,2,3\"",
                             base::printable(text)));
  };
  std::string words(text);
  std::erase(words, ' ');
  if (words == "all") return Keep{};
  if (words == "largest") return Keep{1, {}};
  std::string_view rest = words;
  if (rest.ends_with("largest")) rest.remove_suffix(7);
  std::vector<double> count;
  if (numbers(rest, count) && count.size() == 1) {
    if (!(count[0] >= 1 && count[0] <= kMostParts && count[0] == std::floor(count[0])))
      return error(Trouble::usage,
                   fmt::format("`keep`: {} is not a number of parts; use 1 or more", count[0]));
    return Keep{static_cast<int>(count[0]), {}};
  }
  rest = words;
  if (rest.starts_with("at")) rest.remove_prefix(2);
  Keep keep;
  for (std::size_t at = 0; at <= rest.size();) {
    const std::size_t end = std::min(rest.find(';', at), rest.size());
    std::vector<double> mm;
    if (!numbers(rest.substr(at, end - at), mm) || mm.size() != 3) return wrong();
    for (const double one : mm)
      if (!(std::abs(one) <= kFarMm)) return wrong();
    keep.at_mm.emplace_back(mm[0], mm[1], mm[2]);
    at = end + 1;
  }
  return keep;
}

std::string region_text(const Region& region) {
  return fmt::format("{},{},{},{},{},{}", region.i[0], region.i[1], region.j[0], region.j[1],
                     region.k[0], region.k[1]);
}

}  // namespace burr::scenario
