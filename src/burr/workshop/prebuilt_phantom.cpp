#include "burr/workshop/prebuilt_phantom.h"

#include <dlfcn.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/record/bone_blob.h"

namespace burr::workshop {
namespace {

// Beside the program and beside this library, which another program may have loaded (Python); in a
// build tree, and where it is installed.
std::vector<std::filesystem::path> folders() {
  std::error_code none;
  std::vector<std::filesystem::path> found;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  found = {program / "bones", program / "../share/burr/bones"};
  Dl_info here{};
  if (::dladdr(reinterpret_cast<const void*>(&prebuilt_phantom), &here) != 0)
    if (const auto library = std::filesystem::canonical(here.dli_fname, none); !none)
      for (const char* folder : {"bones", "../share/burr/bones", "../../share/burr/bones"})
        found.push_back(library.parent_path() / folder);
  return found;
}

}  // namespace

std::unique_ptr<volume::Bone> prebuilt_phantom(const std::string& phantom,
                                               std::size_t reserve_bricks) {
  // "jaw?long,defect" lies in jaw-long-defect.bone
  std::string name = phantom;
  for (char& one : name)
    if (one == '?' || one == ',') one = '-';
  for (const std::filesystem::path& folder : folders()) {
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
  Result<base::NewFile> file = base::NewFile::create(path, base::kForAll);
  if (!file) return file.error();
  const std::vector<std::uint8_t> bytes = record::bone_to_blob(bone);
  file->write(bytes.data(), bytes.size());
  return file->put_in_place();
}

}  // namespace burr::workshop
