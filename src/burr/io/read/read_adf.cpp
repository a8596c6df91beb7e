// Volumes of AMBF: an ADF (.yaml) that names numbered PNG pictures and the size of the whole. As in
// FIVRS, each colour is one structure. The order of names, rows and numbers is that of AMBF's own
// loader: the picture's last row is the first of the volume.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <system_error>

#include "burr/base/printable.h"
#include "burr/io/read/adf_folder.h"
#include "burr/io/read/archive.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/png.h"
#include "burr/io/read/readers.h"
#include "burr/io/read/samples.h"
#include "burr/io/read/text.h"
#include "burr/io/read/yaml.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;
using math::Vec3;

// What the ADF says about its volume.
struct Adf {
  Vec3 size_mm = Vec3::Zero();  // of the whole, from face to face
  double scale = 1;
  std::string path, prefix, format = "png";
  std::int64_t count = 0;  // 0: not stated
};

const Yaml* map_at(const Yaml& in, const char* key) {
  const Yaml* found = in.find(key);
  return found != nullptr && found->kind == Yaml::Kind::map ? found : nullptr;
}

std::string text_at(const Yaml& in, const char* key) {
  const Yaml* found = in.find(key);
  return found != nullptr && found->kind == Yaml::Kind::text ? found->text : std::string();
}

// The names under "volumes:"
std::vector<std::string> volumes_of(const Yaml& root) {
  std::vector<std::string> out;
  const Yaml* list = root.find("volumes");
  if (list != nullptr && list->kind == Yaml::Kind::list)
    for (const Yaml& one : list->values)
      if (one.kind == Yaml::Kind::text) out.push_back(one.text);
  return out;
}

Result<Yaml> yaml_of(const fs::path& path) {
  constexpr std::size_t kLongest = std::size_t{4} << 20;
  auto bytes = first_bytes(path, kLongest + 1);
  if (!bytes) return bytes.error();
  if (bytes->size() > kLongest)
    return error(
        fmt::format("{}: is larger than 4 MiB and so no description file (ADF)", short_name(path)));
  return parse_yaml({reinterpret_cast<const char*>(bytes->data()), bytes->size()},
                    short_name(path));
}

Result<Adf> adf_of(const fs::path& path) {
  const std::string file = short_name(path);
  const auto root = yaml_of(path);
  if (!root) return root.error();
  const std::vector<std::string> names = volumes_of(*root);
  if (names.empty())
    return error(
        fmt::format("{}: is no description of a volume: \"volumes\" is missing or empty; "
                    "give the ADF that names the pictures",
                    file));
  if (names.size() > 1)
    return error(
        fmt::format("{}: describes {} volumes, and burr reads one; leave one of them in "
                    "\"volumes\"",
                    file, names.size()));
  const Yaml* volume = map_at(*root, names[0].c_str());
  if (volume == nullptr)
    return error(fmt::format("{}: volumes names \"{}\", but the file does not describe it", file,
                             base::printable(names[0])));
  Adf adf;
  const Yaml* size = map_at(*volume, "dimensions");
  const std::array<const char*, 3> axes = {"x", "y", "z"};
  for (Eigen::Index a = 0; a < 3; ++a) {
    double metres = 0;
    const bool good = size != nullptr &&
                      to_number(text_at(*size, axes[static_cast<std::size_t>(a)]), metres) &&
                      metres > 0 && metres < 1e4;
    if (!good)
      return error(
          fmt::format("{}: dimensions must be three lengths above 0 in metres (x, y, z), "
                      "written out; correct {}",
                      file, axes[static_cast<std::size_t>(a)]));
    adf.size_mm[a] = metres * 1e3;
  }
  if (const std::string scale = text_at(*volume, "scale"); !scale.empty())
    if (!to_number(scale, adf.scale) || !(adf.scale > 0 && adf.scale < 1e6))
      return error(fmt::format("{}: scale \"{}\" is not a number above 0; correct it", file,
                               base::printable(scale)));
  const Yaml* images = map_at(*volume, "images");
  if (images == nullptr)
    return error(
        fmt::format("{}: the volume names no pictures (\"images\"); burr reads volumes of "
                    "PNG pictures",
                    file));
  adf.path = text_at(*images, "path");
  adf.prefix = text_at(*images, "prefix");
  if (const std::string format = text_at(*images, "format"); !format.empty())
    adf.format = lower(format);
  if (adf.format != "png")
    return error(
        fmt::format("{}: images: format \"{}\": burr reads png; JPEG would blur the "
                    "colours of the labels",
                    file, base::printable(adf.format)));
  const std::string count = text_at(*images, "count");
  if (!count.empty() && (!to_number(count, adf.count) || adf.count < 0))
    return error(fmt::format("{}: images: count \"{}\" is not a number of pictures; correct it",
                             file, base::printable(count)));
  return adf;
}

