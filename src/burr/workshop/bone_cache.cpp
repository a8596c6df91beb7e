#include "burr/workshop/bone_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/hash.h"
#include "burr/base/new_file.h"
#include "burr/record/bone_blob.h"
#include "burr/scenario/case.h"

namespace burr::workshop {
namespace {

namespace fs = std::filesystem;

struct Cache {
  fs::path folder;
  std::string build;
};
Cache& cache() {
  static Cache one;
  return one;
}

// Adds the bytes of a file. False: it cannot be read.
bool mix_file(const fs::path& file, std::uint64_t& hash) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> block(std::size_t{1} << 20);
  std::uint64_t size = 0;
  while (in) {
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto got = static_cast<std::size_t>(in.gcount());
    std::fill(block.begin() + static_cast<std::ptrdiff_t>(got),
              block.begin() + static_cast<std::ptrdiff_t>(std::min(block.size(), got + 8)), '\0');
    for (std::size_t at = 0; at < got; at += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, block.data() + at, sizeof word);
      hash = base::mix(hash, word);
    }
    size += got;
  }
  hash = base::mix(hash, size);
  return in.eof() && !in.bad();
}

// The same of a file, or of all files of a folder in the order of their names; the names count.
bool mix_all(const fs::path& source, std::uint64_t& hash) {
  std::error_code trouble;
  if (!fs::is_directory(source, trouble)) return mix_file(source, hash);
  std::vector<fs::path> files;
  fs::recursive_directory_iterator at(source, trouble);
  for (; !trouble && at != fs::recursive_directory_iterator(); at.increment(trouble))
    if (at->is_regular_file(trouble)) files.push_back(at->path());
  std::sort(files.begin(), files.end());
  return !trouble && std::all_of(files.begin(), files.end(), [&](const fs::path& file) {
    hash = base::mix(hash, scenario::text_hash(file.lexically_relative(source).string()));
    return mix_file(file, hash);
  });
}

fs::path file_of(const std::string& entry) { return cache().folder / (entry + ".prepared"); }

}  // namespace

void keep_bones_in(fs::path folder, std::string build) {
  cache() = {std::move(folder), std::move(build)};
}

std::string entry_of(const scenario::BoneRecipe& recipe) {
  if (cache().folder.empty()) return {};
  std::uint64_t hash = scenario::text_hash(cache().build);
  scenario::BoneRecipe what = recipe;
  what.reserve_bricks = 0;  // room for later, no part of the bone
  if (!scenario::is_phantom(recipe.source)) {
    if (!mix_all(recipe.source, hash)) return {};
    what.source.clear();  // the same scan at another place
  }
  for (std::string* table : {&what.labels, &what.materials}) {
    if (table->empty()) continue;
    if (!mix_file(*table, hash)) return {};
    *table = "table";
  }
  return fmt::format("{:016x}", base::mix(hash, scenario::text_hash(scenario::to_json(what))));
}

std::optional<importing::Imported> kept_bone(const std::string& entry, std::size_t reserve_bricks) {
  if (entry.empty()) return std::nullopt;
  std::ifstream in(file_of(entry), std::ios::binary);
  std::string head;
  if (!in || !std::getline(in, head)) return std::nullopt;
  const auto about = nlohmann::json::parse(head, nullptr, false);
  const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
  auto bone = record::bone_from_blob(record::ByteSpan(bytes), reserve_bricks, entry);
  if (!bone || !about.is_object()) return std::nullopt;
  importing::Imported made;
  made.bone = std::move(*bone);
  made.summary.format = about.value("format", "");
  made.summary.notices = about.value("notices", std::vector<std::string>());
  made.summary.size = made.bone->grid().size;
  made.summary.voxel_mm = 1e3 * made.bone->grid().voxel;
  return made;
}

void keep_bone(const std::string& entry, const importing::Imported& made) {
  if (entry.empty()) return;
  std::error_code nobody_asks;
  fs::create_directories(cache().folder, nobody_asks);
  auto file = base::NewFile::create(file_of(entry).string());
  if (!file) return;
  const nlohmann::json about = {{"format", made.summary.format}, {"notices", made.summary.notices}};
  file->write(about.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  const std::vector<std::uint8_t> bytes = record::bone_to_blob(*made.bone);
  file->write(bytes.data(), bytes.size());
  static_cast<void>(file->put_in_place());  // next time, then
}

}  // namespace burr::workshop
