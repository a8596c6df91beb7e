// A scene as the file of a case, and back: the program runs it, with the same hash.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

#include "burr/base/new_file.h"
#include "burr/base/text_file.h"
#include "burr/scenario/write_case.h"
#include "burr/tick/setting_table.h"
#include "burr/workshop/prebuilt_phantom.h"
#include "burr/workshop/prepare.h"
#include "common.h"
#include "scene_setup.h"

namespace burr::python {
namespace {

namespace fs = std::filesystem;
using namespace py::literals;

constexpr std::uintmax_t kLargestTools = 1U << 20;  // [byte]
constexpr const char* kTitle = "A scene from Python";

// The path as the file of a case in that folder names it.
std::string beside(const std::string& path, const fs::path& folder) {
  if (path.empty() || folder.empty()) return path;
  std::error_code none;
  const fs::path whole = fs::absolute(path, none).lexically_normal();
  const fs::path from = fs::absolute(folder, none).lexically_normal() / "";
  const fs::path part = whole.lexically_relative(from);
  return part.empty() || *part.begin() == ".." ? whole.string() : part.string();
}

// True: the bone is that of a source and a voxel size, which a case can name.
bool has_a_name(const BoneBox& box) {
  if (box.recipe.source.empty()) return false;
  scenario::BoneRecipe plain;
  plain.source = box.recipe.source;
  plain.voxel_mm = box.recipe.voxel_mm;
  plain.reserve_bricks = box.recipe.reserve_bricks;
  return plain == box.recipe;
}

// The number with the fewest digits that gives the same bits to a session.
double shortest(const SceneSetup& scene, const char* word) {
  const auto to_si = tick::setting_of_word(word)->about.typed.to_si;
  const double value = std::get<double>(scene.settings.at(word));
  for (int digits = 1; digits < 17; ++digits) {
    const double tried = std::stod(fmt::format("{:.{}g}", value, digits));
    if (to_si(tried) == to_si(value)) return tried;
  }
  return value;
}

// bone: the file of the bone; empty: that of the scene.
std::string text_of(const SceneSetup& scene, const fs::path& folder, const std::string& bone) {
  if (!scene.law.is_none())
    raise(
        "a case holds no law of your own; set scene.law to None, and set it again in the scene "
        "that is made of the text");
  scenario::CaseFile file;
  if (scene.work) {
    file.name = scene.work->name;
    file.from = scene.work->text;
    file.rubric = beside(scene.work->rubric, folder);
  }
  // a title that nobody changed keeps its languages
  if (!scene.work)
    file.title = scene.title.empty() ? kTitle : scene.title;
  else if (scene.title != scene.work->title)
    file.title = scene.title;
  const scenario::BoneRecipe& recipe = scene.bone->recipe;
  if (!bone.empty())
    file.volume = bone;
  else if (!has_a_name(*scene.bone))
    raise(
        "a case cannot name this bone, because it comes from an array, a session or a recipe of "
        "its "
        "own; save() writes it beside the case");
  else if (scenario::is_phantom(recipe.source))
    file.phantom = scenario::phantom_name(recipe.source);
  else
    file.volume = beside(recipe.source, folder);
  if (bone.empty()) file.voxel_mm = recipe.voxel_mm;
  static_cast<void>(servo_of(scene));  // refuses what is out of range by the name of its property
  file.burr_mm = shortest(scene, "burr_mm");
  file.rpm = shortest(scene, "rpm");
  file.diamond = std::get<bool>(scene.settings.at("diamond"));
  file.tool = scene.tool;
  if (!scene.tools.empty())
    file.tools = take(base::text_of_file(scene.tools, kLargestTools, "a list of tools"));
  for (const auto& [word, value] : scene.settings)
    if (tick::setting_of_word(word)->about.typed.place == tick::Typed::Place::session)
      file.session.set(word, value);
  file.motion = scene.motion;
  file.seconds = scene.seconds;
  return take(scenario::write_case(file));
}

void save(const SceneSetup& scene, const std::string& path, bool force) {
  const fs::path file(path);
  if (file.extension() != ".toml") raise(fmt::format("{}: the name must end in .toml", path));
  fs::path bone = file;
  bone.replace_extension(".bone");
  // the bone of the file itself stays
  std::error_code none;
  const bool named = has_a_name(*scene.bone);
  for (const fs::path& one : {file, bone})
    if (!force && (one == file || !named) && fs::exists(one, none))
      raise(fmt::format("{} exists; give force=True to replace it", one.string()));
  const std::string text =
      text_of(scene, file.has_parent_path() ? file.parent_path() : fs::path("."),
              named ? std::string() : bone.filename().string());
  if (!named) check(workshop::write_prebuilt_phantom(*scene.bone->bone, bone.string()));
  auto written = take(base::NewFile::create(path, base::kForAll));
  written.write(text);
  check(written.put_in_place());
}

SceneSetup from_toml(const std::string& text, const std::string& name, const std::string& folder,
                     const py::object& call) {
  SceneSetup scene;
  scene.work = take(scenario::parse_case(text, name + ".toml"));
  for (std::string* path : {&scene.work->volume, &scene.work->rubric})
    if (!path->empty() && !folder.empty() && fs::path(*path).is_relative())
      *path = (fs::path(folder) / *path).string();
  open_bone(scene, workshop::recipe_of(*scene.work), call);
  take_work(scene, true);
  return scene;
}

}  // namespace

void add_scene_file(py::class_<SceneSetup>& scene) {
  scene.def(
      "to_toml",
      [](const SceneSetup& self, const std::string& folder) { return text_of(self, folder, {}); },
      py::kw_only(), "folder"_a = "",
      "The text of a case (docs/use/cases.md); paths are named from the folder.");
  scene.def_static("from_toml", &from_toml, "text"_a, py::kw_only(), "name"_a = "scene",
                   "folder"_a = "", "progress"_a = py::none(),
                   "The scene of such a text; paths count from the folder.");
  scene.def("save", &save, "path"_a, py::kw_only(), "force"_a = false,
            "Writes the file of a case, X.toml; a bone that no file holds goes beside it, X.bone.");
}

}  // namespace burr::python
