#include "commands/complete.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "burr/phantom/phantoms.h"
#include "burr/scenario/case.h"
#include "burr/scenario/rack.h"
#include "burr/scoring/rubric.h"
#include "burr/workshop/hand_device.h"

namespace burr::app {
namespace {

// The values that an option or a positional takes, by its name; several kinds may have one name.
struct Kind {
  std::string_view name;
  enum { cases, phantoms, rubrics, tools, devices, commands, files } what;
  std::string_view suffixes;  // of the files; "": any
};
constexpr std::array kKinds = std::to_array<Kind>({
    {"case", Kind::cases, ""},         {"case", Kind::files, "toml"},
    {"--case", Kind::cases, ""},       {"--case", Kind::files, "toml"},
    {"rubric", Kind::rubrics, ""},     {"rubric", Kind::files, "toml"},
    {"--rubric", Kind::rubrics, ""},   {"--rubric", Kind::files, "toml"},
    {"volume", Kind::cases, ""},       {"volume", Kind::phantoms, ""},
    {"volume", Kind::files, ""},       {"source", Kind::phantoms, ""},
    {"source", Kind::files, ""},       {"recording", Kind::files, "mcap"},
    {"a", Kind::files, "mcap"},        {"b", Kind::files, "mcap"},
    {"--beside", Kind::files, "mcap"}, {"--record", Kind::files, "mcap"},
    {"--tool", Kind::tools, ""},       {"--second-tool", Kind::tools, ""},
    {"--tools", Kind::files, "toml"},  {"--materials", Kind::files, "toml"},
    {"--path", Kind::files, "csv"},    {"--second-path", Kind::files, "csv"},
    {"--device", Kind::devices, ""},   {"--suction", Kind::devices, ""},
    {"command", Kind::commands, ""},
});

// The first of all names that an option has, as it is typed.
std::string typed(const CLI::Option& option) {
  if (!option.get_lnames().empty()) return "--" + option.get_lnames().front();
  if (!option.get_snames().empty()) return "-" + option.get_snames().front();
  return option.get_name(true);
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

const CLI::Option* option_of(const CLI::App& app, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  for (const CLI::Option* one : app.get_options())
    if (one->nonpositional() && one->check_name(name)) return one;
  return nullptr;
}

class Offer {
 public:
  explicit Offer(std::string begun) : begun_(std::move(begun)) {}
  void word(const std::string& word, const std::string& help = {}) {
    if (word.starts_with(begun_)) out_.push_back(help.empty() ? word : word + "\t" + help);
  }
  void files(std::string_view suffixes) {
    out_.push_back(suffixes.empty() ? ":files" : fmt::format(":files {}", suffixes));
  }
  std::vector<std::string> out() { return std::move(out_); }

 private:
  std::string begun_;
  std::vector<std::string> out_;
};

// before: what stands in front of the value in the same word, as "--view="
void offer_values(Offer& offer, const CLI::App& program, const CLI::App& app,
                  const CLI::Option& option, const std::string& before) {
  const auto each = [&](const auto& all) {
    for (const auto& one : all) offer.word(before + std::string(one));
  };
  // a closed set stands in the option's type as {a,b}
  const std::string type = option.get_type_name();
  if (const auto open = type.find('{'), close = type.find('}');
      open != std::string::npos && close != std::string::npos) {
    each(CLI::detail::split(type.substr(open + 1, close - open - 1), ','));
    return;
  }
  if (type.find("TEXT") == std::string::npos) return;  // a number
  const std::string name = option.nonpositional() ? typed(option) : option.get_name(true);
  bool known = false;
  for (const Kind& kind : kKinds) {
    if (kind.name != name) continue;
    known = true;
    switch (kind.what) {
      case Kind::cases:
        each(scenario::built_in_cases());
        break;
      case Kind::phantoms:
        for (const std::string_view one : phantom::phantom_names())
          offer.word(before + "phantom:" + std::string(one));
        break;
      case Kind::rubrics:
        each(scoring::built_in_rubrics());
        break;
      case Kind::tools:
        for (const scenario::RackTool& one : scenario::built_in_rack().all)
          offer.word(before + one.name, one.title.in("en"));
        break;
      case Kind::devices:
        for (const workshop::HandKind& one : workshop::hand_kinds())
          offer.word(before + one.name, one.makes);
        break;
      case Kind::commands:
        for (const CLI::App* one : program.get_subcommands({})) offer.word(one->get_name());
        break;
      case Kind::files:
        offer.files(kind.suffixes);
        break;
    }
  }
  if (!known && app.get_parent() != nullptr && app.get_parent()->get_name() == "devices") {
    for (const workshop::HandKind& one : workshop::hand_kinds()) offer.word(one.name, one.makes);
    return;
  }
  if (!known) offer.files("");
}

}  // namespace

std::vector<std::string> completions(const CLI::App& program, std::span<const std::string> words) {
  const CLI::App* app = &program;
  const CLI::Option* waits = nullptr;  // an option whose value comes next
  int left = 0;                        // values that it may still take
  std::size_t position = 0;            // of the next positional
  const std::string begun = words.empty() ? std::string() : words.back();
  for (std::size_t n = 0; n + 1 < words.size(); ++n) {
    const std::string& word = words[n];
    if (waits != nullptr && left > 0 && !word.starts_with("--")) {
      if (--left == 0) waits = nullptr;
      continue;
    }
    waits = nullptr;
    if (word.starts_with("-") && word.size() > 1) {
      const CLI::Option* option = option_of(*app, word);
      if (option != nullptr && takes_value(*option) && word.find('=') == std::string::npos) {
        waits = option;
        left = std::max(1, option->get_type_size());
      }
      continue;
    }
    const auto below = app->get_subcommands({});
    const auto found = std::find_if(below.begin(), below.end(),
                                    [&](const CLI::App* one) { return one->get_name() == word; });
    if (found != below.end()) {
      app = *found;
      position = 0;
    } else {
      ++position;
    }
  }
  Offer offer(begun);
  if (waits != nullptr) {
    offer_values(offer, program, *app, *waits, "");
    return offer.out();
  }
  if (begun.starts_with("-")) {
    if (const auto equals = begun.find('='); equals != std::string::npos) {
      const CLI::Option* option = option_of(*app, begun);
      if (option != nullptr && takes_value(*option))
        offer_values(offer, program, *app, *option, begun.substr(0, equals + 1));
      return offer.out();
    }
    for (const CLI::Option* one : app->get_options())
      if (one->nonpositional()) offer.word(typed(*one), one->get_description());
    return offer.out();
  }
  for (const CLI::App* one : app->get_subcommands({}))
    offer.word(one->get_name(), one->get_description());
  std::vector<const CLI::Option*> positionals;
  for (const CLI::Option* one : app->get_options())
    if (one->get_positional()) positionals.push_back(one);
  if (!positionals.empty()) {
    // the last one may take several words
    const CLI::Option& last = *positionals.back();
    if (position < positionals.size())
      offer_values(offer, program, *app, *positionals[position], "");
    else if (last.get_items_expected_max() > 1)
      offer_values(offer, program, *app, last, "");
  }
  return offer.out();
}

}  // namespace burr::app