// ---- the pictures

// "plane0012.png" with the prefix "plane00": 12. Nothing: another name.
std::optional<int> number_of(const std::string& name, const std::string& prefix) {
  constexpr std::size_t kMostDigits = 9;
  if (name.size() <= prefix.size() || name.compare(0, prefix.size(), prefix) != 0 ||
      lower(fs::path(name).extension().string()) != ".png")
    return std::nullopt;
  const std::string digits = name.substr(prefix.size(), name.size() - prefix.size() - 4);
  std::int64_t number = 0;
  if (digits.empty() || digits.size() > kMostDigits ||
      digits.find_first_not_of("0123456789") != std::string::npos || !to_number(digits, number))
    return std::nullopt;
  return static_cast<int>(number);
}

using Numbered = std::map<int, fs::path>;

Result<Numbered> pictures_in(const fs::path& folder, const fs::path& adf_path, const Adf& adf) {
  const std::string file = short_name(adf_path);
  Numbered out;
  std::string twice;
  const auto take = [&](const fs::path& path) {
    const auto number = number_of(path.filename().string(), adf.prefix);
    if (number && !out.emplace(*number, path).second && twice.empty())
      twice = fmt::format("{} and {}", short_name(out[*number]), short_name(path));
  };
  if (const auto packed = archive_around(adf_path)) {
    for (const fs::path& path : *packed)
      if (path.parent_path() == folder) take(path);
  } else {
    std::error_code trouble, kind;
    if (!fs::is_directory(fs::symlink_status(folder, trouble)))
      return error(
          fmt::format("{}: the folder of its pictures, \"{}\", is missing or cannot be "
                      "read; put it where the file says",
                      file, base::printable(adf.path)));
    for (fs::directory_iterator at(folder, trouble), end; !trouble && at != end;
         at.increment(trouble))
      if (at->is_regular_file(kind) && !at->is_symlink(kind)) take(at->path());
    if (trouble)
      return error(Trouble::io,
                   fmt::format("{}: the folder of its pictures, \"{}\", cannot be read", file,
                               base::printable(adf.path)));
  }
  if (!twice.empty())
    return error(fmt::format("{}: {} have the same number; remove one of them", file, twice));
  if (out.empty())
    return error(fmt::format("{}: \"{}\" holds no picture named {} and a number (.png)", file,
                             base::printable(adf.path), base::printable(adf.prefix)));
  return out;
}

// ---- colours

constexpr std::size_t kMostColours = 255;
constexpr std::uint32_t kTwice = std::uint32_t{1} << 24;  // beside the colour: alpha is 254

// One label for each colour. Voxels hold an index into the colours until all are known.
class Colours {
 public:
  // False: there are too many.
  bool take(const std::uint8_t* rgba, std::uint8_t& index) {
    const std::uint32_t colour =
        std::uint32_t{rgba[0]} << 16 | std::uint32_t{rgba[1]} << 8 | std::uint32_t{rgba[2]};
    index = 0;
    if (rgba[3] == 0 || colour == 0) return true;
    const std::uint32_t key = rgba[3] == 254 ? colour | kTwice : colour;
    if (key == last_) {
      index = last_index_;
      ++counts_[index];
      return true;
    }
    auto found = known_.find(key);
    if (found == known_.end()) {
      if (known_.size() == kMostColours) return false;
      found = known_.emplace(key, static_cast<std::uint8_t>(known_.size() + 1)).first;
    }
    last_ = key;
    index = last_index_ = found->second;
    ++counts_[index];
    return true;
  }

