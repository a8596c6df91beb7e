#include "window/review/enter_session.h"

#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <vector>

#include "burr/school/pending.h"
#include "burr/school/store.h"
#include "shared/front_words.h"
#include "shared/helper_process.h"
#include "shared/key_file.h"
#include "shared/word_names.h"
#include "window/review/review.h"

namespace burr::app {
namespace {

void tell(Desk& desk, const std::string& line) {
  desk.news = line;
  fmt::print(stderr, "{}\n", line);  // the window may close before anybody reads it there
}

// none: this session does not go into a store
std::optional<school::StorePlace> place_for(Desk& desk, const record::Identity& identity,
                                            const scenario::Case* work) {
  if (identity.learner.empty() || work == nullptr || !has_marks(*work)) return std::nullopt;
  const auto place = school::place_of(desk.store, desk.places());
  if (!place || !school::is_wanted(desk.store, *place)) return std::nullopt;
  return *place;
}

school::WaitingRecording waiting_of(const std::string& recording, const record::Identity& identity,
                                    const scenario::Case& work) {
  std::error_code nobody_asks;
  return {std::filesystem::absolute(recording, nobody_asks).string(), identity.learner,
          rubric_for(work)};
}

void take_in(Desk& desk, const school::StorePlace& place) {
  std::vector<std::string> words = {burr_itself(), "--quiet", "learner", "take-in"};
  if (!desk.store
           .empty()) {  // otherwise it finds the same store by itself, and no password is on the command line
    words.emplace_back("--store");
    words.push_back(place.address);
  }
  auto child = std::make_shared<HelperProcess>(words);
  if (!child->began()) return tell(desk, say(Word::school_waits, burr_itself()));
  child->let_go();  // it goes on when the window is closed
  desk.under_way.emplace_back([&desk, child] {
    if (!child->ended()) return false;
    if (!child->fine())
      tell(desk, say(Word::school_waits, child->complaint("burr learner take-in")));
    else if (const std::string line = child->last_line(); !line.empty())
      tell(desk, in_options(line));
    return true;
  });
}

}  // namespace

std::shared_ptr<school::StationSealer> sealer_for(Desk& desk, const record::Identity& identity,
                                                  const scenario::Case* work) {
  const auto place = place_for(desk, identity, work);
  const std::string file = key_file(desk.places(), KeyOf::station);
  std::error_code nobody_asks;
  if (!place || file.empty() || !std::filesystem::exists(file, nobody_asks)) return nullptr;
  auto key = school::SigningKey::read(file);
  if (key) return std::make_shared<school::StationSealer>(*place, std::move(*key));
  tell(desk, in_options(key.error()).text);
  return nullptr;
}

void tell_of_seal(Desk& desk, const std::shared_ptr<school::StationSealer>& sealer) {
  if (sealer == nullptr) return;
  for (const std::string& line : sealer->said()) tell(desk, in_options(line));
}

void session_begins(Desk& desk, const std::string& recording, const record::Identity& identity,
                    const scenario::Case* work) {
  const auto place = place_for(desk, identity, work);
  if (!place) return;
  const school::WaitingRecording waits = waiting_of(recording, identity, *work);
  if (const Status kept = school::keep(*place, waits); !kept)
    tell(desk, say(Word::school_not_entered, waits.file, in_options(kept.error()).text));
}

void session_ended(Desk& desk, const std::string& recording, const record::Identity& identity,
                   const scenario::Case* work, bool kept) {
  const auto place = place_for(desk, identity, work);
  if (!place) return;
  const school::WaitingRecording waits = waiting_of(recording, identity, *work);
  if (!kept) return school::drop(*place, waits);
  // once more: another burr may have tried it meanwhile
  if (const Status again = school::keep(*place, waits); !again)
    return tell(desk, say(Word::school_not_entered, waits.file, in_options(again.error()).text));
  take_in(desk, *place);
}

void enter_waiting(Desk& desk) {
  const auto place = school::place_of(desk.store, desk.places());
  if (!place || !school::is_wanted(desk.store, *place)) return;
  std::vector<std::string> notices;
  if (!school::waiting(*place, notices).empty()) take_in(desk, *place);
  for (const std::string& line : notices) tell(desk, in_options(line));
}

}  // namespace burr::app
