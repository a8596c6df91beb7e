#include "burr/io/read/volume_folder.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/merge_structures.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;

// Parts of names that people give to label maps and their folders, in small letters.
constexpr const char* kLabelWords[] = {"seg", "label", "mask", "parc", "annot", "roi"};

bool named_as_labels(const fs::path& path, const fs::path& folder) {
  const std::string name = lower(path.lexically_relative(folder).string());
  return std::any_of(std::begin(kLabelWords), std::end(kLabelWords),
                     [&](const char* word) { return name.find(word) != std::string::npos; });
}

// "femur_left" of "femur_left.nii.gz"
std::string stem_of(const fs::path& path) {
  std::string name = path.filename().string();
  bool cut = true;
  while (cut) {
    cut = false;
    for (const char* ending :
         {".gz", ".bz2", ".bgz", ".nii", ".hdr", ".nrrd", ".nhdr", ".mha", ".mhd", ".seg"}) {
      const std::string small = lower(name);
      if (small.size() <= std::string_view(ending).size() || !small.ends_with(ending)) continue;
      name.resize(name.size() - std::string_view(ending).size());
      cut = true;
    }
  }
  return name;
}

// The structures' names: those of the files; of the folders where each file has the same name; of both where some have.
std::vector<std::string> names_of_structures(const std::vector<fs::path>& files) {
  std::map<std::string, std::size_t> count;
  for (const fs::path& file : files) ++count[stem_of(file)];
  std::vector<std::string> out;
  for (const fs::path& file : files) {
    const std::string stem = stem_of(file), folder = file.parent_path().filename().string();
    const bool twice = count[stem] > 1 && !folder.empty();
    out.push_back(!twice ? stem : count.size() == 1 ? folder : folder + " " + stem);
  }
  return out;
}

// ---- what a file holds

enum class Holds { scan, mask, probability, several };

template <class T>
bool one_value(const Voxels<T>& values, double& value) {
  if (values.empty()) return false;
  value = static_cast<double>(values.front());
  return std::all_of(values.begin(), values.end(), [&](T v) { return v == values.front(); });
}

Holds held_by(const Scan& scan) {
  if (!scan.labels.empty()) {
    std::array<bool, 256> there{};
    for (const std::uint8_t label : scan.labels) there[label] = true;
    return std::count(there.begin() + 1, there.end(), true) > 1 ? Holds::several : Holds::mask;
  }
  constexpr double kFull = 255;  // of a byte
  double only = 0;
  if (one_value(scan.values, only))
    return only == 0 || only == 1 || only == kFull ? Holds::mask : Holds::scan;
  const bool share =
      std::all_of(scan.values.begin(), scan.values.end(), [](float v) { return v >= 0 && v <= 1; });
  return share && !scan.hounsfield ? Holds::probability : Holds::scan;
}

LooseStructure structure_of(const Scan& scan, const std::string& name, const fs::path& file) {
  LooseStructure out;
  out.label = {.value = 0, .name = name, .colour = volume::Tissue{}.colour};
  out.file = short_name(file);
  out.places = places_of(scan);
  constexpr float kInside = 0.5F;
  for (std::size_t v = 0; v < scan.labels.size(); ++v)
    if (scan.labels[v] != 0) out.add(v);
  for (std::size_t v = 0; v < scan.values.size(); ++v)
    if (scan.values[v] >= kInside) out.add(v);
  // what the file itself says of its one structure
  const auto named =
      std::find_if(scan.label_names.begin(), scan.label_names.end(), [&](const Label& label) {
        return std::find(scan.labels.begin(), scan.labels.end(), label.value) != scan.labels.end();
      });
  if (named == scan.label_names.end() || named->value == 0) return out;
  out.label.colour = named->colour;
  out.label.meaning = named->meaning;
  return out;
}

// What all files of the folder hold.
struct Sorted {
  std::vector<LooseStructure> masks;
  std::vector<fs::path> mask_files, several, shares;
  std::optional<Scan> scan, label_map;
  fs::path scan_file;
  bool reversed = false;                                    // Scan::k_reversed of the first mask
  std::map<std::string, std::vector<std::string>> notices;  // of the masks, and their files
  std::vector<Question> questions;
};

