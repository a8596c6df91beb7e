#include "burr/phantom/phantoms.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace burr::phantom {
namespace {

// A block of bone to sculpt, edges along the world's axes.
Phantom block(double, const Variant&) {
  Phantom phantom;
  phantom.formula.depth = box({20e-3, 20e-3, 15e-3});
  phantom.landmarks = {
      {"centre", {Vec3::Zero()}, {}},
      {"top", {Vec3(0, 0, 15e-3)}, Vec3::UnitZ()},
      {"front edge", {Vec3(-20e-3, -20e-3, 15e-3), Vec3(20e-3, -20e-3, 15e-3)}, {}}};
  phantom.lo = {-22e-3, -22e-3, -17e-3};
  phantom.hi = {22e-3, 22e-3, 17e-3};
  return phantom;
}

Phantom round_ball(double, const Variant&) {
  Phantom phantom;
  phantom.formula.depth = ball(kPeersBall);
  phantom.landmarks = {{"centre", {Vec3::Zero()}, {}}};
  phantom.lo = Vec3::Constant(-0.5 * kPeersCube);
  phantom.hi = Vec3::Constant(0.5 * kPeersCube);
  return phantom;
}

constexpr std::array<VariantWord, 5> kTemporalBoneVariants = {
    {{"forward-sinus", "the descending sigmoid sinus lies 4 mm farther forward", 4, 0.7, 4},
     {"low-dura", "the dura over the mastoid lies 4 mm lower", 4, 0.7, 2},
     {"dehiscent", "no bone over 3 mm of the facial nerve's tympanic part", 0, 0.25},
     {"sclerotic", "dense bone in place of the mastoid cells"},
     {"ridge-dura", "the dura covers the ridge of the pyramid too, without gaps"}}};
constexpr std::array<VariantWord, 1> kSpineVariants = {
    {{"thin-pedicle", "the pedicles are 2.4 mm narrower and lower", 2.4, 1, 2.4}}};
constexpr std::array<VariantWord, 3> kJawVariants = {
    {{"long", "longer in front, for an osteotomy: toothless to the front, floor of the mouth"},
     {"high-nerve", "the nerve lies 2.5 mm nearer to the ridge", 2.5, 1, 1.5},
     {"defect", "a round defect 2.5 mm deep in the cheek side, below the nerve"}}};
constexpr std::array<VariantWord, 3> kToothVariants = {
    {{"graded", "caries in three grades, and a second, smaller one in front of it"},
     {"shallow", "the caries ends 0.8 mm higher", 0.8, 0.5, 0.8},
     {"deep", "the caries ends 0.4 mm lower", 0.4, 0.5, 0.4}}};

struct Known {
  std::string_view name;
  double voxel_mm;
  Phantom (*make)(double voxel, const Variant& variant);
  std::span<const VariantWord> variants = {};
};

constexpr std::array<Known, 7> kKnown = {
    {{"temporal-bone", 0.25, temporal_bone, kTemporalBoneVariants},
     {"jaw", 0.25, jaw, kJawVariants},
     {"tooth", 0.1, tooth, kToothVariants},
     {"spine", 0.4, spine, kSpineVariants},
     {"skull", 0.5, skull},
     {"block", 0.25, block},
     {"ball", 0.25, round_ball}}};

const Known* find(std::string_view name) {
  for (const Known& known : kKnown)
    if (known.name == name) return &known;
  return nullptr;
}

std::string list_of_names() {
  std::string list;
  for (const Known& known : kKnown) list += (list.empty() ? "" : ", ") + std::string(known.name);
  return list;
}

// A fair number in [0, 1) from a bone's number and the n-th draw for it, the same on every computer
// (SplitMix64: Steele, Lea, Flood 2014).
double drawn(std::uint32_t number, std::uint64_t n) {
  std::uint64_t z = (std::uint64_t{number} << 32U | n) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
}

struct Word {
  std::string_view word;
  std::optional<double> mm;
};
std::vector<Word> words_of_bone(const Known& known, std::uint32_t number) {
  std::vector<Word> words;
  for (std::size_t n = 0; n < known.variants.size(); ++n) {
    const VariantWord& one = known.variants[n];
    // both draws are made for every word, so that one more word changes none of the others
    const bool there = drawn(number, 2 * n) < one.chance;
    const double tenths = std::floor(drawn(number, 2 * n + 1) * 10 * one.drawn_mm) + 1;
    if (!there) continue;
    words.push_back({one.word, std::nullopt});
    if (one.drawn_mm > 0) words.back().mm = tenths / 10;  // as "1.3" reads
  }
  return words;
}

constexpr std::string_view kBone = "bone";

// Of "high-nerve=1.5": "1.5".
std::optional<std::string_view> after_equals(std::string_view word) {
  const std::size_t at = word.find('=');
  return at == std::string_view::npos ? std::nullopt : std::optional(word.substr(at + 1));
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number value{};
  const auto [end, trouble] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (trouble != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string text_of(double mm) {
  std::string text = std::to_string(mm);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}
std::string in_mm(double mm) { return text_of(mm) + " mm"; }

// "high-nerve", "high-nerve=1.5" or "bone=7" of this phantom, put into the variant.
Status take_word(const Known& known, std::string_view word, Variant& variant) {
  const std::string phantom = "the phantom " + std::string(known.name);
  const std::string_view name = word.substr(0, word.find('='));
  const auto amount = after_equals(word);
  if (name == kBone) {
    if (!has_bones(known.name))
      return error(Trouble::usage, phantom + " is one bone and has no others; leave out '" +
                                       std::string(word) + "'");
    const auto number = number_in<std::uint32_t>(amount.value_or(""));
    if (!number || *number < 1 || *number > kMostBones)
      return error(Trouble::usage, "'" + std::string(word) +
                                       "' is not the number of a bone; use bone=1 to bone=" +
                                       std::to_string(kMostBones));
    for (const Word& one : words_of_bone(known, *number))
      if (!variant.has(one.word)) variant.add(std::string(one.word), one.mm);
    return fine();
  }
  std::string list;
  const VariantWord* found = nullptr;
  for (const VariantWord& one : known.variants) {
    list += (list.empty() ? "" : ", ") + std::string(one.word);
    if (one.word == name) found = &one;
  }
  if (found == nullptr)
    return error(Trouble::usage, phantom + " has no variant '" + std::string(name) + "'; " +
                                     (list.empty() ? "it has none, so leave out what follows the ?"
                                                   : "use one or more of " + list));
  if (!amount) {
    if (!variant.has(name)) variant.add(std::string(name), std::nullopt);
    return fine();
  }
  if (found->most_mm == 0)
    return error(Trouble::usage, "the variant '" + std::string(name) + "' of " + phantom +
                                     " takes no amount; leave out '=" + std::string(*amount) + "'");
  const auto mm = number_in<double>(*amount);
  if (!mm || !(*mm > 0 && *mm <= found->most_mm))
    return error(Trouble::usage, "'" + std::string(word) +
                                     "': the amount of this variant is above 0 and at most " +
                                     in_mm(found->most_mm) + ", in millimetres; write " +
                                     std::string(name) + "=" + text_of(found->most_mm));
  if (!variant.has(name)) variant.add(std::string(name), mm);
  return fine();
}

// "jaw?long,high-nerve"
struct Wanted {
  const Known* known = nullptr;
  Variant variant;
};
Result<Wanted> wanted(std::string_view text) {
  const std::size_t mark = text.find('?');
  const std::string_view name = text.substr(0, mark);
  Wanted out{find(name), {}};
  if (out.known == nullptr)
    return error(Trouble::usage,
                 "unknown phantom '" + std::string(name) + "'; use one of " + list_of_names());
  if (mark == std::string_view::npos) return out;
  std::vector<std::string> words;
  for (std::string_view rest = text.substr(mark + 1);;) {
    const std::size_t comma = rest.find(',');
    words.emplace_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  // a number draws last: what is written has precedence
  std::stable_partition(words.begin(), words.end(),
                        [](const std::string& word) { return !word.starts_with(kBone); });
  for (const std::string& word : words)
    if (const Status taken = take_word(*out.known, word, out.variant); !taken) return taken.error();
  return out;
}

// more would not fit into the memory of a common computer; fewer show nothing
constexpr double kMostVoxels = 1.2e9, kFewestAlong = 16;

}  // namespace

std::vector<std::string_view> phantom_names() {
  std::vector<std::string_view> names;
  for (const Known& known : kKnown) names.push_back(known.name);
  return names;
}

std::span<const VariantWord> variants_of(std::string_view name) {
  const Known* known = find(name);
  return known == nullptr ? std::span<const VariantWord>() : known->variants;
}

bool has_bones(std::string_view name) {
  const std::span<const VariantWord> words = variants_of(name.substr(0, name.find('?')));
  return std::any_of(words.begin(), words.end(),
                     [](const VariantWord& one) { return one.chance > 0; });
}

std::string drawn_bone(std::string_view name, std::uint32_t number) {
  const Known* known = find(name.substr(0, name.find('?')));
  std::string out;
  if (known == nullptr) return out;
  for (const Word& one : words_of_bone(*known, number)) {
    out += (out.empty() ? "" : ",") + std::string(one.word);
    if (one.mm) out += "=" + text_of(*one.mm);
  }
  return out;
}

Status known(std::string_view name) {
  const auto found = wanted(name);
  return found ? fine() : Status(found.error());
}

double default_voxel_mm(std::string_view name) {
  const auto found = wanted(name);
  return found ? found->known->voxel_mm : 0;
}

std::vector<Landmark> landmarks(std::string_view name) {
  const auto found = wanted(name);
  return found ? found->known->make(1e-3 * found->known->voxel_mm, found->variant).landmarks
               : std::vector<Landmark>();
}

Result<std::unique_ptr<volume::Bone>> phantom(
    std::string_view name, double voxel_mm, Progress& progress, std::size_t reserve_bricks,
    int threads, const std::function<void(volume::TissueTable&)>& made_of) {
  const auto found = wanted(name);
  if (!found) return found.error();
  const Known* known = found->known;
  if (voxel_mm == 0) voxel_mm = known->voxel_mm;
  if (!(voxel_mm > 0) || !std::isfinite(voxel_mm))
    return error(Trouble::usage,
                 "the voxel size must be a positive number of millimetres, for example " +
                     in_mm(known->voxel_mm) + " for the phantom " + std::string(name));
  const double voxel = 1e-3 * voxel_mm;
  Phantom made = known->make(voxel, found->variant);
  if (made_of) made_of(made.tissues);
  const Vec3 along = (made.hi - made.lo) / voxel;
  if (along.minCoeff() < kFewestAlong)
    return error(Trouble::usage, "voxels of " + in_mm(voxel_mm) +
                                     " are too coarse for the phantom " + std::string(name) +
                                     ", which is " + in_mm(1e3 * (made.hi - made.lo).minCoeff()) +
                                     " thick; use " + in_mm(known->voxel_mm));
  if (along.prod() > kMostVoxels)
    return error(Trouble::usage, "voxels of " + in_mm(voxel_mm) + " would make more than " +
                                     std::to_string(static_cast<int>(kMostVoxels / 1e6)) +
                                     " million of them; use larger voxels, for example " +
                                     in_mm(known->voxel_mm) + " for the phantom " +
                                     std::string(name));
  return bone_from_formula(box_grid(made.lo, made.hi, voxel), made.tissues, made.formula,
                           reserve_bricks, threads, progress);
}

}  // namespace burr::phantom