  [[nodiscard]] bool all_grey() const {
    return std::all_of(known_.begin(), known_.end(), [](const auto& one) {
      const std::uint32_t c = one.first;
      return (c >> 16 & 0xFF) == (c & 0xFF) && (c >> 8 & 0xFF) == (c & 0xFF);
    });
  }
  // The brightness of each index, where all are grey.
  [[nodiscard]] std::array<std::uint8_t, 256> greys() const {
    std::array<std::uint8_t, 256> out{};
    for (const auto& [key, index] : known_) out[index] = static_cast<std::uint8_t>(key & 0xFF);
    return out;
  }

  // The label of each index, numbered by colour (red first); names and notices go into the scan.
  std::array<std::uint8_t, 256> labels(Scan& scan) const {
    std::array<std::uint8_t, 256> out{};
    std::size_t overlap = 0;
    std::map<std::uint32_t, std::uint8_t> colours;  // of their own
    for (const auto& [key, index] : known_)
      if (key < kTwice || !parts_of(key)) colours[key] = 0;
    std::uint8_t number = 0;
    for (auto& [key, label] : colours) {
      label = ++number;
      Label one{
          .value = number,
          .name = fmt::format("colour {},{},{}", key >> 16 & 0xFF, key >> 8 & 0xFF, key & 0xFF)};
      for (std::size_t c = 0; c < 3; ++c)
        one.colour[c] = static_cast<float>(key >> (16 - 8 * c) & 0xFF) / 255.0F;
      scan.label_names.push_back(std::move(one));
    }
    for (const auto& [key, index] : known_) {
      const auto own = colours.find(key);
      const std::uint32_t stays = own != colours.end() ? key : *parts_of(key);
      out[index] = colours.at(stays);
      if (own == colours.end()) overlap += counts_[index];
    }
    scan.notices.push_back(
        fmt::format("The {} colours of the pictures are the labels, numbered by red, green and "
                    "blue; black and transparent is air. `labels` gives them names by their "
                    "colours.",
                    colours.size()));
    if (overlap > 0)
      scan.notices.push_back(fmt::format(
          "Structures overlap in {} voxels (colours added up): there the smaller one stays.",
          overlap));
    return out;
  }

 private:
  // Where two structures overlap, the converter of FIVRS added their colours and alphas and kept
  // the lowest 8 bits: alpha 254. The smaller of the two, if exactly one pair gives this colour.
  [[nodiscard]] std::optional<std::uint32_t> parts_of(std::uint32_t key) const {
    std::optional<std::uint32_t> stays;
    int pairs = 0;
    for (const auto& [a, index_a] : known_)
      for (const auto& [b, index_b] : known_) {
        if (a >= b || b >= kTwice) continue;
        bool sum = true;
        for (int shift = 0; shift <= 16; shift += 8)
          sum = sum && (((a >> shift) + (b >> shift) - (key >> shift)) & 0xFF) == 0;
        if (!sum) continue;
        ++pairs;
        stays = counts_[index_a] <= counts_[index_b] ? a : b;
      }
    return pairs == 1 ? stays : std::nullopt;
  }

  std::map<std::uint32_t, std::uint8_t> known_;
  std::array<std::size_t, 256> counts_{};
  std::uint32_t last_ = 0;
  std::uint8_t last_index_ = 0;
};

// Puts one picture into its slice: the last row first.
Status put(const Picture& picture, const std::string& file, Colours& colours, std::uint8_t* slice) {
  const auto width = static_cast<std::size_t>(picture.width),
             height = static_cast<std::size_t>(picture.height);
  for (std::size_t j = 0; j < height; ++j) {
    const std::uint8_t* from = picture.rgba.data() + (height - 1 - j) * width * 4;
    for (std::size_t i = 0; i < width; ++i)
      if (!colours.take(from + 4 * i, slice[j * width + i]))
        return error(fmt::format(
            "{}: there are more than 255 different colours up to this picture, and burr reads each "
            "as one label; save the pictures without smoothing, as PNG",
            file));
  }
  return fine();
}

