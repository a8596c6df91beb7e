// scenario/toml_reader.h - reads the tables of a case; a mistake is one sentence with file, line,
// field and remedy. For use of this room only.
//
//     std::optional<Error> wrong;
//     Reader reader(*table, "my.toml", "", wrong);
//     reader.only({"title"});
//     reader.text("title", out.title, true);
//     if (wrong) return *wrong;
//
// The first error is kept; nothing after it counts. Thread: one at a time.
#pragma once

#include <fmt/core.h>
#include <safe_toml.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "burr/base/given.h"
#include "burr/base/printable.h"
#include "burr/base/result.h"
#include "burr/math/vec3.h"

namespace burr::scenario {

// No list of a case is longer, so that a file which is no case cannot keep burr busy.
inline constexpr std::size_t kMostEntries = 1000;

class Reader {
 public:
  // place: of the table in the file, "burr."; empty: the whole file.
  Reader(const toml::table& table, std::string file, std::string place, std::optional<Error>& wrong)
      : table_(table), file_(std::move(file)), place_(std::move(place)), wrong_(wrong) {}

  [[nodiscard]] bool has(std::string_view key) const { return table_.get(key) != nullptr; }
  // of the table, from 1
  [[nodiscard]] std::uint32_t line() const { return line_of(table_); }
  [[nodiscard]] std::uint32_t line(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return node == nullptr ? line() : line_of(*node);
  }
  [[nodiscard]] const std::string& place() const { return place_; }

  void only(std::initializer_list<std::string_view> known) {
    only(std::span<const std::string_view>(known.begin(), known.size()));
  }
  void only(std::span<const std::string_view> known) {
    for (const auto& [key, node] : table_) {
      if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
      std::string list;
      for (const std::string_view name : known)
        list += (list.empty() ? "" : ", ") + std::string(name);
      fail(key.str(), "is not a known field; use " + list);
    }
  }

  void text(std::string_view key, std::string& out, bool needed = false) {
    const toml::node* node = find(key, needed, "a text");
    if (node == nullptr) return;
    const auto value = node->value_exact<std::string>();
    if (!value || value->empty()) return fail(key, "must be text in quotes");
    out = *value;
  }

  void flag(std::string_view key, bool& out) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    const auto value = node->value_exact<bool>();
    if (!value) return fail(key, "must be true or false");
    out = *value;
  }

  void number(std::string_view key, double& out, double above, double most, bool needed = false) {
    const toml::node* node = find(key, needed, "a number");
    if (node == nullptr) return;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (!value || !(*value > above) || !(*value <= most))
      return fail(key, fmt::format("must be a number above {:g} and at most {:g}", above, most));
    out = *value;
  }

  // A number of [least, most], in the words of the table of settings (tick/setting_table.h); a limit counts
  // as inside however it was rounded.
  void setting(std::string_view key, double& out, double least, double most,
               std::string_view unit) {
    constexpr double kRounded = 1e-9;
    const toml::node* node = find(key, true, "a number");
    if (node == nullptr) return;
    const auto value = node->is_number() ? node->value<double>() : std::nullopt;
    if (value && *value >= least - kRounded && *value <= most + kRounded) {
      out = *value;
      return;
    }
    const auto text = node->value<std::string>();
    fail(key, fmt::format("must be a number from {:g} to {:g} {}, not {}", least, most, unit,
                          value  ? fmt::format("{}", *value)
                          : text ? fmt::format("\"{}\"", base::printable(*text))
                                 : "this"));
  }

