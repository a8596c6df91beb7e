#include "burr/io/read/picture_stack.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <memory>
#include <optional>
#include <utility>

#include "burr/io/read/bytes.h"
#include "burr/io/read/geometry.h"
#include "burr/io/read/grey_picture.h"
#include "burr/io/read/picture_scale.h"
#include "burr/io/read/samples.h"
#include "burr/io/read/several_volumes.h"
#include "burr/io/read/stack_names.h"
#include "burr/io/read/tiff.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;
using math::Vec3;

// Takes pictures in the order of their slices; all must be like the first.
class Slices {
 public:
  Slices(std::string stack, const PictureScale& scale, std::int64_t count, Scan& scan)
      : stack_(std::move(stack)), scale_(scale), count_(count), scan_(scan) {}

  // picture: "slice_007.png", or "picture 7" of one file
  Status add(GreyPicture picture, const std::string& name) {
    if (!sink_) {
      if (Status status = begin(picture); !status) return status;
    } else if (picture.width != first_.width || picture.height != first_.height) {
      return error(
          fmt::format("{}: has {} x {} pixels, and the pictures before it {} x {}; give burr "
                      "pictures of one size",
                      name, picture.width, picture.height, first_.width, first_.height));
    } else if (picture.type != first_.type || picture.bits != first_.bits) {
      return error(
          fmt::format("{}: has {} bits a pixel{}, and the pictures before it {}{}; save them "
                      "all in one form",
                      name, picture.bits, kind_of(picture), first_.bits, kind_of(first_)));
    }
    if (picture.inverted) inverted_ = true;
    last_ = std::move(picture.samples);
    return add_last();
  }
  // The one before once more, in place of one that is missing.
  Status repeat() { return add_last(); }

  // Sets size and voxels of the scan.
  Status finish(bool check_values) {
    if (inverted_)
      scan_.notices.emplace_back(
          "The pictures call white 0 (WhiteIsZero): their values were turned round.");
    if (scale_.slope != 1 || scale_.intercept != 0)
      scan_.notices.push_back(fmt::format(
          "The values are {:g} x the stored numbers + {:g}, as the {} description states.",
          scale_.slope, scale_.intercept, scale_.by));
    scan_.size = {first_.width, first_.height, static_cast<int>(count_)};
    if (Status status = sink_->finish(scan_, false, check_values); !status)
      return error(fmt::format("{}: {}", stack_, status.error().text));
    return fine();
  }

 private:
  Status begin(const GreyPicture& picture) {
    const auto count = voxel_count(stack_, picture.width, picture.height, count_);
    if (!count) return count.error();
    first_ = {picture.width, picture.height, picture.bits, picture.type, {}, false};
    sink_.emplace(*count);
    return fine();
  }
  Status add_last() {
    NoProgress quiet;
    const SampleFormat format = {first_.type, std::endian::native == std::endian::big, scale_.slope,
                                 scale_.intercept};
    const auto source = memory_source(last_);
    return read_samples(*source, format, last_.size() / bytes_of(first_.type), *sink_, quiet);
  }
  static const char* kind_of(const GreyPicture& picture) {
    return picture.type == SampleType::f32 || picture.type == SampleType::f64 ? " (decimal numbers)"
           : picture.type == SampleType::i8 || picture.type == SampleType::i16 ||
                   picture.type == SampleType::i32
               ? " (signed)"
               : "";
  }

  std::string stack_;
  PictureScale scale_;
  std::int64_t count_;
  Scan& scan_;
  GreyPicture first_;
  std::vector<std::uint8_t> last_;
  std::optional<VoxelSink> sink_;
  bool inverted_ = false;
};

// Sets the place of the scan: what the pictures say of the size of a voxel, or 1 mm with a question.
Status put_in_place(const PictureScale& scale, const std::string& stack, const ReadOptions& options,
                    Scan& scan, Progress& progress) {
  const Vec3& mm = scale.voxel_mm;
  Affine affine;
  if (mm.minCoeff() > 0) {
    affine.step = mm.asDiagonal();
    scan.notices.push_back(fmt::format(
        "The size of a voxel, {:.4g} x {:.4g} x {:.4g} mm, is that of the {} description "
        "in the file.",
        mm.x(), mm.y(), mm.z(), scale.by));
  } else if (mm.x() > 0) {
    affine.step = Vec3(mm.x(), mm.y(), 1).asDiagonal();
    scan.ask(Ask::spacing,
             fmt::format("{}: states pixels of {:.4g} x {:.4g} mm and no distance of its pictures "
                         "(taken for 1 mm)",
                         stack, mm.x(), mm.y()));
  } else {
    scan.ask(
        Ask::spacing,
        fmt::format("{}: its pictures do not state the size of a voxel (taken for 1 mm)", stack));
  }
  if (Status status = place(scan, affine, options.spacing_mm, stack, progress); !status)
    return status;
  scan.notices.emplace_back(
      "Pictures do not state how the patient lies: columns to the left, rows to the back and later "
      "pictures upwards are assumed. If the first picture is the uppermost, the bone is a mirror "
      "image; compare it with the patient.");
  return fine();
}

Result<GreyPicture> read_one(const fs::path& path) {
  const auto head = first_bytes(path, 32, false);
  if (!head) return head.error();
  switch (picture_kind(*head)) {
    case PictureKind::png:
      return read_grey_png(path);
    case PictureKind::bmp:
      return read_grey_bmp(path);
    case PictureKind::tiff:
      break;
    case PictureKind::none:
      return error(
          fmt::format("{}: is no picture that burr reads; copy it again", short_name(path)));
  }
  auto tiff = TiffFile::open(path);
  if (!tiff) return tiff.error();
  if ((*tiff)->pages() != 1)
    return error(
        fmt::format("{}: holds {} pictures, and the folder several such files; give burr one "
                    "of them",
                    short_name(path), (*tiff)->pages()));
  return (*tiff)->read(0);
}

