// school/outbox.h - statements that wait to be sent to a learning record store: rows of the table `outbox`.
//
// Off until set_home_page(): before that no row is made. A row is made in the change in which the session comes in, so
// there is never one without the other. One row with the id "settings" holds the switch, for all stations of a store.
//
//     state      "waiting", "trying" (is being sent, or was when the program ended), "sent", "parked: SENTENCE"
//     tries      how often it was begun; above 0 the other side may have it
//     next_ms    not before
//
// Thread: as the Store. Errors: as school/database.h.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/session_record.h"
#include "burr/school/statements.h"
#include "burr/school/store.h"

namespace burr::school {

// Empty: off.
[[nodiscard]] Result<std::string> home_page(Store& store);
// Error, Trouble::usage: no IRI. Empty: off; what waits stays, and is not sent.
[[nodiscard]] Status set_home_page(Store& store, const std::string& iri);

// Within a change that the caller began. Nothing where it is off.
[[nodiscard]] Status queue_session(Store& store, const SessionRecord& record);
[[nodiscard]] Status queue_decision(Store& store, const Decided& decision);

struct Waiter {
  std::string id, json;
  std::int64_t tries = 0;  // with the one that begins
};
// Takes up to `most` rows and says that they are tried now, so that nobody else takes them for a while. None: nothing is
// due. all: also what is to be tried later.
[[nodiscard]] Result<std::vector<Waiter>> take_due(Store& store, std::int64_t now,
                                                   std::int64_t most, bool all);
[[nodiscard]] Status mark_sent(Store& store, const std::vector<std::string>& ids);
// why: the server's sentence; pseudonyms and ids of the statement are taken out of it.
[[nodiscard]] Status park(Store& store, const Waiter& row, const std::string& why);
[[nodiscard]] Status put_off(Store& store, const std::vector<std::string>& ids,
                             std::int64_t until_ms);
// Parked ones wait again. Returns how many.
[[nodiscard]] Result<std::int64_t> unpark(Store& store);

// Nothing is to be sent before this; and the last trouble, a sentence. 0 and "": none.
[[nodiscard]] Status set_pause(Store& store, std::int64_t until_ms, const std::string& trouble);

struct OutboxStatus {
  std::string home_page, trouble;
  std::int64_t waiting = 0, sent = 0, parked = 0;
  std::int64_t not_before_ms = 0;
  std::optional<std::int64_t> next_ms;  // of the first that waits
  struct Parked {
    std::string id, verb, why;
  };
  std::vector<Parked> first_parked;  // at most 20
};
[[nodiscard]] Result<OutboxStatus> outbox_status(Store& store);

// How long to wait after so many tries  [ms]: a minute, then twice as long each time, at most 6 hours.
[[nodiscard]] std::int64_t wait_after(std::int64_t tries);

}  // namespace burr::school