class FolderReader {
 public:
  FolderReader(const VolumeFolder& in, const ReadOptions& options, Progress& progress)
      : in_(in), options_(options), progress_(progress) {}

  Result<Scan> read() {
    std::vector<fs::path> scans = in_.files;
    const auto middle = std::stable_partition(
        scans.begin(), scans.end(),
        [&](const fs::path& path) { return !named_as_labels(path, in_.folder); });
    const std::vector<fs::path> labels(middle, scans.end());
    scans.erase(middle, scans.end());
    if (scans.size() == 1) {  // as its name says, perhaps
      auto scan = in_.read(scans.front());
      if (!scan) return scan.error();
      if (held_by(*scan) == Holds::scan) {
        found_.scan = std::move(*scan);
        found_.scan_file = scans.front();
        return beside_scan(labels, false);
      }
      if (Status status = sort_in(std::move(*scan), scans.front()); !status) return status.error();
      scans = labels;
    } else {
      scans = in_.files;
    }
    if (Status status = read_all(scans); !status) return status.error();
    if (!found_.scan) {
      if (!options_.series.empty() && options_.series != "#1")
        return error(Trouble::usage,
                     fmt::format("{}: holds one label map, and `series` names another, \"{}\"; "
                                 "leave it out",
                                 folder(), base::printable(options_.series)));
      return labels_alone();
    }
    std::vector<fs::path> others = in_.files;
    std::erase(others, found_.scan_file);
    return beside_scan(others, true);
  }

 private:
  [[nodiscard]] std::string folder() const { return short_name(in_.folder); }

  [[nodiscard]] Error too_many() const {
    return error(fmt::format("{}: holds {} scans or label maps ({}); give burr one of these files",
                             folder(), in_.files.size(), names_of(in_.files)));
  }

  Status read_all(const std::vector<fs::path>& files) {
    for (std::size_t n = 0; n < files.size(); ++n) {
      progress_.report(static_cast<double>(n) / static_cast<double>(files.size()), "reading");
      if (progress_.cancelled()) return error(Trouble::interrupted, "reading was stopped");
      auto scan = in_.read(files[n]);
      if (!scan) return scan.error();
      if (Status status = sort_in(std::move(*scan), files[n]); !status) return status;
    }
    return fine();
  }

  Status sort_in(Scan scan, const fs::path& file) {
    const Holds holds = held_by(scan);
    if (holds == Holds::scan) {
      if (found_.scan) return too_many();
      found_.scan = std::move(scan);
      found_.scan_file = file;
      return fine();
    }
    if (holds == Holds::several) {
      if (!found_.several.empty() && found_.masks.empty()) return too_many();
      found_.several.push_back(file);
      if (found_.several.size() == 1) found_.label_map = std::move(scan);
      return fine();
    }
    if (found_.masks.empty()) found_.reversed = scan.k_reversed;
    found_.masks.push_back(structure_of(scan, "", file));
    found_.mask_files.push_back(file);
    if (holds == Holds::probability) {
      found_.shares.push_back(file);
      return fine();  // what was said of its values is of grey ones
    }
    if (!scan.labels.empty())
      for (const std::string& notice : scan.notices)
        found_.notices[notice].push_back(short_name(file));
    for (Question& question : scan.questions)
      if (std::none_of(found_.questions.begin(), found_.questions.end(),
                       [&](const Question& q) { return q.ask == question.ask; }))
        found_.questions.push_back(std::move(question));
    return fine();
  }

