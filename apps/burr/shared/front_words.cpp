#include "shared/front_words.h"

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <set>

namespace burr::app {
namespace {

constexpr FrontWord kOptions[] = {
    {"accepted_labels", "--accept-label"},
    {"address", "--listen"},
    {"bone_number", "--bone"},
    {"home_allowed", "--home"},
    {"labels", "--tissues"},
    {"region", "--roi"},
    {"study", "--study-of"},
};

constexpr FrontWord kWays[] = {
    {"io::SegOptions::study", "--no-patient"},
    {"io::fence_state", "`burr check`"},
    {"lrs::tell_waiting", "`burr learner take-in`"},
    {"net::Guard::station_token", "--live"},
    {"record::repair", "`burr repair`"},
    {"school::Enrolled::kind", "--decides"},
    {"school::add", "`burr learner add --id`"},
    {"school::cohorts", "`burr learner cohort list`"},
    {"school::enrol", "`burr station enrol`"},
    {"school::enrolled", "`burr station list`"},
    {"school::forget", "`burr learner forget --overdue`"},
    {"school::learners", "`burr learner list`"},
    {"school::scrub", "`burr learner forget --scrub`"},
    {"school::set_home_page", "`burr learner xapi on`"},
    {"school::set_standard", "`burr study standard`"},
    {"school::standards", "`burr study standards --store S`"},
    {"workshop::names_there", "`burr devices`"},
};

std::set<std::string, std::less<>>& options() {
  static std::set<std::string, std::less<>> all;
  return all;
}

std::string_view word_in(std::span<const FrontWord> words, std::string_view name) {
  const auto found = std::find_if(words.begin(), words.end(),
                                  [name](const auto& one) { return one.name == name; });
  return found == words.end() ? std::string_view() : found->typed;
}

std::string typed_for(std::string_view name) {
  if (const auto way = word_in(kWays, name); !way.empty()) return std::string(way);
  if (const auto other = word_in(kOptions, name); options().contains(other))
    return std::string(other);
  std::string option = "--" + std::string(name);
  std::replace(option.begin(), option.end(), '_', '-');
  return options().contains(option) ? option : std::string();
}

}  // namespace

std::span<const FrontWord> other_options() { return kOptions; }
std::span<const FrontWord> other_ways() { return kWays; }

void speak_for(const CLI::App& command) {
  options().clear();
  for (const CLI::App* one = &command; one != nullptr; one = one->get_parent())
    for (const CLI::Option* option : one->get_options())
      for (const std::string& name : option->get_lnames()) options().insert("--" + name);
}

std::string with_names_said(std::string_view sentence,
                            const std::function<std::string(std::string_view)>& say) {
  std::string out;
  while (true) {
    const std::size_t open = sentence.find('`');
    const std::size_t close = open == std::string_view::npos ? open : sentence.find('`', open + 1);
    if (close == std::string_view::npos) return out.append(sentence);
    const std::string_view name = sentence.substr(open + 1, close - open - 1);
    const bool is_name = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == ':';
    });
    const std::string said = is_name ? say(name) : std::string();
    // a backtick in the name of a file must not hide what stands behind it
    const std::size_t done = is_name ? close + 1 : open + 1;
    out.append(sentence.substr(0, said.empty() ? done : open)).append(said);
    sentence.remove_prefix(done);
  }
}

std::string in_options(const std::string& sentence) { return with_names_said(sentence, typed_for); }

Error in_options(const Error& problem) { return error(problem.trouble, in_options(problem.text)); }

std::vector<std::string> in_options(const std::vector<std::string>& sentences) {
  std::vector<std::string> out;
  out.reserve(sentences.size());
  for (const std::string& one : sentences) out.push_back(in_options(one));
  return out;
}

void print_notices(const std::vector<std::string>& notices, std::FILE* to) {
  for (const std::string& one : notices) fmt::print(to, "{}\n", in_options(one));
}

}  // namespace burr::app
