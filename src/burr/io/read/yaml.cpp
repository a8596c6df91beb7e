#include "burr/io/read/yaml.h"

#include <fmt/core.h>
#include <yaml.h>

#include <memory>

#include "burr/base/printable.h"

namespace burr::io {
namespace {

constexpr int kDeepest = 32;
constexpr int kMostNodes = 100000;

class Parser {
 public:
  Parser(std::string_view text, std::string_view file) : file_(file) {
    if (text.empty()) text = "";  // libyaml stops the program at a null pointer
    ready_ = yaml_parser_initialize(&parser_) == 1;
    if (ready_)
      yaml_parser_set_input_string(&parser_, reinterpret_cast<const unsigned char*>(text.data()),
                                   text.size());
  }
  Parser(const Parser&) = delete;
  Parser& operator=(const Parser&) = delete;
  ~Parser() {
    drop();
    if (ready_) yaml_parser_delete(&parser_);
  }

  Result<Yaml> document() {
    if (!ready_) return error(Trouble::io, "there is not enough memory to read YAML");
    for (int n = 0; n < 3; ++n) {  // stream, document, then the first node
      if (Status status = next(); !status) return status.error();
      if (event_.type == YAML_STREAM_END_EVENT) break;
      if (event_.type != YAML_STREAM_START_EVENT && event_.type != YAML_DOCUMENT_START_EVENT)
        return node(0);
    }
    return error(fmt::format("{}: holds no YAML; check that this is the right file", file_));
  }

 private:
  void drop() {
    if (filled_) yaml_event_delete(&event_);
    filled_ = false;
  }
  Status next() {
    drop();
    if (yaml_parser_parse(&parser_, &event_) == 1) {
      filled_ = true;
      return fine();
    }
    return error(fmt::format(
        "{}: line {} is no valid YAML ({}); correct it", file_, parser_.problem_mark.line + 1,
        base::printable(parser_.problem != nullptr ? parser_.problem : "not enough memory")));
  }
  static std::string text_of(const yaml_event_t& event) {
    return {reinterpret_cast<const char*>(event.data.scalar.value), event.data.scalar.length};
  }

  // The node that the present event begins.
  Result<Yaml> node(int depth) {
    if (depth > kDeepest || ++nodes_ > kMostNodes)
      return error(fmt::format("{}: is nested too deeply or has too many entries", file_));
    Yaml out;
    switch (event_.type) {
      case YAML_SCALAR_EVENT:
        out.text = text_of(event_);
        return out;
      case YAML_ALIAS_EVENT:
        out.kind = Yaml::Kind::alias;
        out.text = reinterpret_cast<const char*>(event_.data.alias.anchor);
        return out;
      case YAML_SEQUENCE_START_EVENT:
      case YAML_MAPPING_START_EVENT:
        return children(event_.type == YAML_MAPPING_START_EVENT, depth);
      default:
        return error(fmt::format("{}: is no valid YAML; correct it", file_));
    }
  }

  Result<Yaml> children(bool map, int depth) {
    Yaml out;
    out.kind = map ? Yaml::Kind::map : Yaml::Kind::list;
    while (true) {
      if (Status status = next(); !status) return status.error();
      if (event_.type == YAML_SEQUENCE_END_EVENT || event_.type == YAML_MAPPING_END_EVENT)
        return out;
      std::string key;
      if (map) {
        auto name = node(depth + 1);
        if (!name) return name.error();
        if (name->kind == Yaml::Kind::text) key = std::move(name->text);
        if (Status status = next(); !status) return status.error();
      }
      auto value = node(depth + 1);
      if (!value) return value.error();
      if (map) out.keys.push_back(std::move(key));
      out.values.push_back(std::move(*value));
    }
  }

  std::string file_;
  yaml_parser_t parser_{};
  yaml_event_t event_{};
  bool ready_ = false, filled_ = false;
  int nodes_ = 0;
};

}  // namespace

const Yaml* Yaml::find(std::string_view key) const {
  if (kind != Kind::map) return nullptr;
  for (std::size_t n = 0; n < keys.size(); ++n)
    if (keys[n] == key) return &values[n];
  return nullptr;
}

Result<Yaml> parse_yaml(std::string_view text, std::string_view file) {
  return Parser(text, file).document();
}

}  // namespace burr::io
