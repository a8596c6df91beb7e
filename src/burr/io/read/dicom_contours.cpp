// Structure Set, ROI Contour and RT ROI Observations modules as in PS3.3 C.8.8.5, C.8.8.6 and C.8.8.8.
#include "burr/io/read/dicom_contours.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/dicom_elements.h"
#include "burr/io/read/label_lists.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

constexpr const char* kStructureSet = "1.2.840.10008.5.1.4.1.1.481.3";
constexpr Tag kReferencedSeries = 0x30060014, kStructures = 0x30060020, kContoursOf = 0x30060039,
              kContour = 0x30060040, kObservation = 0x30060080, kCode = 0x30060086;
constexpr Tag kNumber = 0x30060022, kFrame = 0x30060024, kName = 0x30060026, kColour = 0x3006002A,
              kType = 0x30060042, kSlab = 0x30060044, kData = 0x30060050, kOfNumber = 0x30060084,
              kInterpreted = 0x300600A4, kSeries = 0x0020000E;

int whole(const Values& values, Tag tag) {
  std::int64_t out = 0;
  return to_number(dicom_text(values, tag), out) && std::abs(out) < 1'000'000'000
             ? static_cast<int>(out)
             : -1;
}

// Numbers between backslashes, which are all numbers. A comma is a decimal comma.
std::optional<std::vector<double>> decimals(std::string_view text) {
  std::vector<double> out;
  text = trimmed(text);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\\'), text.size());
    std::string piece(trimmed(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
    std::replace(piece.begin(), piece.end(), ',', '.');
    double value = 0;
    if (!to_number(piece, value) || !std::isfinite(value)) return std::nullopt;
    out.push_back(value);
  }
  return out;
}

// What the type of a structure says that it is, in words of the table of tissues; of an organ its name says more.
std::string meaning_of_type(const std::string& type) {
  if (type == "EXTERNAL") return "Skin";
  for (const char* tumour : {"GTV", "CTV", "PTV"})
    if (type == tumour) return fmt::format("Tumour volume ({})", type);
  return {};
}

class Taker {
 public:
  explicit Taker(const DicomWalker& set, std::string file) : set_(set), file_(std::move(file)) {}

  Result<ContourSet> take() {
    structures();
    if (Status status = contours(); !status) return status.error();
    observations();
    return std::move(out_);
  }

 private:
  const DicomItem& parent(const DicomItem& of) const {
    return set_.structure_items[static_cast<std::size_t>(of.parent)];
  }
  ContouredStructure* structure(int number) {
    const auto found = place_.find(number);
    return found == place_.end() ? nullptr : &out_.structures[found->second];
  }

  void structures() {
    const std::string letters = dicom_text(set_.top, 0x00080005);
    for (const DicomItem& one : set_.structure_items) {
      if (one.sequence == kReferencedSeries)
        if (const std::string uid = dicom_text(one.values, kSeries); !uid.empty())
          out_.series.push_back(uid);
      if (one.sequence != kStructures) continue;
      ContouredStructure made;
      made.number = whole(one.values, kNumber);
      made.label.colour = volume::Tissue{}.colour;
      made.label.name = utf8_of_dicom(dicom_text(one.values, kName), letters);
      if (made.label.name.empty()) made.label.name = fmt::format("structure {}", made.number);
      made.frame_of_reference = dicom_text(one.values, kFrame);
      if (place_.try_emplace(made.number, out_.structures.size()).second)
        out_.structures.push_back(std::move(made));
    }
  }

  Status contours() {
    for (const DicomItem& one : set_.structure_items) {
      if (one.sequence == kContoursOf) {
        const int number = whole(one.values, kOfNumber);
        if (structure(number) == nullptr) {  // without a description
          ContouredStructure made;
          made.number = number;
          made.label = {.value = 0,
                        .name = fmt::format("structure {}", number),
                        .colour = volume::Tissue{}.colour};
          place_[number] = out_.structures.size();
          out_.structures.push_back(std::move(made));
        }
        const auto colour = decimals(dicom_text(one.values, kColour));
        if (colour && colour->size() == 3)
          for (std::size_t c = 0; c < 3; ++c)
            structure(number)->label.colour[c] =
                static_cast<float>(std::clamp((*colour)[c] / 255.0, 0.0, 1.0));
      }
      if (one.sequence != kContour || one.parent < 0 || parent(one).sequence != kContoursOf)
        continue;
      ContouredStructure& of = *structure(whole(parent(one).values, kOfNumber));
      const auto numbers = decimals(dicom_text(one.values, kData));
      if (!numbers || numbers->size() % 3 != 0)
        return error(fmt::format(
            "{}: a contour of {} is damaged: its Contour Data {}; export the contours again", file_,
            base::printable(of.label.name),
            numbers ? fmt::format("has {} numbers, which are no points", numbers->size())
                    : std::string("holds something that is no number")));
      Contour made;
      made.type = dicom_text(one.values, kType);
      const auto slab = decimals(dicom_text(one.values, kSlab));
      if (slab && slab->size() == 1) made.slab_mm = std::abs(slab->front());
      for (std::size_t n = 0; n + 2 < numbers->size(); n += 3)
        made.points.emplace_back((*numbers)[n], (*numbers)[n + 1], (*numbers)[n + 2]);
      of.contours.push_back(std::move(made));
    }
    return fine();
  }

  void observations() {
    const std::string letters = dicom_text(set_.top, 0x00080005);
    for (const DicomItem& one : set_.structure_items) {
      if (one.sequence == kObservation)
        if (ContouredStructure* of = structure(whole(one.values, kOfNumber));
            of != nullptr && of->label.meaning.empty())
          of->label.meaning = meaning_of_type(dicom_text(one.values, kInterpreted));
      if (one.sequence != kCode || one.parent < 0) continue;
      ContouredStructure* of = structure(whole(parent(one).values, kOfNumber));
      const std::string meaning =
          meaning_of_code(dicom_text(one.values, 0x00080102), dicom_text(one.values, 0x00080100),
                          utf8_of_dicom(dicom_text(one.values, 0x00080104), letters));
      if (of != nullptr && !meaning.empty()) of->label.meaning = meaning;
    }
  }

  const DicomWalker& set_;
  std::string file_;
  ContourSet out_;
  std::map<int, std::size_t> place_;
};

}  // namespace

bool is_contour_set(const DicomHeader& header) {
  return !header.has_pixels && (header.sop_class == kStructureSet || header.modality == "RTSTRUCT");
}

Result<ContourSet> read_contours(const DicomHeader& header) {
  const std::string file = short_name(header.path);
  ContourSet out;
  std::optional<Error> trouble;
  const Status walked = look_at_structures(header.path, [&](const DicomWalker& set) {
    auto taken = Taker(set, file).take();
    if (taken)
      out = std::move(*taken);
    else
      trouble = taken.error();
  });
  if (!walked) return walked.error();
  if (trouble) return *trouble;
  return out;
}

}  // namespace burr::io
