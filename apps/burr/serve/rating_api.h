// apps/burr/serve/rating_api.h - what the instructor's page may ask and change about marks by persons, and what it may read
// of agreement and standards.
//
//     POST /api/rating/next      {"rater": NAME, "rubric": HASH}     the next product, by a code
//     GET  /api/rating/product?code=                                 its items, and whether its pictures are drawn
//     GET  /api/rating/picture?code=&name=                           one of them, PNG
//     POST /api/rating/marks     {"rater": NAME, "code": CODE, "marks": [{"item":, "mark":, "reason":}]}
//     GET  /api/agreement?rubric=                                    figures of raters and of reliability
//     GET  /api/standards                                            standards, proposals, decisions
//
// Marks are all that can be changed. A code is drawn at random for each rater and session and lasts until the server ends:
// it leads to no learner. No answer about a product says whose it is, when it was made, its level, or what the machine
// thinks. Thread: as the Store.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "burr/net/request.h"
#include "burr/school/store.h"
#include "serve/product_pictures.h"

namespace burr::app {

class RatingDesk {
 public:
  // Keeps the store by reference. Sets BURR_STORE for the programs that it starts: call it before any other thread runs.
  explicit RatingDesk(school::Store& store);

  // None: the request is about something else.
  [[nodiscard]] std::optional<net::Response> answer(const net::Request& request);

 private:
  struct Ticket {
    std::string rater, session, rubric_hash, case_name;
  };
  [[nodiscard]] net::Response next(const net::Request& request);
  [[nodiscard]] net::Response product(const net::Request& request);
  [[nodiscard]] net::Response picture(const net::Request& request);
  [[nodiscard]] net::Response take_marks(const net::Request& request);
  [[nodiscard]] net::Response agreement(const net::Request& request);
  [[nodiscard]] net::Response standards();
  [[nodiscard]] std::string code_for(const Ticket& ticket);

  school::Store& store_;
  std::uint64_t seed_;                     // of the order, of this run of the server
  std::map<std::string, Ticket> tickets_;  // by code
  std::map<std::pair<std::string, std::string>, std::string> codes_;  // of rater and session
  PictureDesk pictures_;
  std::string agreement_of_;  // the state of the store of which agreement_json_ tells
  std::string agreement_json_;
};

}  // namespace burr::app
