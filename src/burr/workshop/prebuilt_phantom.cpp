#include "burr/workshop/prebuilt_phantom.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/record/bone_blob.h"

namespace burr::workshop {

std::unique_ptr<volume::Bone> prebuilt_phantom(const std::string& phantom,
                                               std::size_t reserve_bricks) {
  // "jaw?long,defect" lies in jaw-long-defect.bone
  std::string name = phantom;
  for (char& one : name)
    if (one == '?' || one == ',') one = '-';
  std::error_code none;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  for (const auto& folder : {program / "bones", program / "../share/burr/bones"}) {
    const std::filesystem::path path = folder / (name + ".bone");
    std::ifstream in(path, std::ios::binary);
    if (!in) continue;
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), {}};
    auto bone = record::bone_from_blob(record::ByteSpan(bytes), reserve_bricks, path.string());
    if (bone) return std::move(*bone);
  }
  return nullptr;
}

Status write_prebuilt_phantom(const volume::Bone& bone, const std::string& path) {
  Result<base::NewFile> file = base::NewFile::create(path);
  if (!file) return file.error();
  const std::vector<std::uint8_t> bytes = record::bone_to_blob(bone);
  file->write(bytes.data(), bytes.size());
  return file->put_in_place();
}

}  // namespace burr::workshop
