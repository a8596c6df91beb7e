#include "burr/school/store.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <random>
#include <system_error>

#include "burr/base/printable.h"
#include "burr/record/identity.h"
#include "burr/school/audit_row.h"
#include "burr/school/store_schema.h"
#include "burr/school/uuid.h"

namespace burr::school {
namespace {

namespace fs = std::filesystem;

bool is_server(const std::string& address) {
  return address.rfind("postgresql://", 0) == 0 || address.rfind("postgres://", 0) == 0;
}

std::string user_and_computer() {
  const passwd* user = getpwuid(geteuid());
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return fmt::format("{}@{}", user != nullptr ? user->pw_name : "?", host.data());
}

// Animals and plants: nobody's name.
constexpr std::array kWords = std::to_array<const char*>(
    {"alder",   "aspen",  "badger", "beaver", "birch",   "bison",  "bramble", "cedar",
     "clover",  "crane",  "curlew", "dipper", "dolphin", "eagle",  "falcon",  "fern",
     "finch",   "gannet", "grouse", "hazel",  "heron",   "ibis",   "jackdaw", "juniper",
     "kestrel", "lark",   "linden", "lynx",   "maple",   "marten", "merlin",  "moss",
     "newt",    "oak",    "osprey", "otter",  "owl",     "pine",   "plover",  "raven",
     "reed",    "rowan",  "sedge",  "seal",   "sparrow", "spruce", "stork",   "swift",
     "tern",    "thrush", "trout",  "vole",   "weasel",  "willow", "wren",    "yew"});

bool is_level(const std::string& level) {
  if (level.empty() || level == "student" || level == "surgeon") return true;
  return level.size() == 4 && level.rfind("PGY", 0) == 0 && level[3] >= '1' && level[3] <= '9';
}

Status check(const Learner& learner) {
  if (const Status good = record::check_pseudonym(learner.id); !good) return good;
  if (!is_level(learner.level))
    return error(Trouble::usage, fmt::format("level {}: use student, PGY1 to PGY9, or surgeon",
                                             base::printable(learner.level)));
  if (!learner.handed.empty() && learner.handed != "left" && learner.handed != "right" &&
      learner.handed != "both")
    return error(Trouble::usage,
                 fmt::format("hand {}: use left, right or both", base::printable(learner.handed)));
  return fine();
}

Value some_or_null(const std::string& text) { return text.empty() ? Value() : Value(text); }

Result<std::string> cohort_id(Store& store, const std::string& title) {
  const auto found = store.database().rows("SELECT id FROM cohort WHERE title = $1", {title});
  if (!found) return found.error();
  return found->empty() ? std::string() : text((*found)[0][0]);
}

}  // namespace

std::int64_t now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string shown(const std::string& address) {
  if (!is_server(address)) return address;
  std::size_t begin = address.find("://") + 3;
  // up to the first @ before the path, as libpq reads it; else up to the last of all, since a password may hold any mark
  const bool clear = is_readable_address(address);
  const std::size_t at = clear ? address.find('@', begin) : address.rfind('@');
  const std::size_t path = std::min(address.find('/', begin), address.size());
  if (at != std::string::npos && (at < path || !clear)) {
    // a password in the query may hold that @
    if (!clear && address.substr(0, at).find("password=") != std::string::npos)
      return "postgresql://";
    begin = at + 1;
  }
  const std::size_t query = std::min(address.find('?', begin), address.size());
  std::string out = "postgresql://" + address.substr(begin, query - begin);
  char mark = '?';
  for (std::size_t next = query + 1; next < address.size();) {
    const std::size_t end = std::min(address.find('&', next), address.size());
    const std::string one = address.substr(next, end - next);
    for (const char* known : {"host=", "port=", "hostaddr=", "dbname="})
      if (one.rfind(known, 0) == 0) out += std::exchange(mark, '&') + one;
    next = end + 1;
  }
  return out;
}

std::string names_file(const std::string& address) {
  if (is_server(address)) return {};
  const fs::path file(address);
  return (file.parent_path() / (file.stem().string() + "-names" + file.extension().string()))
      .string();
}

Result<StorePlace> place_of(const std::string& given, const DeskPlaces& places) {
  StorePlace place;
  place.address = given;
  const char* named = std::getenv("BURR_STORE");
  if (place.address.empty() && named != nullptr) place.address = named;
  if (place.address.empty() && !places.data.empty())
    place.address = (places.data / "school.sqlite").string();
  if (place.address.empty())
    return error(Trouble::usage, "no folder for the store of learners; name a file as `store`");
  if (!is_server(place.address)) {
    // one name for one store: what waits says by it where it belongs
    std::error_code trouble;
    const fs::path whole = fs::absolute(place.address, trouble);
    const fs::path one = fs::weakly_canonical(whole, trouble);
    place.address = (trouble || one.empty() ? whole.lexically_normal() : one).string();
    place.pending = fs::path(place.address).parent_path() / "pending";
  } else if (places.data.empty()) {
    return error(Trouble::usage,
                 "no folder for sessions that wait for the server; set HOME or XDG_DATA_HOME");
  } else {
    place.pending = places.data / "pending";
  }
  return place;
}

bool is_wanted(const std::string& given, const StorePlace& place) {
  std::error_code nobody_asks;
  const char* named = std::getenv("BURR_STORE");
  return !given.empty() || (named != nullptr && *named != '\0') || is_server(place.address) ||
         fs::exists(place.address, nobody_asks);
}

Result<std::unique_ptr<Store>> Store::open(const StorePlace& place) {
  std::unique_ptr<Store> store(new Store);
  store->place_ = place;
  if (store->place_.who.empty()) store->place_.who = user_and_computer();
  auto database = is_server(place.address)
                      ? open_postgres(place.address, shown(place.address), place.waits)
                      : open_sqlite(place.address, names_file(place.address), place.waits);
  if (!database) return database.error();
  store->database_ = std::move(*database);
  const auto version = bring_to(*store->database_, now_ms());
  if (!version) return version.error();
  if (*version > kSchema) {
    store->reads_only_ = true;
    store->newer_ = fmt::format(
        "{}: a newer burr made this store (version {}, this burr knows {}), so it is only read; "
        "update burr",
        shown(place.address), *version, kSchema);
    if (const Status set = store->database_->read_only(); !set) return set.error();
  }
  if (const Status looked = store->look_again(); !looked) return looked.error();
  return store;
}

Status Store::look_again() {
  notices_.clear();
  if (reads_only_) notices_.push_back(newer_);
  const auto late = overdue(*this, now_ms());
  if (!late) return late.error();
  if (!late->empty())
    notices_.push_back(
        fmt::format("the time to keep is over for {}; `school::forget` deletes them, with all "
                    "their sessions and recordings",
                    base::list_of(*late)));
  return fine();
}

Status Store::may_write() const { return reads_only_ ? error(Trouble::io, newer_) : fine(); }

Status Store::note(std::string_view what, std::string_view subject, By by) {
  std::string who = place_.who;
  if (by == By::computer) who.erase(0, who.rfind('@') + 1);  // all of it where there is no @
  // the row before and this one together, or another program's row would come between them
  const bool alone = !database_->inside();
  auto change = alone ? Transaction::begin(*database_) : Result<Transaction>(error(""));
  if (alone && !change) return change.error();
  if (const Status noted = add_to_audit(*database_, now_ms(), who, what, subject); !noted)
    return noted;
  return alone ? change->commit() : fine();
}

Result<bool> has(Store& store, const std::string& learner) {
  const auto found = store.database().rows("SELECT 1 FROM learner WHERE id = $1", {learner});
  if (!found) return found.error();
  return !found->empty();
}

Result<std::string> new_pseudonym(Store& store) {
  std::random_device machine;
  std::uniform_int_distribution<std::size_t> word(0, kWords.size() - 1);
  std::uniform_int_distribution<int> number(100, 9999);
  for (int attempt = 0; attempt < 1000; ++attempt) {
    std::string id = fmt::format("{}-{}", kWords[word(machine)], number(machine));
    const auto taken = has(store, id);
    if (!taken) return taken.error();
    if (!*taken) return id;
  }
  return error(Trouble::failed, "no free pseudonym was found; give one as `id`");
}

Status add(Store& store, const Learner& learner, const Person& person) {
  if (const Status may = store.may_write(); !may) return may;
  if (const Status good = check(learner); !good) return good;
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  const auto there = has(store, learner.id);
  if (!there) return there.error();
  if (*there) return error(Trouble::usage, fmt::format("{}: there is such a learner", learner.id));
  const auto added = store.database().run(
      "INSERT INTO learner (id, created_ms, level, handed, retain_until_ms, consent_research) "
      "VALUES ($1, $2, $3, $4, $5, $6)",
      {learner.id, now_ms(), learner.level, learner.handed,
       learner.retain_until_ms ? Value(*learner.retain_until_ms) : Value(),
       std::int64_t{learner.consent_research}});
  if (!added) return added.error();
  // a name that a torn change left must not become this learner's; a server tears none, and may give no right to names
  if (!person.empty() || store.database().kind() == Database::Kind::sqlite) {
    const auto old =
        store.database().run("DELETE FROM names.person WHERE learner_id = $1", {learner.id});
    if (!old) return old.error();
  }
  if (!person.empty()) {
    const auto named = store.database().run(
        "INSERT INTO names.person (learner_id, name, mail, external_id) VALUES ($1, $2, $3, $4)",
        {learner.id, some_or_null(person.name), some_or_null(person.mail),
         some_or_null(person.external_id)});
    if (!named) return named.error();
  }
  if (const Status noted = store.note("learner added", learner.id); !noted) return noted;
  return change->commit();
}

Result<std::vector<std::string>> overdue(Store& store, std::int64_t now) {
  const auto found =
      store.database().rows("SELECT id FROM learner WHERE retain_until_ms < $1 ORDER BY id", {now});
  if (!found) return found.error();
  std::vector<std::string> ids;
  for (const Row& row : *found) ids.push_back(text(row[0]));
  return ids;
}

Result<std::vector<Cohort>> cohorts(Store& store) {
  const auto found = store.database().rows(
      "SELECT cohort.id, cohort.title, cohort_member.learner_id FROM cohort "
      "LEFT JOIN cohort_member ON cohort_member.cohort_id = cohort.id "
      "ORDER BY cohort.title, cohort_member.learner_id");
  if (!found) return found.error();
  std::vector<Cohort> all;
  for (const Row& row : *found) {
    if (all.empty() || all.back().id != text(row[0]))
      all.push_back({text(row[0]), text(row[1]), {}});
    if (!is_null(row[2])) all.back().members.push_back(text(row[2]));
  }
  return all;
}

Status add_to_cohort(Store& store, const std::string& title,
                     const std::vector<std::string>& learners) {
  if (const Status may = store.may_write(); !may) return may;
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  auto id = cohort_id(store, title);
  if (!id) return id.error();
  if (id->empty()) {
    *id = uuid_at_random();
    const auto made =
        store.database().run("INSERT INTO cohort (id, title) VALUES ($1, $2)", {*id, title});
    if (!made) return made.error();
  }
  for (const std::string& learner : learners) {
    const auto there = has(store, learner);
    if (!there) return there.error();
    if (!*there)
      return error(Trouble::usage,
                   fmt::format("{}: there is no such learner; `school::learners` lists them",
                               base::printable(learner)));
    const auto added = store.database().run(
        "INSERT INTO cohort_member (cohort_id, learner_id) VALUES ($1, $2) ON CONFLICT DO NOTHING",
        {*id, learner});
    if (!added) return added.error();
    if (const Status noted = store.note("added to a cohort", learner); !noted) return noted;
  }
  return change->commit();
}

Status remove_from_cohort(Store& store, const std::string& title,
                          const std::vector<std::string>& learners) {
  if (const Status may = store.may_write(); !may) return may;
  auto change = Transaction::begin(store.database());
  if (!change) return change.error();
  const auto id = cohort_id(store, title);
  if (!id) return id.error();
  if (id->empty())
    return error(Trouble::usage,
                 fmt::format("{}: there is no such cohort; `school::cohorts` lists them",
                             base::printable(title)));
  for (const std::string& learner : learners) {
    const auto gone = store.database().run(
        "DELETE FROM cohort_member WHERE cohort_id = $1 AND learner_id = $2", {*id, learner});
    if (!gone) return gone.error();
    if (*gone == 0)
      return error(Trouble::usage, fmt::format("{} is not in {}", base::printable(learner),
                                               base::printable(title)));
    if (const Status noted = store.note("removed from a cohort", learner); !noted) return noted;
  }
  const auto empty = store.database().run(
      "DELETE FROM cohort WHERE id = $1 AND NOT EXISTS "
      "(SELECT 1 FROM cohort_member WHERE cohort_id = cohort.id)",
      {*id});
  if (!empty) return empty.error();
  return change->commit();
}

}  // namespace burr::school