std::string numbers_in_words(const std::vector<int>& numbers) {
  constexpr std::size_t kShown = 6;
  std::string list;
  for (std::size_t n = 0; n < std::min(numbers.size(), kShown); ++n)
    list += fmt::format("{}{}", n > 0 ? ", " : "", numbers[n]);
  return numbers.size() > kShown ? list + " ..." : list;
}

// Leaves out what AMBF would not read, and says what differs from the ADF.
void check_count(Numbered& pictures, const Adf& adf, const std::string& file, Scan& scan) {
  if (adf.count > 0) {
    // AMBF tries the numbers from 0 to `count`
    const std::size_t before = pictures.size();
    std::erase_if(pictures, [&](const auto& one) { return one.first > adf.count; });
    if (pictures.size() < before)
      scan.notices.push_back(
          fmt::format("{} pictures have numbers beyond the {} that the ADF "
                      "states; they were left out.",
                      before - pictures.size(), adf.count));
    if (static_cast<std::int64_t>(pictures.size()) < adf.count)
      scan.notices.push_back(fmt::format(
          "The ADF states {} pictures, and {} are there; they fill the whole height, as in AMBF.",
          adf.count, pictures.size()));
  }
  if (pictures.empty()) return;
  std::vector<int> missing;
  int next = pictures.begin()->first;
  for (const auto& [number, path] : pictures)
    for (; next <= number; ++next)
      if (next < number && missing.size() < 1000) missing.push_back(next);
  if (!missing.empty())
    scan.ask(Ask::missing, fmt::format("{}: pictures are missing between others (numbers {}); each "
                                       "is taken to be like the one before it",
                                       file, numbers_in_words(missing)));
}

Status read_pictures(const Numbered& pictures, const std::string& file, Scan& scan,
                     Progress& progress) {
  const int first = pictures.begin()->first, last = pictures.rbegin()->first;
  Colours colours;
  std::size_t slice = 0, done = 0;
  int next = first;
  for (const auto& [number, path] : pictures) {
    auto picture = read_png(path);
    if (!picture) return picture.error();
    if (slice == 0) {
      const auto count =
          voxel_count(file, picture->width, picture->height, std::int64_t{last} - first + 1);
      if (!count) return count.error();
      scan.size = {picture->width, picture->height, last - first + 1};
      slice = *count / static_cast<std::size_t>(scan.size.z());
      scan.labels.assign(*count, 0);
    }
    if (picture->width != scan.size.x() || picture->height != scan.size.y())
      return error(fmt::format(
          "{}: is {} x {} pixels large, but the pictures before it {} x {}; "
          "they do not belong together",
          short_name(path), picture->width, picture->height, scan.size.x(), scan.size.y()));
    std::uint8_t* to = scan.labels.data() + slice * static_cast<std::size_t>(number - first);
    if (Status status = put(*picture, short_name(path), colours, to); !status) return status;
    for (; next < number; ++next)  // missing ones
      std::copy_n(scan.labels.data() + slice * static_cast<std::size_t>(next - first - 1), slice,
                  scan.labels.data() + slice * static_cast<std::size_t>(next - first));
    next = number + 1;
    progress.report(static_cast<double>(++done) / static_cast<double>(pictures.size()), "reading");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  if (colours.all_grey()) {  // a grey scan, or labels as shades
    const std::array<std::uint8_t, 256> grey = colours.greys();
    VoxelSink sink(scan.labels.size());
    for (std::uint8_t& voxel : scan.labels) voxel = grey[voxel];
    sink.add_bytes(scan.labels.data(), scan.labels.size());
    Voxels<std::uint8_t>().swap(scan.labels);
    if (Status status = sink.finish(scan, false); !status)
      return error(fmt::format("{}: {}", file, status.error().text));
    return fine();
  }
  const std::array<std::uint8_t, 256> label = colours.labels(scan);
  for (std::uint8_t& voxel : scan.labels) voxel = label[voxel];
  return fine();
}

// What the size of the voxels gives reason to doubt.
void doubt_size(const Vec3& size_mm, const std::string& file, const ReadOptions& options,
                Scan& scan) {
  if (!options.spacing_mm.isZero()) return;
  constexpr double kLargest = 500;  // no bone is longer [mm]
  const Vec3& s = scan.spacing_mm;
  if (size_mm.maxCoeff() > kLargest) {
    scan.ask(Ask::spacing,
             fmt::format("{}: states a volume of {:.4g} x {:.4g} x {:.4g} mm, larger than any bone "
                         "(older files of FIVRS measure in units of their own; their comment may "
                         "say how many metres one is)",
                         file, size_mm.x(), size_mm.y(), size_mm.z()));
    return;
  }
  // as some converters write them: pictures whose rows and columns are exchanged
  const double nx = scan.size.x(), ny = scan.size.y(), sx = size_mm.x() / ny, sy = size_mm.y() / nx;
  constexpr double kUnequal = 1.05, kEqual = 1.005;
  const auto ratio = [](double a, double b) { return std::max(a, b) / std::min(a, b); };
  if (ratio(s.x(), s.y()) > kUnequal && ratio(sx, sy) < kEqual)
    scan.ask(Ask::spacing,
             fmt::format("{}: its pictures of {} x {} pixels do not fit its dimensions: the voxels "
                         "are {:.4g} x {:.4g} mm, but {:.4g} x {:.4g} mm if rows and columns are "
                         "exchanged",
                         file, scan.size.x(), scan.size.y(), s.x(), s.y(), sx, sy));
}

}  // namespace

