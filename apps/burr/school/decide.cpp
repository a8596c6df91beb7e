#include "school/decide.h"

#include <fmt/core.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/places.h"
#include "burr/base/printable.h"
#include "burr/school/ratings.h"
#include "burr/school/sessions.h"
#include "shared/counted.h"
#include "shared/json_line.h"
#include "shared/key_file.h"

namespace burr::app {
namespace {

using Json = nlohmann::ordered_json;

std::string words_of(const school::Proposal& of, const school::Standard& standard) {
  std::string out =
      of.reached
          ? fmt::format("proposal: reached, in sessions {} and {} of {}", of.first + 1,
                        of.first + school::kInARow, of.sessions.size())
          : fmt::format("proposal: not reached in {}", counted(of.sessions.size(), "session"));
  out += fmt::format(
      " ({} sessions one after the other with {:.4g} points or more and no item of safety that is "
      "not met)",
      school::kInARow, standard.cut);
  if (static_cast<std::int64_t>(of.sessions.size()) < school::kNeeded)
    out += fmt::format("; {} of {} sessions without guidance: little can be said",
                       of.sessions.size(), school::kNeeded);
  return out;
}

Json json_of(const school::Decision& one) {
  return {{"id", one.id},
          {"learner", one.learner},
          {"standard", one.standard},
          {"outcome", one.outcome},
          {"confirmed_by", one.confirmed_by},
          {"reason", one.reason},
          {"sessions", one.sessions},
          {"made_ms", one.made_ms}};
}

}  // namespace

Status show_proposals(school::Store& store, const school::Decision& asked, bool json) {
  const auto known = school::has(store, asked.learner);
  if (!known) return known.error();
  if (!*known)
    return error(Trouble::usage, fmt::format("{}: there is no such learner; `burr learner list`",
                                             base::printable(asked.learner)));
  std::vector<school::Standard> all;
  if (asked.standard.empty()) {
    auto found = school::standards(store);
    if (!found) return found.error();
    all = std::move(*found);
  } else {
    auto found = school::standard_in(store, asked.standard);
    if (!found) return found.error();
    all.push_back(std::move(*found));
  }
  const auto made = school::decisions(store, asked.learner);
  if (!made) return made.error();
  Json out = {
      {"learner", asked.learner}, {"proposals", Json::array()}, {"decisions", Json::array()}};
  if (!json && all.empty())
    fmt::print("This centre has set no standard, so nothing is proposed.\n");
  for (const school::Standard& one : all) {
    const auto said = school::proposal(store, one, asked.learner);
    if (!said) return said.error();
    if (!json)
      fmt::print(
          "standard {}, {} of {}\n  {}\n  A person decides, with a key or a login: --outcome, "
          "--reason.\n",
          one.id, one.part, base::printable(one.rubric), words_of(*said, one));
    Json row = {{"standard", one.id},
                {"cut", one.cut},
                {"reached", said->reached},
                {"sessions", Json::array()}};
    for (const school::Proposal::Seen& seen : said->sessions)
      row["sessions"].push_back({{"session", seen.session},
                                 {"points", seen.points ? Json(*seen.points) : Json(nullptr)},
                                 {"gates_broken", seen.gates_broken},
                                 {"holds", seen.holds}});
    out["proposals"].push_back(std::move(row));
  }
  for (const school::Decision& one : *made) {
    out["decisions"].push_back(json_of(one));
    if (!json)
      fmt::print("decision {} under standard {}: {}, confirmed by {} on {}: {}\n", one.id,
                 one.standard, one.outcome, base::printable(one.confirmed_by),
                 counted(one.sessions.size(), "session"),
                 base::printable(one.reason, school::kLongestReason));
  }
  if (json) fmt::print("{}\n", json_line(out));
  return fine();
}

Status record_decision(school::Store& store, const school::Decision& decision, bool json) {
  const std::string file = key_file(users_places(), KeyOf::decider);
  std::error_code nobody_asks;
  std::optional<school::SigningKey> key;
  if (std::filesystem::exists(file, nobody_asks)) {
    auto read = school::SigningKey::read(file);
    if (!read) return read.error();
    key = std::move(*read);
  }
  const auto made = school::decide(store, decision, key ? &*key : nullptr);
  if (!made) return made.error();
  if (json)
    fmt::print("{}\n", json_line(json_of(*made)));
  else
    fmt::print("{}: {}, confirmed by {} under standard {}, on {}\n", made->learner, made->outcome,
               base::printable(made->confirmed_by), made->standard,
               counted(made->sessions.size(), "session"));
  return fine();
}

}  // namespace burr::app
