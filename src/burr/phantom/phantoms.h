// phantom/phantoms.h - anatomy by formula: bones of no real patient, to practise and to measure on.
//
//     temporal-bone  right temporal bone, 58 x 64 x 58 mm, every structure of a mastoidectomy
//                    labelled
//     jaw            left half of a lower jaw from premolar to second molar, with its nerve canal
//     tooth          lower molar: enamel, dentine, pulp, caries
//     spine          third lumbar vertebra with canal and cord
//     skull          vault and face, 190 mm long
//     block          a block to sculpt
//     ball           a ball
//
// A name may be followed by variants, in any order: "jaw?long,high-nerve" (variants_of()). Some take
// an amount in millimetres: "jaw?high-nerve=1.5". "jaw?bone=7" is the bone of number 7: its amounts are
// drawn from that number, as drawn_bone() says. Landmarks follow the variant. Without one the bits stay
// as they are: recordings replay on them.
//
// Frame: LPS (x left, y back, z up), metres. Shapes and sizes follow textbooks, not a person. The
// same name and voxel give the same bits for any number of threads.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/progress.h"
#include "burr/base/result.h"
#include "burr/phantom/build.h"
#include "burr/volume/bone.h"

namespace burr::phantom {

// A place that the formula knows by name: a point, a curve (two points or more: a nerve, the axis of
// a canal), or a plane (a point and a normal). World [m].
struct Landmark {
  std::string name;
  std::vector<Vec3> points;
  std::optional<Vec3> normal;  // unit
};

// A phantom as a formula, before it becomes voxels.
struct Phantom {
  volume::TissueTable tissues;
  Formula formula;
  Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();  // box that holds it, world [m]
  std::vector<Landmark> landmarks;            // names are unique
};

// How a phantom differs from its usual shape.
class Variant {
 public:
  Variant() = default;
  explicit Variant(std::vector<std::string> words) : words_(std::move(words)) {}
  [[nodiscard]] bool has(std::string_view word) const {
    return std::find(words_.begin(), words_.end(), word) != words_.end();
  }
  // How much of a word that takes an amount: 0 without the word, `usual` without a number.  [mm]
  [[nodiscard]] double mm(std::string_view word, double usual) const {
    const auto found = std::find(words_.begin(), words_.end(), word);
    if (found == words_.end()) return 0;
    const auto n = static_cast<std::size_t>(found - words_.begin());
    return n < amounts_.size() && amounts_[n] ? *amounts_[n] : usual;
  }
  void add(std::string word, std::optional<double> amount_mm) {
    amounts_.resize(words_.size());
    words_.push_back(std::move(word));
    amounts_.push_back(amount_mm);
  }

 private:
  std::vector<std::string> words_;
  std::vector<std::optional<double>> amounts_;  // [mm]; may be shorter
};

struct VariantWord {
  std::string_view word, what;
  double most_mm = 0;  // of a word that takes an amount; 0: it takes none
  // In the bone of a number: how often the word is there, and with how much at most.
  double chance = 0, drawn_mm = 0;
};

[[nodiscard]] std::vector<std::string_view> phantom_names();

// The variants of a phantom, by its name alone; none for an unknown name.
[[nodiscard]] std::span<const VariantWord> variants_of(std::string_view name);

// The largest number of a bone.
inline constexpr std::uint32_t kMostBones = 1'000'000;
// True if the bones of this phantom have numbers: some of its variants can be drawn.
[[nodiscard]] bool has_bones(std::string_view name);
// The words that "bone=NUMBER" stands for, as one may type them: "forward-sinus=1.3,dehiscent". Every
// amount is a whole tenth of a millimetre. Empty: the phantom has no numbers, or this bone is the usual.
[[nodiscard]] std::string drawn_bone(std::string_view name, std::uint32_t number);

// Fine if there is a phantom of this name and all its variants; otherwise the Error (usage) says what
// there is.
[[nodiscard]] Status known(std::string_view name);

// A voxel size that shows this phantom well in moderate time [mm]; 0 for an unknown name.
[[nodiscard]] double default_voxel_mm(std::string_view name);

// The landmarks of a phantom; none for an unknown name. They do not depend on the voxel.
[[nodiscard]] std::vector<Landmark> landmarks(std::string_view name);

// The phantom with voxels of voxel_mm (0: its default), and room for `reserve_bricks` bricks of
// added material. made_of: may change the constants of the phantom's tissues. Errors: unknown name
// or unsuitable voxel (usage), interrupted.
[[nodiscard]] Result<std::unique_ptr<volume::Bone>> phantom(
    std::string_view name, double voxel_mm, Progress& progress, std::size_t reserve_bricks = 2048,
    int threads = 2, const std::function<void(volume::TissueTable&)>& made_of = {});

// The phantoms, one file each. voxel [m]: sets how far labels reach into the ramp.
[[nodiscard]] Phantom temporal_bone(double voxel, const Variant& variant = {});
[[nodiscard]] Phantom jaw(double voxel, const Variant& variant = {});
[[nodiscard]] Phantom tooth(double voxel, const Variant& variant = {});
[[nodiscard]] Phantom spine(double voxel, const Variant& variant = {});
[[nodiscard]] Phantom skull(double voxel, const Variant& variant = {});

}  // namespace burr::phantom