Result<bool> describes_pictures(const fs::path& path) {
  const auto root = yaml_of(path);
  if (!root) return root.error();
  for (const std::string& name : volumes_of(*root))
    if (const Yaml* volume = map_at(*root, name.c_str()))
      if (map_at(*volume, "images") != nullptr) return true;
  return false;
}

Result<Scan> read_adf(const fs::path& path, const ReadOptions& options, Progress& progress) {
  const std::string file = short_name(path);
  auto adf = adf_of(path);
  if (!adf) return adf.error();
  const auto folder = pictures_folder(path, adf->path);
  if (!folder)
    return error(
        fmt::format("{}: images: path \"{}\" is no folder beside the file or beside its "
                    "folder; move the pictures there and correct the path",
                    file, base::printable(adf->path)));
  auto pictures = pictures_in(*folder, path, *adf);
  if (!pictures) return pictures.error();
  Scan scan;
  scan.format = kAdfFormat;
  check_count(*pictures, *adf, file, scan);
  if (pictures->empty())
    return error(fmt::format("{}: all pictures have numbers beyond the {} that it states", file,
                             adf->count));
  if (Status status = read_pictures(*pictures, file, scan, progress); !status)
    return status.error();
  const Vec3 size_mm = adf->size_mm * adf->scale;
  if (adf->scale != 1)
    scan.notices.push_back(fmt::format("The ADF's scale of {:.4g} is applied.", adf->scale));
  scan.spacing_mm = size_mm.cwiseQuotient(scan.size.cast<double>());
  doubt_size(size_mm, file, options, scan);
  scan.notices.emplace_back(
      "The ADF does not say how the patient lies: the columns of the pictures are taken to run to "
      "the left, the rows, from the last to the first, to the back, and the numbers upwards. Its "
      "location is not used: the middle of the volume is at 0.");
  Affine affine;
  affine.step = scan.spacing_mm.asDiagonal();
  affine.origin = -0.5 * (size_mm - scan.spacing_mm);
  if (Status status = place(scan, affine, options.spacing_mm, file, progress); !status)
    return status.error();
  return scan;
}

}  // namespace burr::io