// The pages of one TIFF file.
Result<Scan> read_pages(TiffFile& tiff, const std::string& file, const ReadOptions& options,
                        Progress& progress) {
  Scan scan;
  scan.format = "TIFF pictures";
  PictureScale scale = picture_scale(tiff.words());
  const auto pages = static_cast<std::int64_t>(tiff.pages());
  if (scale.volumes() > 1 && scale.volumes() * scale.slices != pages)
    return error(
        fmt::format("{}: its {} description states {} channels, {} slices and {} times, but "
                    "the file holds {} pictures; save it again",
                    file, scale.by, scale.channels, scale.slices, scale.times, pages));
  if (scale.volumes() == 1) {
    if (scale.slices > pages && !scale.by.empty())
      scan.ask(Ask::absent,
               fmt::format("{}: its {} description counts {} pictures, and {} are there", file,
                           scale.by, scale.slices, pages));
    scale.slices = pages;
  }
  if (scale.slices < 2)
    return error(
        fmt::format("{}: is one picture, and a volume is a stack of them; give the folder "
                    "that holds them",
                    file));
  const auto volume = take_volume(static_cast<std::uint64_t>(scale.volumes()), options, file, scan);
  if (!volume) return volume.error();
  Slices slices(file, scale, scale.slices, scan);
  for (std::int64_t k = 0; k < scale.slices; ++k) {
    const std::int64_t page = scale.page_of(static_cast<std::int64_t>(*volume), k);
    auto picture = tiff.read(static_cast<std::size_t>(page));
    if (!picture) return picture.error();
    if (Status status =
            slices.add(std::move(*picture), fmt::format("{}: picture {}", file, page + 1));
        !status)
      return status.error();
    progress.report(static_cast<double>(k + 1) / static_cast<double>(scale.slices),
                    "reading pictures");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  if (Status status = slices.finish(options.check_values); !status) return status.error();
  if (Status status = put_in_place(scale, file, options, scan, progress); !status)
    return status.error();
  return scan;
}

void say_names(const StackNames& names, const std::string& folder, Scan& scan) {
  if (names.left_out > 0)
    scan.notices.push_back(fmt::format("{} other {} in the folder {} left out.", names.left_out,
                                       names.left_out == 1 ? "picture" : "pictures",
                                       names.left_out == 1 ? "was" : "were"));
  const std::vector<std::int64_t> missing = names.missing();
  if (missing.empty()) return;
  constexpr std::size_t kNamed = 6;
  std::string list;
  for (std::size_t n = 0; n < std::min(missing.size(), kNamed); ++n)
    list += fmt::format("{}{}", n > 0 ? ", " : "", missing[n]);
  scan.ask(
      Ask::missing,
      fmt::format("{}: pictures are missing between others (numbers {}{}); each is taken to be "
                  "like the one before it",
                  folder, list, missing.size() > kNamed ? " ..." : ""));
}

}  // namespace

std::vector<fs::path> pictures_among(const std::vector<fs::path>& files) {
  std::vector<fs::path> out;
  for (const fs::path& path : files) {
    const auto head = first_bytes(path, 32);
    if (head && picture_kind(*head) != PictureKind::none) out.push_back(path);
  }
  return out;
}

Result<Scan> read_picture(const fs::path& path, const ReadOptions& options, Progress& progress) {
  const std::string file = short_name(path);
  const auto head = first_bytes(path, 32);
  if (!head) return head.error();
  if (picture_kind(*head) != PictureKind::tiff)
    return error(
        fmt::format("{}: is one picture, and a volume is a stack of them; give the folder "
                    "that holds them",
                    file));
  auto tiff = TiffFile::open(path);
  if (!tiff) return tiff.error();
  return read_pages(**tiff, file, options, progress);
}

Result<Scan> read_picture_stack(const std::vector<fs::path>& files, const std::string& folder,
                                const ReadOptions& options, Progress& progress) {
  const auto names = stack_names(files, folder);
  if (!names) return names.error();
  if (names->files.size() == 1) return read_picture(names->files.front(), options, progress);
  Scan scan;
  say_names(*names, folder, scan);
  PictureScale scale;
  const auto head = first_bytes(names->files.front(), 32, false);
  if (!head) return head.error();
  const PictureKind kind = picture_kind(*head);
  scan.format = fmt::format("{} pictures", name_of(kind));
  if (kind == PictureKind::tiff) {
    const auto tiff = TiffFile::open(names->files.front());
    if (!tiff) return tiff.error();
    scale = picture_scale((*tiff)->words());
  }
  const auto only = take_volume(1, options, folder, scan);
  if (!only) return only.error();
  const std::int64_t first = names->numbers.front(),
                     count = (names->numbers.back() - first) / names->step + 1;
  Slices slices(folder, scale, count, scan);
  std::int64_t next = first;
  for (std::size_t n = 0; n < names->files.size(); ++n) {
    for (; next < names->numbers[n]; next += names->step)
      if (Status status = slices.repeat(); !status) return status.error();
    next += names->step;
    auto picture = read_one(names->files[n]);
    if (!picture) return picture.error();
    if (Status status = slices.add(std::move(*picture), short_name(names->files[n])); !status)
      return status.error();
    progress.report(static_cast<double>(n + 1) / static_cast<double>(names->files.size()),
                    "reading pictures");
    if (progress.cancelled()) return error(Trouble::interrupted, "reading was stopped");
  }
  if (Status status = slices.finish(options.check_values); !status) return status.error();
  if (Status status = put_in_place(scale, folder, options, scan, progress); !status)
    return status.error();
  return scan;
}

}  // namespace burr::io
