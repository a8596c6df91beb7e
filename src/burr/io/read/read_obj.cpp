// OBJ (Wavefront, Advanced Visualizer manual, appendix B1): points and faces; all else has no volume or
// is of looks alone, and files that it names are not opened.
#include <fmt/core.h>

#include <vector>

#include "burr/base/printable.h"
#include "burr/io/read/mesh_builder.h"
#include "burr/io/read/mesh_readers.h"
#include "burr/io/read/mesh_text.h"

namespace burr::io {
namespace {

class Obj {
 public:
  explicit Obj(std::string_view bytes) : text_(bytes) {}

  Result<TriangleMesh> read() {
    while (!text_.at_end()) {
      const std::string_view word = text_.word_of_line();
      if (word == "v") {
        if (!point()) return broken("a point needs three numbers");
      } else if (word == "f" || word == "fo") {  // fo: as older programs write it
        if (Status status = face(); !status) return status.error();
      } else if (word.find('\0') != std::string_view::npos) {
        return broken("it is not text");
      }
      while (!text_.word_of_line().empty()) continue;
      text_.rest_of_line();
    }
    if (points_.empty()) return no_mesh("obj", "it has no points");
    return mesh_.done();
  }

 private:
  bool point() {
    Place place{};
    for (float& x : place) {
      const auto number = number_in(text_.word_of_line());
      if (!number) return false;
      x = MeshBuilder::number(*number);
    }
    points_.push_back(place);
    return true;
  }

  // Corners are "7", "7/2", "7//3", "7/2/3": the first number is the point's, from 1; below 0 it
  // counts back from the last point so far.
  Status face() {
    corners_.clear();
    for (auto word = text_.word_of_line(); !word.empty(); word = text_.word_of_line()) {
      if (word.starts_with('#')) break;
      const auto number = whole_number_in(word.substr(0, word.find('/')));
      if (!number) return broken(fmt::format("\"{}\" is no corner", base::printable(word)));
      const auto count = static_cast<long long>(points_.size());
      const long long at = *number < 0 ? count + *number : *number - 1;
      if (*number == 0 || at < 0 || at >= count)
        return broken(fmt::format("a face names point {}, and {} are known there", *number, count));
      corners_.push_back(points_[static_cast<std::size_t>(at)]);
    }
    return mesh_.face(corners_);
  }

  [[nodiscard]] Error broken(std::string_view why) const {
    return no_mesh("obj", fmt::format("line {}: {}", text_.line(), why));
  }

  MeshText text_;
  MeshBuilder mesh_;
  std::vector<Place> points_, corners_;
};

}  // namespace

Result<TriangleMesh> read_obj(std::string_view bytes) { return Obj(bytes).read(); }

}  // namespace burr::io
