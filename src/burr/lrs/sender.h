// lrs/sender.h - sends what waits in the outbox (school/outbox.h) to a learning record store, by xAPI 1.0.3.
//
//     auto lrs = lrs::read_lrs("", users_places().config);    // where, and with which key
//     auto sent = lrs::send_due(*store, *lrs, {});
//
// At most 50 statements in one POST. Before they go, their rows say that they are tried; so nothing is lost when the
// program ends at any moment, and a statement that arrives twice has the same id and changes nothing. 200 with these ids:
// sent. 429, 5xx, no answer: later, and all others too. 401, 403, 404 and redirections are of the key or the address, not
// of a statement: all wait. 409: the server has the id; what it has is compared. 400 and others of 4xx: halves are sent
// until the one is found that it does not want, which is parked with its sentence. Thread: as the Store. Cost: waits for
// the network; never call it in a window's or a session's thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/result.h"
#include "burr/school/store.h"

namespace burr::lrs {

struct Lrs {
  std::string endpoint;       // without the last /
  std::string authorization;  // the value of that field; never print it
};
// BURR_XAPI_ENDPOINT and BURR_XAPI_KEY ("key:secret") of the environment, or a file with two lines, the endpoint and
// key:secret, which only its owner may read: file, or BURR_XAPI_FILE, or `xapi` in `config`. Endpoint and key lie together,
// so who may write the store cannot lead the key elsewhere. Error, Trouble::usage: what is missing.
[[nodiscard]] Result<Lrs> read_lrs(const std::string& file, const std::filesystem::path& config);

struct Ways {
  bool all = false;        // also what is to be tried later
  std::int64_t most = 50;  // in one POST
  double wait_s = 30;      // for an answer
};
struct Sent {
  std::size_t sent = 0, parked = 0;
  std::string trouble;  // why it stopped; empty: nothing that is due is left
};
// Error: the store; or nothing is made (off).
[[nodiscard]] Result<Sent> send_due(school::Store& store, const Lrs& lrs, const Ways& ways);

// The versions of xAPI that the server speaks. Error: it is none that burr can use, or it does not take the key.
[[nodiscard]] Result<std::string> about(const Lrs& lrs);

// True: the server's statement is the one that was sent, with what a server may add or write otherwise.
[[nodiscard]] bool is_same(const std::string& sent, const std::string& found);

}  // namespace burr::lrs
