// io/read/mesh_text.h - words and numbers of a mesh's text, one after the other. For use of this room only.
//
// Numbers are read alike in every language setting. Thread: one.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "burr/base/result.h"

namespace burr::io {

// "this is no stl mesh (why)"
[[nodiscard]] Error no_mesh(std::string_view kind, std::string_view why);

class MeshText {
 public:
  explicit MeshText(std::string_view text) : text_(text) {}
  // The next word, on whatever line; empty: there is none.
  [[nodiscard]] std::string_view word();
  // The next word of this line; empty: the line ends. A line that ends in a backslash goes on.
  [[nodiscard]] std::string_view word_of_line();
  // What is left of this line, without its end; goes to the next.
  std::string_view rest_of_line();
  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  [[nodiscard]] std::size_t line() const { return line_; }  // from 1
  [[nodiscard]] std::size_t left() const { return text_.size() - at_; }
  [[nodiscard]] std::size_t at() const { return at_; }

 private:
  [[nodiscard]] std::string_view take_word();
  std::string_view text_;
  std::size_t at_ = 0, line_ = 1;
};

// Nothing: the word is no number. Too large a number is infinite.
[[nodiscard]] std::optional<double> number_in(std::string_view word);
[[nodiscard]] std::optional<long long> whole_number_in(std::string_view word);
// Letters of ASCII, whatever their case.
[[nodiscard]] bool same_word(std::string_view word, std::string_view lower);

}  // namespace burr::io
