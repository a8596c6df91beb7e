// school/store.h - a centre's store of learners and their sessions: opened, and its learners.
//
//     auto place = school::place_of("", users_places());        // BURR_STORE, or the file in burr's data folder
//     auto store = school::Store::open(*place);
//     for (const std::string& line : (*store)->notices()) ...   // read-only, retention is over
//
// Learners are pseudonyms. Names lie in a file (SQLite) or a schema (PostgreSQL) of their own.
// docs/teach/school.md is the description for people. Thread: one at a time. Errors: as
// school/database.h.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/places.h"
#include "burr/base/result.h"
#include "burr/school/database.h"

namespace burr::school {

// Where a store is, and where sessions wait that could not be written into it.
struct StorePlace {
  std::string address;            // a file, or postgresql://...
  std::filesystem::path pending;  // a folder
  Waits waits = {};
  std::string who;  // for the audit; empty: the user and the computer
};
// given: as the user named it; empty: the environment's BURR_STORE, or school.sqlite in burr's data folder.
[[nodiscard]] Result<StorePlace> place_of(const std::string& given, const DeskPlaces& places);
// True: somebody named a store, or it is there already. Otherwise nobody wants sessions to be kept.
[[nodiscard]] bool is_wanted(const std::string& given, const StorePlace& place);
// The address without user and password.
[[nodiscard]] std::string shown(const std::string& address);
// The file with the names, beside a store in a file; empty for a server.
[[nodiscard]] std::string names_file(const std::string& address);

[[nodiscard]] std::int64_t now_ms();

class Store {
 public:
  // Makes the tables where they are missing.
  [[nodiscard]] static Result<std::unique_ptr<Store>> open(const StorePlace& place);

  [[nodiscard]] Database& database() { return *database_; }
  [[nodiscard]] const StorePlace& place() const { return place_; }
  [[nodiscard]] bool reads_only() const { return reads_only_; }
  // Sentences, as open() or look_again() found it: the store is of a newer burr; whose retention is over.
  [[nodiscard]] const std::vector<std::string>& notices() const { return notices_; }
  // Error, Trouble::io: a newer burr made it, so what was to be written must wait.
  [[nodiscard]] Status may_write() const;
  // Makes notices() anew: for a program that has the store open for days.
  [[nodiscard]] Status look_again();
  // One row of the audit: who, what, when. subject: an id, or nothing. By::computer: what happens by itself while a
  // learner works, whose login would join a name to the pseudonym.
  enum class By { person, computer };
  [[nodiscard]] Status note(std::string_view what, std::string_view subject, By by = By::person);

 private:
  Store() = default;
  StorePlace place_;
  std::unique_ptr<Database> database_;
  bool reads_only_ = false;
  std::string newer_;
  std::vector<std::string> notices_;
};

// ---- learners

struct Learner {
  std::string id;      // pseudonym; record::check_pseudonym()
  std::string level;   // "student", "PGY1" .. "PGY9", "surgeon"; empty: not said
  std::string handed;  // "left", "right", "both"; empty: not said
  std::int64_t created_ms = 0;
  std::optional<std::int64_t> retain_until_ms;  // none: until somebody deletes
  bool consent_research = false;                // otherwise for training alone
};
// Only where somebody gave it; a row of the other file or schema.
struct Person {
  std::string name, mail, external_id;
  [[nodiscard]] bool empty() const { return name.empty() && mail.empty() && external_id.empty(); }
};

// "heron-4821": not yet in the store.
[[nodiscard]] Result<std::string> new_pseudonym(Store& store);
// Error: a bad pseudonym, level or hand; or there is such a learner.
[[nodiscard]] Status add(Store& store, const Learner& learner, const Person& person);
[[nodiscard]] Result<bool> has(Store& store, const std::string& learner);

// People whose data should be gone by now.
[[nodiscard]] Result<std::vector<std::string>> overdue(Store& store, std::int64_t now);

// ---- cohorts

struct Cohort {
  std::string id, title;
  std::vector<std::string> members;
};
[[nodiscard]] Result<std::vector<Cohort>> cohorts(Store& store);
// Makes the cohort where there is none of that title. Error: no such learner.
[[nodiscard]] Status add_to_cohort(Store& store, const std::string& title,
                                   const std::vector<std::string>& learners);
// The cohort goes with its last member. Error: no such cohort, or no such member.
[[nodiscard]] Status remove_from_cohort(Store& store, const std::string& title,
                                        const std::vector<std::string>& learners);

}  // namespace burr::school
