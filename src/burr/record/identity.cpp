#include "burr/record/identity.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>

#include "burr/base/hash.h"
#include "burr/volume/bone.h"

namespace burr::record {
namespace {

constexpr std::array kModes = {std::pair{Mode::free, "free"}, std::pair{Mode::learn, "learn"},
                               std::pair{Mode::practise, "practise"},
                               std::pair{Mode::exam, "exam"}};
constexpr std::size_t kShortest = 3, kLongest = 24;
constexpr std::ptrdiff_t kMostDigits = 5;  // six may be a date of birth, with hyphens or without

bool small_letter(char c) { return c >= 'a' && c <= 'z'; }
bool digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

const char* word_of(Mode mode) {
  for (const auto& [each, word] : kModes)
    if (each == mode) return word;
  return "";
}

std::optional<Mode> mode_of(std::string_view word) {
  for (const auto& [mode, each] : kModes)
    if (word == each) return mode;
  return std::nullopt;
}

Status check_pseudonym(std::string_view text) {
  const std::ptrdiff_t digits = std::count_if(text.begin(), text.end(), digit);
  if (text.size() >= kShortest && text.size() <= kLongest && small_letter(text.front()) &&
      digits > 0 && digits <= kMostDigits && std::all_of(text.begin(), text.end(), [](char c) {
        return small_letter(c) || digit(c) || c == '-';
      }))
    return fine();
  // the text itself is not repeated: it may be a name
  return error(Trouble::usage,
               "this is not a pseudonym; give 3 to 24 small letters, digits and hyphens, a letter "
               "first, and one to five digits in all, for example kestrel-27; never a name");
}

std::uint64_t labels_hash(const volume::Bone& bone) {
  std::uint64_t hash = base::mix(0, static_cast<std::uint64_t>(bone.brick_count()));
  for (const volume::Tissue& tissue : bone.tissues().tissues) {
    hash = base::mix(hash, static_cast<std::uint64_t>(tissue.name.size()));
    for (const char c : tissue.name)
      hash = base::mix(hash, static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  }
  for (volume::BrickIndex brick = 0; brick < bone.brick_count(); ++brick) {
    const volume::TissueId* tissue = bone.brick_tissue(brick);
    if (tissue == nullptr) continue;
    std::array<std::uint64_t, volume::kBrickVoxels / 8> words{};
    std::memcpy(words.data(), tissue, volume::kBrickVoxels);
    if (std::all_of(words.begin(), words.end(), [](std::uint64_t word) { return word == 0; }))
      continue;  // air, as where there is no brick
    hash = base::mix(hash, static_cast<std::uint64_t>(brick));
    hash = base::mix(hash, std::span<const std::uint64_t>(words));
  }
  return hash;
}

}  // namespace burr::record
