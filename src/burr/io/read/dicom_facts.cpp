#include "burr/io/read/dicom_facts.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>
#include <utility>

#include "burr/base/printable.h"
#include "burr/io/read/letters.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

// The numbers of a DS element. A single comma in a number is a decimal comma: nothing else can be
// meant, because DS separates its numbers by backslashes.
struct Decimals {
  std::vector<double> values;  // empty: none stated, or one of them is no number
  bool comma = false, broken = false;
};

Decimals decimals_of(std::string_view text, std::size_t wanted_count) {
  Decimals out;
  std::string_view rest = trimmed(text);
  while (!rest.empty() && !out.broken) {
    const std::size_t end = std::min(rest.find('\\'), rest.size());
    std::string piece(trimmed(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (piece.empty()) continue;
    const auto commas = std::count(piece.begin(), piece.end(), ',');
    if (commas == 1 && piece.find('.') == std::string::npos) {
      std::replace(piece.begin(), piece.end(), ',', '.');
      out.comma = true;
    }
    double value = 0;
    if (to_number(piece, value)) {
      out.values.push_back(value);
      continue;
    }
    // some programs separate the numbers by blanks or commas
    const std::vector<double> several = numbers(piece);
    out.broken = several.size() != wanted_count || wanted_count < 2 || !out.values.empty();
    if (!out.broken) out.values = several;
  }
  out.broken =
      out.broken || (!out.values.empty() && out.values.size() < wanted_count) ||
      std::any_of(out.values.begin(), out.values.end(), [](double v) { return !std::isfinite(v); });
  if (out.broken) out.values.clear();
  return out;
}

int whole(const Values& values, Tag tag, int otherwise) {
  const std::vector<double> found = decimals_of(dicom_text(values, tag), 1).values;
  return !found.empty() && std::abs(found[0]) < 1e9 ? static_cast<int>(found[0]) : otherwise;
}

// Reads the facts of one frame, and notes in the header which of them are no numbers.
class Facts {
 public:
  Facts(DicomHeader& header, bool big_endian) : header_(header), big_endian_(big_endian) {}

  void of_frame(const Values& values, DicomFrame& frame) {
    const auto position = decimals(values, 0x00200032, 3, "Image Position (Patient)"),
               orientation = decimals(values, 0x00200037, 6, "Image Orientation (Patient)"),
               spacing = decimals(values, 0x00280030, 2, "Pixel Spacing"),
               thickness = decimals(values, 0x00180050, 1, "Slice Thickness"),
               between = decimals(values, 0x00180088, 1, "Spacing Between Slices"),
               location = decimals(values, 0x00201041, 1, "Slice Location"),
               slope = decimals(values, 0x00281053, 1, "Rescale Slope"),
               intercept = decimals(values, 0x00281052, 1, "Rescale Intercept");
    for (const Tag tag : {0x00182010U, 0x00181164U}) {
      const std::vector<double> gaps = decimals_of(dicom_text(values, tag), 2).values;
      if (gaps.size() == 2 && gaps[0] > 0 && gaps[1] > 0) frame.imager_gap_mm = {gaps[0], gaps[1]};
    }
    const std::vector<double> larger = decimals_of(dicom_text(values, 0x00181114), 1).values;
    if (!larger.empty() && larger[0] > 0) frame.magnification = larger[0];
    if (position.size() == 3) {
      frame.position_mm = {position[0], position[1], position[2]};
      frame.has_position = true;
    }
    if (orientation.size() == 6) {
      const math::Vec3 row(orientation[0], orientation[1], orientation[2]),
          column(orientation[3], orientation[4], orientation[5]);
      // not of unit length or not perpendicular: ignored
      if (std::abs(row.norm() - 1) < 0.01 && std::abs(column.norm() - 1) < 0.01 &&
          std::abs(row.dot(column)) < 0.01) {
        frame.row = row.normalized();
        frame.column = (column - frame.row * frame.row.dot(column)).normalized();
        frame.has_orientation = true;
      }
    }
    if (spacing.size() == 2 && spacing[0] > 0 && spacing[1] > 0) {
      frame.row_gap_mm = spacing[0];
      frame.column_gap_mm = spacing[1];
      frame.has_spacing = true;
    }
    if (!thickness.empty() && thickness[0] > 0) frame.thickness_mm = thickness[0];
    if (!between.empty() && header_.between_slices_mm == 0)
      header_.between_slices_mm = std::abs(between[0]);
    if (!location.empty()) {
      frame.location_mm = location[0];
      frame.has_location = true;
    }
    // a slope of 0 is meaningless, and then so is the intercept
    if (!slope.empty() && slope[0] != 0) {
      frame.slope = slope[0];
      if (!intercept.empty()) frame.intercept = intercept[0];
      frame.has_rescale = true;
    } else if (slope.empty() && !intercept.empty()) {
      frame.has_lone_intercept = true;
      frame.lone_intercept = intercept[0];
    }
    whole_bits(values, 0x0062000B, 2, frame.segment);
    of_phase(values, frame.phase);
  }

  // The energy of a monoenergetic picture: Monoenergetic Energy Equivalent, else what people wrote.
  void of_energy(const Values& spectral, const Values& top, DicomPhase& phase) const {
    for (const Tag tag : {0x0008103EU, 0x00082111U, 0x00204000U, 0x00080008U})
      if (const double kev = energy_in(dicom_text(top, tag)); kev > 0) phase.energy_kev = kev;
    real_bits(spectral, 0x0018937C, phase.energy_kev);
  }

  void of_segment(const Values& values, const std::string& letters, DicomSegment& segment) const {
    whole_bits(values, 0x00620004, 2, segment.number);
    segment.label = utf8_of_dicom(dicom_text(values, 0x00620005), letters);
    segment.code = dicom_text(values, 0x00080100);
    if (segment.code.empty()) segment.code = dicom_text(values, 0x00080119);  // a long one
    segment.scheme = dicom_text(values, 0x00080102);
    segment.meaning = utf8_of_dicom(dicom_text(values, 0x00080104), letters);
    const auto lab = values.find(0x0062000D);
    segment.has_colour = lab != values.end() && lab->second.size() == 6;
    for (std::size_t n = 0; n < 3 && segment.has_colour; ++n)
      segment.lab[n] = static_cast<int>(bits(lab->second, 2 * n, 2));
  }

 private:
  std::vector<double> decimals(const Values& values, Tag tag, std::size_t count, const char* name) {
    const auto found = values.find(tag);
    if (found == values.end()) return {};
    Decimals read = decimals_of(found->second, count);
    header_.decimal_commas = header_.decimal_commas || read.comma;
    if (read.broken) {
      std::string& where =
          tag == 0x00281052 || tag == 0x00281053 ? header_.bad_scale : header_.unreadable;
      if (where.empty())
        where = fmt::format("{} \"{}\"", name, base::printable(trimmed(found->second), 40));
    }
    return std::move(read.values);
  }
  // A number that is stored in binary form, of `width` bytes.
  [[nodiscard]] std::uint64_t bits(const std::string& value, std::size_t at,
                                   std::size_t width) const {
    std::uint64_t out = 0;
    for (std::size_t n = 0; n < width; ++n)
      out |= std::uint64_t{static_cast<std::uint8_t>(value[at + n])}
             << 8 * (big_endian_ ? width - 1 - n : n);
    return out;
  }
  void whole_bits(const Values& values, Tag tag, std::size_t width, int& out) const {
    const auto found = values.find(tag);
    if (found != values.end() && found->second.size() == width)
      out =
          static_cast<int>(static_cast<std::uint32_t>(bits(found->second, 0, width)) & 0x7FFFFFFF);
  }
  void real_bits(const Values& values, Tag tag, double& out) const {
    const auto found = values.find(tag);
    if (found == values.end()) return;
    double value = DicomPhase::kUnknown;
    if (found->second.size() == 4)
      value = std::bit_cast<float>(static_cast<std::uint32_t>(bits(found->second, 0, 4)));
    else if (found->second.size() == 8)
      value = std::bit_cast<double>(bits(found->second, 0, 8));
    if (std::isfinite(value)) out = value;
  }
  static void real_text(const Values& values, Tag tag, double& out) {
    const std::vector<double> read = decimals_of(dicom_text(values, tag), 1).values;
    if (!read.empty()) out = read[0];
  }
  // "hhmmss.ffffff", or the same after "yyyymmdd"; only differences of it mean anything.
  static void time(const Values& values, Tag tag, double& out) {
    const std::string text = dicom_text(values, tag);
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    double number = 0;
    if (digits < 6 || digits > 14 || !to_number(text.substr(0, digits), number)) return;
    double rest = 0;
    if (digits < text.size() && (text[digits] == '.' || text[digits] == ',')) {
      const std::size_t end =
          std::min(text.find_first_not_of("0123456789", digits + 1), text.size());
      if (!to_number("0." + text.substr(digits + 1, end - digits - 1), rest)) rest = 0;
    }
    const double day = std::floor(number / 1e6), clock = number - day * 1e6;
    const double hours = std::floor(clock / 1e4), minutes = std::floor((clock - hours * 1e4) / 1e2);
    out = day * 86400 + hours * 3600 + minutes * 60 + (clock - hours * 1e4 - minutes * 1e2) + rest;
  }

  void of_phase(const Values& values, DicomPhase& phase) const {
    phase.acquisition = whole(values, 0x00200012, phase.acquisition);
    whole_bits(values, 0x00209156, 2, phase.acquisition);
    phase.temporal = whole(values, 0x00200100, phase.temporal);
    whole_bits(values, 0x00209128, 4, phase.temporal);
    real_bits(values, 0x00209241, phase.cardiac_percent);
    real_text(values, 0x00181060, phase.trigger_ms);
    real_bits(values, 0x00209153, phase.trigger_ms);
    real_text(values, 0x00180060, phase.kvp);
    real_text(values, 0x00180081, phase.echo_ms);
    real_bits(values, 0x00189082, phase.echo_ms);
    real_bits(values, 0x0018937C, phase.energy_kev);
    for (const Tag tag : {0x00080033U, 0x00080032U, 0x00189074U}) time(values, tag, phase.time_s);
    const std::pair<Tag, std::string*> texts[] = {{0x00181210, &phase.kernel},
                                                  {0x00080008, &phase.type},
                                                  {0x00089007, &phase.type},
                                                  {0x00209056, &phase.stack}};
    for (const auto& [tag, out] : texts)
      if (values.count(tag) != 0) *out = dicom_text(values, tag);
    const auto index = values.find(0x00209157);
    constexpr std::size_t kMostIndices = 8;
    if (index != values.end() && index->second.size() % 4 == 0 &&
        index->second.size() <= 4 * kMostIndices) {
      phase.index.clear();
      for (std::size_t at = 0; at < index->second.size(); at += 4)
        phase.index.push_back(static_cast<std::uint32_t>(bits(index->second, at, 4)));
    }
  }

  DicomHeader& header_;
  bool big_endian_;
};

// Frames whose places along the stack stand in one list: of a secondary capture, or of a dose grid.
void places_of_frames(const Values& top, DicomHeader& header) {
  for (const Tag tag : {0x00182005U, 0x3004000CU}) {
    const auto found = top.find(tag);
    if (found == top.end()) continue;
    const std::vector<double> places = decimals_of(found->second, header.frames.size()).values;
    if (places.size() != header.frames.size()) continue;
    for (std::size_t f = 0; f < places.size(); ++f) {
      DicomFrame& frame = header.frames[f];
      frame.location_mm = places[f];
      frame.has_location = true;
      if (!frame.has_position || header.own_positions > 0) continue;
      frame.position_mm += frame.row.cross(frame.column) * (places[f] - places[0]);
    }
    if (header.frames.front().has_position) header.own_positions = header.frame_count;
    return;
  }
}

// What only a segmentation states.
void take_segments(const DicomWalker& set, const Facts& facts, DicomHeader& header) {
  header.segmentation_type = dicom_text(set.top, 0x00620001);
  const std::string letters = dicom_text(set.top, 0x00080005);
  for (const Values& values : set.segments)
    facts.of_segment(values, letters, header.segments.emplace_back());
  const auto other = [&](const Values& values) {
    const std::string own = dicom_text(values, 0x00200052);
    return !own.empty() && own != header.frame_of_reference;
  };
  header.other_frame_of_reference =
      other(set.shared) || std::any_of(set.frames.begin(), set.frames.end(), other);
}

// A date as people write it, "2019-03-07", of "20190307" or the "2019.03.07" of old files; empty: it
// is none.
std::string date_of(std::string text) {
  std::erase(text, '.');
  const bool digits = text.size() == 8 && std::all_of(text.begin(), text.end(),
                                                      [](char c) { return c >= '0' && c <= '9'; });
  if (!digits) return {};
  return text.substr(0, 4) + "-" + text.substr(4, 2) + "-" + text.substr(6, 2);
}

}  // namespace

double energy_in(std::string_view text) {
  constexpr double kLowest = 20, kHighest = 250;  // of pictures that scanners make [keV]
  const std::string small = lower(text);
  for (std::size_t at = small.find("kev"); at != std::string::npos;
       at = small.find("kev", at + 1)) {
    std::size_t end = at;
    while (end > 0 && (small[end - 1] == ' ' || small[end - 1] == '_')) --end;
    std::size_t from = end;
    while (from > 0 &&
           ((small[from - 1] >= '0' && small[from - 1] <= '9') || small[from - 1] == '.'))
      --from;
    double value = 0;
    if (to_number(small.substr(from, end - from), value) && value >= kLowest && value <= kHighest)
      return value;
  }
  return DicomPhase::kUnknown;
}

void take_dicom_facts(const DicomWalker& set, DicomHeader& header) {
  const Values& top = set.top;
  header.sop_class = dicom_text(top, 0x00080016);
  header.sop_instance = dicom_text(top, 0x00080018);
  header.study = dicom_text(top, 0x0020000D);
  header.study_date = date_of(dicom_text(top, 0x00080020));
  header.series = dicom_text(top, 0x0020000E);
  header.frame_of_reference = dicom_text(top, 0x00200052);
  header.modality = dicom_text(top, 0x00080060);
  header.image_type = dicom_text(top, 0x00080008);
  header.kernel = dicom_text(top, 0x00181210);
  header.description = dicom_text(top, 0x0008103E);
  header.photometric = dicom_text(top, 0x00280004);
  header.rescale_type = dicom_text(top, 0x00281054);
  header.inverted = header.photometric == "MONOCHROME1" || dicom_text(top, 0x20500020) == "INVERSE";
  header.images_in_acquisition = std::max(0, whole(top, 0x00201002, 0));
  header.instances_in_series = std::max(0, whole(top, 0x00201209, 0));
  header.described_frames = static_cast<int>(set.frames.size());
  header.concatenation = dicom_text(top, 0x00209161);
  for (const Values* inside : {&set.shared, set.frames.empty() ? nullptr : &set.frames.front()})
    if (inside != nullptr && header.kernel.empty()) header.kernel = dicom_text(*inside, 0x00181210);
  header.series_number = whole(top, 0x00200011, 0);
  header.acquisition = whole(top, 0x00200012, 0);
  header.instance = whole(top, 0x00200013, 0);
  header.has_modality_lut = set.modality_lut;
  const auto number = [&](Tag tag, int otherwise) {
    const auto found = top.find(tag);
    if (found == top.end() || found->second.size() < 2) return otherwise;
    const auto a = static_cast<std::uint8_t>(found->second[0]),
               b = static_cast<std::uint8_t>(found->second[1]);
    return set.big_endian ? a << 8 | b : b << 8 | a;
  };
  header.rows = number(0x00280010, 0);
  header.columns = number(0x00280011, 0);
  header.samples = number(0x00280002, 1);
  header.bits_allocated = number(0x00280100, 0);
  header.bits_stored = number(0x00280101, header.bits_allocated);
  header.high_bit = number(0x00280102, header.bits_stored - 1);
  header.is_signed = number(0x00280103, 0) == 1;
  header.frame_count = whole(top, 0x00280008, 1);
  header.part = number(0x00209162, 0);
  header.parts = number(0x00209163, 0);
  header.most_fractional = number(0x0062000E, 0);
  header.has_padding = top.count(0x00280120) != 0 && top.at(0x00280120).size() >= 2;
  if (header.has_padding) {
    const auto sign = [&](int v) {
      return header.is_signed ? int{static_cast<std::int16_t>(v)} : v;
    };
    header.padding = sign(number(0x00280120, 0));
    header.padding_end = header.padding;
    if (top.count(0x00280121) != 0) {
      header.padding_range = true;
      header.padding_end = sign(number(0x00280121, 0));
      if (header.padding_end < header.padding) std::swap(header.padding, header.padding_end);
    }
  }
  header.big_endian = set.big_endian || header.transfer_syntax == kGePrivate;
  header.has_pixels = set.has_pixels;
  header.float_pixels = set.float_pixels;
  header.encapsulated = set.encapsulated;
  header.pixels_at = set.pixels_at;
  header.pixels_length = set.pixels_length;

  if (header.frame_count < 1 || header.frame_count > 100000) {
    if (header.damage.empty())
      header.damage = fmt::format("it states {} frames, not 1 to 100000", header.frame_count);
    header.frame_count = 1;
  }
  Facts facts(header, set.big_endian);
  DicomFrame common;
  facts.of_frame(top, common);
  facts.of_energy(set.spectral, top, common.phase);
  facts.of_frame(set.shared, common);
  header.frames.assign(static_cast<std::size_t>(header.frame_count), common);
  for (std::size_t f = 0; f < std::min(header.frames.size(), set.frames.size()); ++f) {
    facts.of_frame(set.frames[f], header.frames[f]);
    if (set.frames[f].count(0x00200032) != 0) ++header.own_positions;
  }
  places_of_frames(top, header);
  take_segments(set, facts, header);
}

}  // namespace burr::io