  // The masks, or the one label map.
  Result<Scan> labels_alone() {
    constexpr std::size_t kLeast = 2;  // fewer masks do not say what the folder is
    if (found_.several.size() == 1 && found_.masks.empty()) return std::move(*found_.label_map);
    if (found_.several.size() > 1 || (found_.several.size() == 1 && found_.masks.size() < kLeast))
      return too_many();
    Scan scan;
    scan.format = found_.masks.size() == 1 ? "mask" : "masks";
    scan.k_reversed = found_.reversed;
    const std::vector<std::string> names = names_of_structures(found_.mask_files);
    for (std::size_t n = 0; n < names.size(); ++n) found_.masks[n].label.name = names[n];
    for (const auto& [notice, files] : found_.notices)
      scan.notices.push_back(fmt::format(
          "{}{}: {}", files.front(),
          files.size() > 1 ? fmt::format(" and {} more", files.size() - 1) : "", notice));
    scan.questions = found_.questions;
    if (names.size() > 1)
      scan.notices.push_back(
          fmt::format("{} masks, one file a structure, became one label map; each structure has "
                      "the name of its file.",
                      names.size()));
    if (!found_.shares.empty())
      scan.notices.push_back(
          fmt::format("{} {} a probability for each voxel (0 to 1): voxels of 0.5 or more are "
                      "inside, all others outside.",
                      names_of(found_.shares), found_.shares.size() == 1 ? "states" : "state"));
    if (!found_.several.empty())
      scan.notices.push_back(fmt::format(
          "{} holds several structures and was left out. To use it instead, give burr that file.",
          short_name(found_.several.front())));
    if (Status status = merge_structures(found_.masks, std::nullopt, folder(), scan, progress_);
        !status)
      return status.error();
    return scan;
  }

  // The scan, or, as the second of the list, the labels beside it.
  Result<Scan> beside_scan(const std::vector<fs::path>& labels, bool labels_are_read) {
    const VoxelPlaces places = places_of(*found_.scan);
    const std::vector<std::string> list = {
        fmt::format("#1: scan {}, {} x {} x {}", short_name(found_.scan_file), places.size.x(),
                    places.size.y(), places.size.z()),
        labels.size() == 1 ? fmt::format("#2: labels {}", short_name(labels.front()))
                           : fmt::format("#2: labels of {} files as one label map", labels.size())};
    const bool second = options_.series == "#2";
    if (!second && !options_.series.empty() && options_.series != "#1")
      return error(Trouble::usage,
                   fmt::format("{}: `series` \"{}\" matches none of {}; {}", folder(),
                               base::printable(options_.series), list[0], list[1]));
    std::optional<Result<Scan>> scan;
    if (!second) {
      scan = std::move(*found_.scan);
      (*scan)->notices.push_back(fmt::format(
          "{} was read; {} {} beside it and {} left out. To use {} instead, choose \"#2\" with "
          "`series`{}.",
          short_name(found_.scan_file), names_of(labels), labels.size() == 1 ? "lies" : "lie",
          labels.size() == 1 ? "was" : "were", labels.size() == 1 ? "it" : "them as one label map",
          labels.size() == 1 ? ", or give burr that file" : ""));
    } else {
      found_.scan.reset();
      if (!labels_are_read)
        if (Status status = read_all(labels); !status) return status.error();
      if (found_.scan) return too_many();
      scan = labels_alone();
      if (!*scan) return scan->error();
      const VoxelPlaces own = places_of(**scan);
      if (!turn_of(own, places))
        (*scan)->notices.push_back(fmt::format("The labels have other voxels than {} ({}; {}).",
                                               short_name(found_.scan_file), in_words(own),
                                               in_words(places)));
    }
    (*scan)->series = list;
    (*scan)->series_dates.assign(list.size(), "");
    (*scan)->series_taken = second ? 1 : 0;
    return std::move(*scan);
  }

  const VolumeFolder& in_;
  const ReadOptions& options_;
  Progress& progress_;
  Sorted found_;
};

}  // namespace

std::string names_of(const std::vector<fs::path>& files) {
  constexpr std::size_t kNamed = 6;
  std::string text;
  for (std::size_t n = 0; n < std::min(files.size(), kNamed); ++n)
    text += (n > 0 ? ", " : "") + short_name(files[n]);
  return files.size() > kNamed ? fmt::format("{} and {} more", text, files.size() - kNamed) : text;
}

Result<Scan> read_volume_folder(const VolumeFolder& in, const ReadOptions& options,
                                Progress& progress) {
  return FolderReader(in, options, progress).read();
}

}  // namespace burr::io
