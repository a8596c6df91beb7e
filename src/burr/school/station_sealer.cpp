#include "burr/school/station_sealer.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "burr/school/enrolled.h"

namespace burr::school {

StationSealer::StationSealer(StorePlace place, SigningKey key)
    : place_(std::move(place)), key_(std::move(key)) {
  place_.waits = {.lock_ms = 2000, .connect_s = 3, .answer_s = 5};  // a person waits
}

std::vector<std::string> StationSealer::said() const {
  const std::lock_guard lock(mutex_);
  return said_;
}

void StationSealer::say(const std::string& why) {
  const std::lock_guard lock(mutex_);
  said_.push_back(
      fmt::format("this session is recorded, but not sealed, so it counts for no exam: {}", why));
}

std::optional<record::StartSeal> StationSealer::begin(const record::SessionInfo& info) {
  seal_ = seal_about(info);
  seal_.station = key_.name();
  if (seal_.learner.empty() || !info.work_case) return std::nullopt;  // nobody's, or no case
  if (!is_persons_hand(seal_.device)) {
    say("burr moves the hand itself; a person must hold it");
    return std::nullopt;
  }
  const auto store = Store::open(place_);
  const auto given = store ? give_nonce(**store, seal_) : Result<Given>(store.error());
  if (!given) {
    say(given.error().text);
    return std::nullopt;
  }
  seal_.nonce = given->nonce;
  seal_.given_ms = given->given_ms;
  seal_.start_signature = key_.sign(start_words(seal_));
  return record::StartSeal{seal_.station, seal_.nonce, seal_.given_ms, seal_.start_signature};
}

Status StationSealer::close(const std::string& file, std::uint64_t bytes) {
  const auto head = sha256_of_beginning(file, bytes);
  if (!head) return head.error();
  const auto store = Store::open(place_);
  if (!store) return store.error();
  const auto ended = end_nonce(**store, seal_.nonce, *head);
  if (!ended) return ended.error();
  seal_.head = *head;
  seal_.ended_ms = *ended;
  seal_.signature = key_.sign(end_words(seal_));
  return fine();
}

std::optional<std::map<std::string, std::string>> StationSealer::end(const std::string& file,
                                                                     std::uint64_t bytes) {
  Status done = fine();
  try {
    done = close(file, bytes);
  } catch (const std::exception& why) {
    done = error(Trouble::internal, why.what());
  }
  if (!done) {
    say(done.error().text);
    return std::nullopt;
  }
  return std::map<std::string, std::string>{{"station", seal_.station},
                                            {"nonce", seal_.nonce},
                                            {"ended_ms", fmt::format("{}", seal_.ended_ms)},
                                            {"head", seal_.head},
                                            {"signature", seal_.signature}};
}

}  // namespace burr::school
