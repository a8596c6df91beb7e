// serve/school_api.h - what the instructor's page may ask of the store of learners, as JSON. Reads only.
//
//     GET /api/overview                learners, cohorts, cases
//     GET /api/cohort?id=&case=        learners by items
//     GET /api/learner?id=             sessions, curves
//     GET /api/session?id=             items with evidence
//     GET /api/audit                   who did what to the store
//     GET /api/sessions.csv            a table for other programs
//
// Pseudonyms only: the file or schema with the names is never read here. Thread: as the Store.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "burr/net/request.h"
#include "burr/school/practice.h"
#include "burr/school/store.h"

namespace burr::app {

// 404 for what there is not, 503 while the store cannot be read. memo: of this store, kept between requests.
[[nodiscard]] net::Response answer_of_school(school::Store& store, const net::Request& request,
                                             school::PracticeMemo& memo);

// The words of a rubric's items, by id: {"en": ..., "sv": ...}. Empty where its text cannot be read any more.
[[nodiscard]] std::map<std::string, nlohmann::ordered_json> words_of(
    school::Store& store, const std::string& rubric_hash);

}  // namespace burr::app
