// PLY (Stanford): elements with properties, as text or as bytes in either order. Only the points (`vertex`:
// x, y, z) and the faces (`face`: a list vertex_indices) are kept; every count is compared with what the
// file still holds before anything is set aside for it.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include "burr/base/printable.h"
#include "burr/io/read/mesh_builder.h"
#include "burr/io/read/mesh_readers.h"
#include "burr/io/read/mesh_text.h"
#include "burr/io/read/ply_header.h"

namespace burr::io {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
double value_of(const char* bytes) {
  T value{};
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double value_of(PlyType type, const char* bytes) {
  switch (type) {
    case PlyType::int8:
      return value_of<std::int8_t>(bytes);
    case PlyType::uint8:
      return value_of<std::uint8_t>(bytes);
    case PlyType::int16:
      return value_of<std::int16_t>(bytes);
    case PlyType::uint16:
      return value_of<std::uint16_t>(bytes);
    case PlyType::int32:
      return value_of<std::int32_t>(bytes);
    case PlyType::uint32:
      return value_of<std::uint32_t>(bytes);
    case PlyType::float32:
      return value_of<float>(bytes);
    case PlyType::float64:
      break;
  }
  return value_of<double>(bytes);
}

// The numbers after the head, one after the other.
class PlyNumbers {
 public:
  PlyNumbers(std::string_view bytes, const MeshText& head, PlyHeader::Form form)
      : form_(form), bytes_(bytes.substr(head.at())), text_(bytes_) {}

  [[nodiscard]] std::optional<double> next(PlyType type) {
    if (form_ == PlyHeader::Form::text) return number_in(text_.word());
    const std::size_t size = bytes_of(type);
    if (bytes_.size() - at_ < size) return std::nullopt;
    std::array<char, 8> value{};
    std::memcpy(value.data(), bytes_.data() + at_, size);
    at_ += size;
    if (form_ == PlyHeader::Form::big)
      std::reverse(value.begin(), value.begin() + static_cast<std::ptrdiff_t>(size));
    return value_of(type, value.data());
  }
  // No more than so many can follow: in text a number takes at least a digit and, but for the last, a blank.
  [[nodiscard]] std::uint64_t most(PlyType type) const {
    return form_ == PlyHeader::Form::text ? (text_.left() + 1) / 2
                                          : (bytes_.size() - at_) / bytes_of(type);
  }

 private:
  PlyHeader::Form form_;
  std::string_view bytes_;
  MeshText text_;
  std::size_t at_ = 0;
};

class Ply {
 public:
  explicit Ply(std::string_view bytes) : bytes_(bytes) {}

  Result<TriangleMesh> read() {
    MeshText text(bytes_);
    const auto head = ply_header(text);
    if (!head) return head.error();
    PlyNumbers numbers(bytes_, text, head->form);
    for (const PlyElement& element : head->elements)
      if (Status status = read(element, numbers); !status) return status.error();
    return mesh();
  }

 private:
  static Error broken(const PlyElement& element, std::uint64_t n, std::string_view why) {
    return no_mesh("ply", fmt::format("{} {}: {}", base::printable(element.name), n + 1, why));
  }

  Status read(const PlyElement& element, PlyNumbers& numbers) {
    if (element.properties.empty()) return fine();  // has no numbers
    const PlyProperty& first = element.properties.front();
    if (element.count > numbers.most(first.count.value_or(first.type)))
      return no_mesh("ply", fmt::format("it says {} of {} and is too short for them; copy it again",
                                        element.count, base::printable(element.name)));
    const auto x = element.find("x"), y = element.find("y"), z = element.find("z");
    const bool points = element.name == "vertex" && x && y && z && points_.empty();
    auto list = element.find("vertex_indices");
    if (!list) list = element.find("vertex_index");
    const bool faces = element.name == "face" && list && element.properties[*list].count;
    std::vector<double> row(element.properties.size());
    for (std::uint64_t n = 0; n < element.count; ++n) {
      for (std::size_t p = 0; p < row.size(); ++p) {
        const PlyProperty& property = element.properties[p];
        const bool wanted = faces && p == *list;
        const char* wrong = nullptr;
        if (property.count) {
          wrong = read_list(property, wanted, numbers);
        } else {
          const auto number = numbers.next(property.type);
          if (!number) wrong = kShort;
          row[p] = number.value_or(0);
        }
        if (wrong != nullptr) return broken(element, n, wrong);
      }
      if (points)
        points_.push_back({MeshBuilder::number(row[*x]), MeshBuilder::number(row[*y]),
                           MeshBuilder::number(row[*z])});
    }
    return fine();
  }

  static constexpr const char* kShort = "a number is missing; copy the file again";

  // nullptr, or what is wrong.
  const char* read_list(const PlyProperty& property, bool wanted, PlyNumbers& numbers) {
    const auto count = numbers.next(*property.count);
    if (!count) return kShort;
    if (!(*count >= 0) || *count != std::floor(*count)) return "the length of a list is no count";
    if (*count > static_cast<double>(numbers.most(property.type)))
      return "a list is longer than the file; copy it again";
    const auto size = static_cast<std::size_t>(*count);
    if (wanted) sizes_.push_back(size);
    for (std::size_t n = 0; n < size; ++n) {
      const auto number = numbers.next(property.type);
      if (!number) return kShort;
      if (!wanted) continue;
      if (!(*number >= 0) || *number != std::floor(*number) || *number > 4294967295.0)
        return "it names a point that cannot be";
      corners_.push_back(static_cast<std::uint32_t>(*number));
    }
    return nullptr;
  }

  // Points may follow the faces.
  Result<TriangleMesh> mesh() {
    if (points_.empty()) return no_mesh("ply", "it has no points");
    MeshBuilder out;
    std::vector<Place> face;
    std::size_t at = 0;
    for (std::size_t n = 0; n < sizes_.size(); ++n) {
      face.clear();
      for (std::size_t c = 0; c < sizes_[n]; ++c, ++at) {
        if (corners_[at] >= points_.size())
          return no_mesh("ply", fmt::format("face {} names point {}, and there are {}", n + 1,
                                            corners_[at], points_.size()));
        face.push_back(points_[corners_[at]]);
      }
      if (Status status = out.face(face); !status) return status.error();
    }
    return out.done();
  }

  std::string_view bytes_;
  std::vector<Place> points_;
  std::vector<std::size_t> sizes_;      // corners of each face
  std::vector<std::uint32_t> corners_;  // of all, one after the other
};

}  // namespace

Result<TriangleMesh> read_ply(std::string_view bytes) { return Ply(bytes).read(); }

}  // namespace burr::io