  // [least, most], 0 <= least < most or equal
  void range(std::string_view key, std::optional<std::pair<double, double>>& out) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    const std::vector<double> values = numbers_of(node);
    if (values.size() != 2 || !(values[0] >= 0) || !(values[1] >= values[0]))
      return fail(key, "must be the least and the most, [40, 200]");
    out = {values[0], values[1]};
  }

  // [first, second], in any order, each from 0 to 1000
  void pair(std::string_view key, std::optional<std::pair<double, double>>& out) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    const std::vector<double> values = numbers_of(node);
    const auto good = [](double value) { return value >= 0 && value <= 1000; };
    if (values.size() != 2 || !good(values[0]) || !good(values[1]))
      return fail(key, "must be two numbers from 0 to 1000, [0, 1]");
    out = {values[0], values[1]};
  }

  void vector(std::string_view key, std::optional<math::Vec3>& out) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    out = vector_of(*node);
    if (!out) fail(key, "must be three numbers, [x, y, z]");
  }
  // a list of them
  void vectors(std::string_view key, std::vector<math::Vec3>& out) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array != nullptr && too_long(key, *array, kMostEntries)) return;
    bool good = array != nullptr && !array->empty();
    for (std::size_t n = 0; good && n < array->size(); ++n) {
      const auto one = vector_of((*array)[n]);
      good = one.has_value();
      if (good) out.push_back(*one);
    }
    if (!good) fail(key, "must be a list of points, [[x, y, z], [x, y, z]]");
  }

  // a list of texts, none empty
  void texts(std::string_view key, std::vector<std::string>& out) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array != nullptr && too_long(key, *array, kMostEntries)) return;
    bool good = array != nullptr;
    for (std::size_t n = 0; good && n < array->size(); ++n) {
      const auto one = (*array)[n].value_exact<std::string>();
      good = one && !one->empty();
      if (good) out.push_back(*one);
    }
    if (!good) fail(key, "must be a list of texts, [\"a\", \"b\"]");
  }

  // the value of the word in the file, one of several
  template <class Value>
  void choice(std::string_view key, Value& out,
              std::initializer_list<std::pair<std::string_view, Value>> words,
              bool needed = false) {
    std::string word;
    text(key, word, needed);
    if (word.empty()) return;
    std::string list;
    for (const auto& [name, value] : words) {
      if (word == name) {
        out = value;
        return;
      }
      list += (list.empty() ? "" : ", ") + std::string(name);
    }
    fail(key, fmt::format("\"{}\" is not known; use one of {}", base::printable(word), list));
  }

  // reads the table [key], if it is there
  template <class Do>
  void table(std::string_view key, Do&& read) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    if (const toml::table* inner = node->as_table()) {
      Reader reader(*inner, file_, place_ + std::string(key) + ".", wrong_);
      read(reader);
    } else {
      fail(key, fmt::format("must be a table, [{}]", key));
    }
  }

  // reads every [[key]], or every { } of a list, of which there may be `most`
  template <class Do>
  void each(std::string_view key, Do&& read, std::size_t most = kMostEntries) {
    const toml::node* node = find(key, false, "");
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr) return fail(key, fmt::format("must be a list of tables, [[{}]]", key));
    if (too_long(key, *array, most)) return;
    std::size_t n = 0;
    for (const toml::node& entry : *array) {
      const toml::table* inner = entry.as_table();
      if (inner == nullptr) return fail(key, fmt::format("must be a list of tables, [[{}]]", key));
      Reader reader(*inner, file_, fmt::format("{}{}[{}].", place_, key, ++n), wrong_);
      read(reader);
    }
  }

  // calls read(key, text) for every entry of the table, which must be texts
  template <class Do>
  void each_text(Do&& read) {
    for (const auto& [key, node] : table_) {
      const auto value = node.template value_exact<std::string>();
      if (!value || value->empty())
        fail(key.str(), "must be text in quotes");
      else
        read(key.str(), *value);
    }
  }

  // calls read(key, number) for every entry of the table but these, which must be numbers
  template <class Do>
  void each_number(std::initializer_list<std::string_view> but, Do&& read) {
    for (const auto& [key, node] : table_) {
      if (std::find(but.begin(), but.end(), key.str()) != but.end()) continue;
      const auto value = node.is_number() ? node.template value<double>() : std::nullopt;
      if (!value || !std::isfinite(*value))
        fail(key.str(), "must be a number");
      else
        read(key.str(), *value);
    }
  }

  // calls read(key, value, line) for every entry of the table; line: of the entry in the file
  template <class Do>
  void each_given(Do&& read) {
    for (const auto& [key, node] : table_) {
      base::Given value;
      if (node.is_boolean())
        value = node.template value_or<bool>(false);
      else if (node.is_integer())
        value = node.template value_or<std::int64_t>(0);
      else if (node.is_floating_point())
        value = node.template value_or<double>(0);
      else if (node.is_string())
        value = node.template value_or<std::string>("");
      else
        fail(key.str(), "must be a number, true or false, or text in quotes");
      read(key.str(), std::move(value), line_of(node));
    }
  }

  [[nodiscard]] bool is_table(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return node != nullptr && node->is_table();
  }

  [[nodiscard]] bool is_text(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return node != nullptr && node->is_string();
  }

  [[nodiscard]] bool failed() const { return wrong_.has_value(); }

  void fail(std::string_view key, const std::string& what) {
    fail_at(line(key), place_ + base::printable(key), what);
  }
  void fail_at(std::uint32_t line, const std::string& field, const std::string& what) {
    if (!wrong_) wrong_ = burr::error(fmt::format("{}: line {}: {}: {}", file_, line, field, what));
  }

 private:
  bool too_long(std::string_view key, const toml::array& array, std::size_t most) {
    if (array.size() <= most) return false;
    fail(key, fmt::format("has {} entries; use at most {}", array.size(), most));
    return true;
  }
  static std::uint32_t line_of(const toml::node& node) {
    return std::max<std::uint32_t>(1, node.source().begin.line);
  }
  static std::vector<double> numbers_of(const toml::node* node) {
    std::vector<double> values;
    const toml::array* array = node->as_array();
    for (std::size_t n = 0; array != nullptr && n < array->size(); ++n) {
      const auto value = (*array)[n].is_number() ? (*array)[n].value<double>() : std::nullopt;
      if (!value || !std::isfinite(*value)) return {};
      values.push_back(*value);
    }
    return values;
  }
  static std::optional<math::Vec3> vector_of(const toml::node& node) {
    const std::vector<double> values = numbers_of(&node);
    if (values.size() != 3) return std::nullopt;
    const math::Vec3 v{values[0], values[1], values[2]};
    if (!(v.cwiseAbs().maxCoeff() < 1e4)) return std::nullopt;
    return v;
  }

  const toml::node* find(std::string_view key, bool needed, std::string_view what) {
    const toml::node* node = table_.get(key);
    if (node == nullptr && needed) fail(key, fmt::format("is missing; give {}", what));
    return node;
  }

  const toml::table& table_;
  std::string file_, place_;
  std::optional<Error>& wrong_;
};

}  // namespace burr::scenario
