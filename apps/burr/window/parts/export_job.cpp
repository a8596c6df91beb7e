#include "window/parts/export_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "burr/io/export_part.h"
#include "burr/render/picture.h"
#include "burr/volume/shared_copy.h"
#include "shared/piece_files.h"
#include "window/parts/film_job.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

bool ends_with(const std::string& path, const std::string& ending) {
  return path.size() >= ending.size() &&
         std::equal(ending.rbegin(), ending.rend(), path.rbegin(), [](char e, char p) {
           return e == std::tolower(static_cast<unsigned char>(p));
         });
}

const char* name_of(ExportWhat what) {
  switch (what) {
    case ExportWhat::removed:
      return "removed";
    case ExportWhat::added:
      return "added";
    case ExportWhat::pieces:
      return "piece";
    case ExportWhat::picture:
      return "picture";
    case ExportWhat::film:
      return "film";
    default:
      return "bone";
  }
}

io::ExportOptions options_of(ExportWhat what) {
  io::ExportOptions options;
  options.part = what == ExportWhat::removed ? io::Part::removed
                 : what == ExportWhat::added ? io::Part::added
                                             : io::Part::bone;
  return options;
}

}  // namespace

const std::vector<std::string>& endings_of(ExportWhat what) {
  static const std::vector<std::string> bone = {".stl", ".ply",      ".obj", ".3mf",
                                                ".glb", ".seg.nrrd", ".nrrd"},
                                        picture = {".png"}, film = {".mp4"};
  return what == ExportWhat::film ? film : what == ExportWhat::picture ? picture : bone;
}

std::string ending_of(const std::string& path, ExportWhat what) {
  for (const std::string& ending : endings_of(what))  // the order matters: .seg.nrrd before .nrrd
    if (ends_with(path, ending)) return ending;
  return {};
}

std::string path_for(const std::string& path, ExportWhat what, const std::string& ending) {
  std::string bare = path;
  for (const ExportWhat any : {ExportWhat::bone, ExportWhat::picture, ExportWhat::film})
    if (const std::string old = ending_of(path, any); !old.empty())
      bare = path.substr(0, path.size() - old.size());
  const fs::path whole(bare);
  const std::string name = whole.filename().string();
  constexpr ExportWhat kAll[] = {ExportWhat::bone,   ExportWhat::removed, ExportWhat::added,
                                 ExportWhat::pieces, ExportWhat::picture, ExportWhat::film};
  const bool ours =
      name.empty() || std::any_of(std::begin(kAll), std::end(kAll),
                                  [&](ExportWhat one) { return name == name_of(one); });
  return (ours ? whole.parent_path() / name_of(what) : whole).string() + ending;
}

bool already_there(const ExportRequest& request) {
  std::error_code nobody_asks;
  if (request.what == ExportWhat::film) return holds_film(request.path);
  return fs::exists(request.what == ExportWhat::pieces ? numbered(request.path, 1) : request.path,
                    nobody_asks);
}

Status check_request(const ExportRequest& request) {
  if (request.path.empty()) return error(Trouble::usage, "enter a name for the file");
  std::error_code nobody_asks;
  if (request.what == ExportWhat::film) {
    const bool folder = fs::is_directory(request.path, nobody_asks);
    if (is_film_file(request.path) && folder)
      return error(Trouble::usage, request.path + ": is a folder; add a name for the film");
    if (!is_film_file(request.path) && !folder && fs::exists(request.path, nobody_asks))
      return error(Trouble::usage, request.path +
                                       ": is a file; pictures of a film go into a folder, choose "
                                       "another name, or one that ends in .mp4");
  } else if (fs::is_directory(request.path, nobody_asks))
    return error(Trouble::usage, request.path + ": is a folder; add a name for the file");
  if (request.what == ExportWhat::picture) {
    if (ending_of(request.path, request.what).empty())
      return error(Trouble::usage,
                   request.path + ": unknown file extension; use .png for a picture");
  } else if (request.what == ExportWhat::film) {
    // a film: any name is possible
  } else if (const Status possible = io::check_export(request.path, options_of(request.what));
             !possible) {
    return possible;
  }
  const fs::path folder = fs::path(request.path).parent_path();
  if (!folder.empty() && !fs::is_directory(folder, nobody_asks))
    return error(
        Trouble::io,
        fmt::format("{}: this folder does not exist; make it, or choose another", folder.string()));
  return fine();
}

Result<ExportDone> write_export(const ExportRequest& request, const volume::Bone& bone,
                                rt::ChangedBits& changed, const volume::Bone* before,
                                const edit::PieceStore& store, const render::Image* picture,
                                Progress& progress) {
  if (request.what == ExportWhat::picture) {
    const Status written = picture != nullptr ? render::write_png(*picture, request.path)
                                              : Status(error("no picture"));
    if (!written) return written.error();
    return ExportDone{.path = request.path};
  }
  const auto now = volume::shared_copy(bone, changed, progress);
  if (!now) return now.error();
  if (request.what == ExportWhat::pieces) {
    // the export page has asked before whether files may be replaced
    const auto may_write = [](const std::string&) { return fine(); };
    const auto written =
        write_pieces(**now, request.path, options_of(request.what), may_write, progress, store);
    if (!written) return written.error();
    double volume = 0;
    for (const PieceFiles::One& one : written->files) volume += one.volume;
    return ExportDone{
        .path = written->files.front().path, .volume = volume, .pieces = written->files.size()};
  }
  const auto exported = io::export_part(before != nullptr ? *before : **now, **now, request.path,
                                        options_of(request.what), progress);
  if (!exported) return exported.error();
  return ExportDone{
      .path = request.path, .volume = exported->volume, .triangles = exported->triangles};
}

}  // namespace burr::app
