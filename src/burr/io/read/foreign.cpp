#include "burr/io/read/foreign.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "burr/io/read/text.h"

namespace burr::io {
namespace {

constexpr const char* kStack =
    "burr reads stacks of TIFF, PNG and BMP pictures in grey; save the stack as TIFF and give the "
    "folder that holds it";
constexpr const char* kMesh =
    "it is a surface without an inside; give burr the scan or the segmentation that it was made "
    "from, or make a label map of it in 3D Slicer (import it as a segmentation) and save it as "
    ".seg.nrrd";

}  // namespace

bool left_by_a_system(const std::filesystem::path& path) {
  const std::string name = lower(path.filename().string());
  return name.starts_with(".") || name == "__macosx" || name == "thumbs.db" ||
         name == "desktop.ini" || name == "autorun.inf";
}

bool left_by_a_system(const std::filesystem::path& path, const std::filesystem::path& root) {
  const std::filesystem::path below = path.lexically_relative(root);
  return std::any_of(below.begin(), below.end(),
                     [](const std::filesystem::path& part) { return left_by_a_system(part); });
}

bool named_as_picture(const std::filesystem::path& path) {
  const std::string ending = lower(path.extension().string());
  return ending == ".tif" || ending == ".tiff" || ending == ".png" || ending == ".bmp";
}

Foreign foreign(const std::filesystem::path& path, const std::vector<std::uint8_t>& head) {
  const std::string_view bytes(reinterpret_cast<const char*>(head.data()), head.size());
  const std::string ending = lower(path.extension().string());
  const auto begins = [&](std::string_view mark) { return bytes.starts_with(mark); };
  const auto ends = [&](std::initializer_list<const char*> all) {
    return std::find(all.begin(), all.end(), ending) != all.end();
  };
  using namespace std::string_view_literals;
  if (begins("\xFF\xD8\xFF")) return {"a JPEG picture", kStack};
  if (begins("\0\0\0\x0CjP  "sv)) return {"a JPEG 2000 picture", kStack};
  if (begins("ply\n") || begins("ply\r")) return {"a PLY mesh", kMesh};
  if (begins("glTF") || ends({".gltf"})) return {"a glTF mesh", kMesh};
  if (ends({".stl"})) return {"an STL mesh", kMesh};
  if (ends({".obj"})) return {"an OBJ mesh", kMesh};
  if (ends({".3mf"})) return {"a 3MF mesh", kMesh};
  if (begins("# vtk DataFile") || begins("<VTKFile"))
    return {"a VTK file", "open it in 3D Slicer and save it as .nrrd"};
  if (begins("%PDF"))
    return {"a PDF document", "give burr the DICOM files that belong to this report"};
  if (begins("7z\xBC\xAF\x27\x1C")) return {"a 7z archive", "unpack it and give burr the folder"};
  if (begins("Rar!")) return {"a RAR archive", "unpack it and give burr the folder"};
  if (ends({".tar", ".tgz"})) return {"a tar archive", "unpack it and give burr the folder"};
  if (ends({".mgz", ".mgh"}))
    return {"a FreeSurfer volume", "convert it with mri_convert in.mgz out.nii.gz"};
  return {};
}

}  // namespace burr::io
