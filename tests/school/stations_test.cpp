// Ten stations and one server for eight hours of a centre, each of a few seconds: the server crashes, its disk is full,
// the network swallows everything, stations are killed. Nothing is lost, and nothing comes twice.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "burr/school/forget.h"
#include "burr/school/outbox.h"
#include "burr/school/pending.h"
#include "burr/school/sessions.h"
#include "school/made.h"
#include "support/postgres_server.h"

namespace burr::school {
namespace {

using test::Folder;
using test::made_session;
using test::PostgresServer;

constexpr int kPlaces = 10, kHours = 8, kAnHour = 6;
constexpr int kAll = kPlaces * kHours * kAnHour;

// What the processes of a test share.
struct Shared {
  std::atomic<int> hour = -1;  // stations work up to this one
  std::array<std::atomic<int>, kPlaces> done = {};
  std::atomic<int> waited = 0,
                   full = 0;  // sessions that could not be written; because the disk was full
  std::atomic<bool> swallow = false;
};

Shared* shared_memory() {
  void* place =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  return place == MAP_FAILED ? nullptr : new (place) Shared;
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un out = {};
  out.sun_family = AF_UNIX;
  std::strncpy(out.sun_path, path.c_str(), sizeof out.sun_path - 1);
  return out;
}

// Passes bytes on in both directions; while it swallows, they are gone and nobody hears of it.
[[noreturn]] void proxy(int door, const std::string& server, const std::atomic<bool>& swallow) {
  std::vector<pollfd> ends = {{door, POLLIN, 0}};  // then pairs: client, server
  std::vector<char> some(65536);
  for (;;) {
    if (::poll(ends.data(), ends.size(), 1000) <= 0) continue;
    for (std::size_t n = ends.size() - 1; n > 0; --n) {
      if (ends[n].revents == 0) continue;
      const std::size_t other = n % 2 == 1 ? n + 1 : n - 1;
      const ssize_t got = ::recv(ends[n].fd, some.data(), some.size(), MSG_DONTWAIT);
      if (got > 0 && !swallow)
        static_cast<void>(
            ::send(ends[other].fd, some.data(), static_cast<std::size_t>(got), MSG_NOSIGNAL));
      if (got > 0) continue;
      const std::size_t first = std::min(n, other);
      ::close(ends[first].fd);
      ::close(ends[first + 1].fd);
      ends.erase(ends.begin() + static_cast<std::ptrdiff_t>(first),
                 ends.begin() + static_cast<std::ptrdiff_t>(first) + 2);
      n = std::min(n, ends.size());  // what moved up is looked at in the next round
      break;
    }
    if (ends[0].revents == 0) continue;
    const int client = ::accept(door, nullptr, nullptr);
    const int behind = ::socket(AF_UNIX, SOCK_STREAM, 0);
    const sockaddr_un place = address_of(server);
    if (client >= 0 &&
        ::connect(behind, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0) {
      ends.push_back({client, POLLIN, 0});
      ends.push_back({behind, POLLIN, 0});
    } else {
      if (client >= 0) ::close(client);
      ::close(behind);
    }
  }
}

SessionRecord session_of(int station, int hour, int number) {
  const std::string what =
      std::to_string(station) + "." + std::to_string(hour) + "." + std::to_string(number);
  SessionRecord one =
      made_session("kestrel-27", what, 1'700'000'000'000 + hour * 3'600'000LL + number * 600'000LL);
  // text that cannot be packed, so that the table grows
  std::string noise;
  for (int n = 0; n < 46; ++n) noise += school::sha1(what + std::to_string(n));
  for (ItemRecord& item : one.scores[0].items) item.evidence_json = "{\"noise\":\"" + noise + "\"}";
  return one;
}

// Returns 0 if each session was stored or waits.
int at_work(const StorePlace& place, int number, int from, Shared& shared) {
  for (int hour = from; hour < kHours; ++hour) {
    while (shared.hour < hour) ::usleep(2000);
    for (int n = 0; n < kAnHour; ++n) {
      const auto kept = enter_or_keep(place, session_of(number, hour, n));
      if (!kept) return 1;
      if (!kept->stored) {
        ++shared.waited;
        if (kept->why.find("too large") != std::string::npos) ++shared.full;
      }
    }
    if (auto store = Store::open(place)) static_cast<void>(take_in(**store, {}));  // a new start
    shared.done[static_cast<std::size_t>(number)] = hour + 1;
  }
  return 0;
}

class Centre : public ::testing::Test {
 protected:
  void SetUp() override {
    BURR_NEEDS_POSTGRES(server_);
    shared_ = shared_memory();
    ASSERT_NE(shared_, nullptr);
    direct_ = test::place_in(folder_);
    direct_.address = server_.address();
    auto store = Store::open(direct_);
    ASSERT_TRUE(store) << store.error().text;
    Learner learner;
    learner.id = "kestrel-27";
    ASSERT_TRUE(add(**store, learner, {"Ada Lovelace", "ada@example.org", "S-1815"}));
    ASSERT_TRUE(set_home_page(**store, "https://centre.example"));
  }
  void TearDown() override {
    if (proxy_ <= 0) return;
    ::kill(proxy_, SIGKILL);
    ::waitpid(proxy_, nullptr, 0);
  }

  void begin_proxy() {
    const std::string server = server_.address();
    const int door = ::socket(AF_UNIX, SOCK_STREAM, 0);
    const sockaddr_un place = address_of(folder_ / ".s.PGSQL.5432");
    ASSERT_EQ(::bind(door, reinterpret_cast<const sockaddr*>(&place), sizeof place), 0);
    ASSERT_EQ(::listen(door, 64), 0);
    proxy_ = ::fork();
    if (proxy_ == 0)
      proxy(door, server.substr(server.find("host=") + 5) + "/.s.PGSQL.5432", shared_->swallow);
    ::close(door);
  }
  [[nodiscard]] StorePlace place_of_station(int number) const {
    StorePlace place = direct_;
    place.address = "postgresql://burr@/postgres?host=" + folder_.str();
    place.pending = folder_.path() / ("pending" + std::to_string(number));
    place.waits = {5000, 2, 1};
    return place;
  }
  void start_station(int number, int from) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(at_work(place_of_station(number), number, from, *shared_));
    ASSERT_GT(child, 0);
    stations_[static_cast<std::size_t>(number)] = child;
  }
  // Lets the stations work for one hour; meanwhile() is called until all are done with it.
  void work(int hour, const std::function<void()>& meanwhile = {}) {
    shared_->hour = hour;
    const auto busy = [&] {
      return std::any_of(shared_->done.begin(), shared_->done.end(),
                         [&](const std::atomic<int>& done) { return done <= hour; });
    };
    for (int n = 0; busy() && n < 60'000; ++n) {
      if (meanwhile) meanwhile();
      ::usleep(2000);
    }
    ASSERT_FALSE(busy()) << "hour " << hour;
  }
  void cut_connections() {
    if (auto other = open_postgres(direct_.address, "other", {}))
      static_cast<void>(
          (*other)->rows("SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity "
                         "WHERE pid <> pg_backend_pid() AND datname = 'postgres'"));
  }
  // No file of the server may grow beyond what the largest table has now.
  void fill_the_disk() {
    auto store = Store::open(direct_);
    ASSERT_TRUE(store) << store.error().text;
    const auto size = (*store)->database().rows("SELECT pg_relation_size('item')");
    ASSERT_TRUE(size) << size.error().text;
    const auto bytes = static_cast<rlim_t>(whole((*size)[0][0]));
    ASSERT_GT(bytes, 1'200'000U);  // more than a piece of the server's log of writes
    store->reset();
    rlimit before = {};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    rlimit small = before;
    small.rlim_cur = bytes;
    server_.stop("fast");
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const bool started = server_.start();
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    ASSERT_TRUE(started) << server_.log();
  }
  std::int64_t count(Store& store, Sql sql) {
    const auto rows = store.database().rows(sql);
    return rows ? whole((*rows)[0][0]) : -1;
  }

  Folder folder_;
  PostgresServer server_{{"--wal-segsize=1"}};
  StorePlace direct_;
  Shared* shared_ = nullptr;
  pid_t proxy_ = -1;
  std::array<pid_t, kPlaces> stations_ = {};
};

TEST_F(Centre, EightHoursLoseNothingAndEnterNothingTwice) {
  begin_proxy();
  for (int n = 0; n < kPlaces; ++n) start_station(n, 0);
  for (int hour = 0; hour < 2; ++hour) work(hour);
  EXPECT_EQ(shared_->waited, 0);
  int rounds = 0;
  work(2, [&] {
    if (++rounds % 25 == 0) cut_connections();
  });
  server_.stop("immediate");
  work(3, [&] {
    if (!server_.runs() && shared_->waited > 20) static_cast<void>(server_.start());
  });
  ASSERT_TRUE(server_.runs() || server_.start()) << server_.log();
  const int before_net = shared_->waited;
  shared_->swallow = true;
  work(4, [&] { shared_->swallow = shared_->waited < before_net + 20; });
  EXPECT_GE(shared_->waited, before_net + 20);
  shared_->swallow = false;
  fill_the_disk();
  work(5);
  EXPECT_GT(shared_->full, 0);
  server_.stop("fast");
  ASSERT_TRUE(server_.start()) << server_.log();
  // stations are killed in the middle of their work, and begin the hour again
  shared_->hour = 6;
  for (int n = 0; n < kPlaces; n += 3) {
    ::usleep(10'000);
    ::kill(stations_[static_cast<std::size_t>(n)], SIGKILL);
    ::waitpid(stations_[static_cast<std::size_t>(n)], nullptr, 0);
    start_station(n, std::min(shared_->done[static_cast<std::size_t>(n)].load(), kHours - 1));
  }
  work(6);
  work(7);
  for (const pid_t child : stations_) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  for (int n = 0; n < kPlaces; ++n) {
    auto store = Store::open(place_of_station(n));
    ASSERT_TRUE(store) << store.error().text;
    const TakenIn in = take_in(**store, {});
    EXPECT_EQ(in.left, 0U);
    EXPECT_EQ(in.notices, std::vector<std::string>{});
  }
  auto store = Store::open(direct_);
  ASSERT_TRUE(store) << store.error().text;
  EXPECT_EQ(count(**store, "SELECT count(*) FROM session"), kAll);
  EXPECT_EQ(count(**store, "SELECT count(DISTINCT recording_hash) FROM session"), kAll);
  EXPECT_EQ(count(**store, "SELECT count(*) FROM score"), 2 * kAll);
  EXPECT_EQ(count(**store, "SELECT count(*) FROM item"), 4 * kAll);
  EXPECT_EQ(count(**store, "SELECT count(*) FROM self_mark"), 2 * kAll);
  EXPECT_EQ(count(**store, "SELECT count(*) FROM audit WHERE what = 'session entered'"), kAll);
  EXPECT_EQ(count(**store, "SELECT count(*) FROM outbox WHERE state = 'waiting'"), 2 * kAll);
  RecordProperty("waited", shared_->waited.load());
  RecordProperty("full", shared_->full.load());
}

// The files of the server, but for its log of writes, which is its administrator's.
std::vector<std::string> files_holding(const std::string& folder, const std::string& text) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file() || entry.path().string().find("pg_wal") != std::string::npos)
      continue;
    std::ifstream file(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.find(text) != std::string::npos) out.push_back(entry.path().string());
  }
  return out;
}

TEST_F(Centre, NoFileOfTheServerHoldsAForgottenLearner) {
  auto store = Store::open(direct_);
  ASSERT_TRUE(store) << store.error().text;
  const auto folder = (*store)->database().rows("SHOW data_directory");
  ASSERT_TRUE(folder) << folder.error().text;
  const std::string data = text((*folder)[0][0]);
  Learner other;
  other.id = "otter-5";
  ASSERT_TRUE(add(**store, other, {"Grace Hopper", "", ""}));
  for (int n = 0; n < 30; ++n)
    for (const char* who : {"kestrel-27", "otter-5"})
      ASSERT_TRUE(enter(**store, made_session(who, std::to_string(n))));
  ASSERT_TRUE(add_to_cohort(**store, "autumn", {"kestrel-27", "otter-5"}));
  const auto tried = take_due(**store, now_ms(), 30, true);
  ASSERT_TRUE(tried);
  const auto mine = std::find_if(tried->begin(), tried->end(), [](const Waiter& row) {
    return row.json.find("kestrel-27") != std::string::npos;
  });
  ASSERT_NE(mine, tried->end());
  ASSERT_TRUE(park(**store, *mine, "400: kestrel-27 is not known"));
  ASSERT_TRUE(mark_sent(**store, {tried->front().id, tried->back().id}));
  ASSERT_TRUE((*store)->database().run("VACUUM ANALYZE"));
  ASSERT_TRUE((*store)->database().run("CHECKPOINT"));
  const std::vector<std::string> gone = {"kestrel-27", "Ada Lovelace", "ada@example.org", "S-1815",
                                         session_id(made_session("kestrel-27", "7"))};
  for (const std::string& one : gone) EXPECT_FALSE(files_holding(data, one).empty()) << one;
  const auto done = forget(**store, "kestrel-27", {});
  ASSERT_TRUE(done) << done.error().text;
  EXPECT_EQ(done->notices, std::vector<std::string>{});
  ASSERT_TRUE((*store)->database().run("CHECKPOINT"));
  store->reset();
  server_.stop("fast");
  for (const std::string& one : gone)
    EXPECT_EQ(files_holding(data, one), std::vector<std::string>{}) << one;
  EXPECT_FALSE(files_holding(data, "otter-5").empty());
  EXPECT_FALSE(files_holding(data, "Grace Hopper").empty());
}

}  // namespace
}  // namespace burr::school
