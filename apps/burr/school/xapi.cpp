#include "school/xapi.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "burr/base/places.h"
#include "burr/base/printable.h"
#include "burr/lrs/launch.h"
#include "burr/lrs/sender.h"
#include "burr/school/outbox.h"
#include "school/store_command.h"
#include "shared/counted.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::string store, key_file, home_page;
  bool json = false, now = false;
  double seconds = 0, wait_s = 30;
};

std::string time_of(std::int64_t ms) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S}Z", fmt::gmtime(static_cast<std::time_t>(ms / 1000)));
}

Status run_switch(const Options& options, bool on) {
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  if (const Status set = school::set_home_page(**store, on ? options.home_page : std::string());
      !set)
    return set;
  if (on)
    fmt::print(
        "on: sessions that come in from now on make statements; `burr learner xapi test` looks "
        "whether they can be sent from here\n");
  else
    fmt::print("off: no more statements are made or sent; what waited stays\n");
  return fine();
}

Status run_status(const Options& options) {
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  const auto now = school::outbox_status(**store);
  if (!now) return now.error();
  fmt::print("{}\n", now->home_page.empty()
                         ? "off; `burr learner xapi on --home-page https://YOUR-CENTRE` begins"
                         : "on, for " + base::printable(now->home_page, 200));
  fmt::print("{} waiting, {} sent, {} parked\n", now->waiting, now->sent, now->parked);
  if (!now->trouble.empty()) fmt::print("last trouble: {}\n", now->trouble);
  const std::int64_t next = std::max(now->not_before_ms, now->next_ms.value_or(0));
  if (now->waiting > 0 && next > school::now_ms())
    fmt::print("tried again from {}; `burr learner xapi send --now` tries at once\n",
               time_of(next));
  Json parked = Json::array();
  for (const auto& one : now->first_parked) {
    fmt::print("parked: {} {}: {}\n", one.verb, one.id, one.why);
    parked.push_back({{"id", one.id}, {"verb", one.verb}, {"why", one.why}});
  }
  if (now->parked > 0) fmt::print("`burr learner xapi retry` lets parked ones wait again\n");
  const std::size_t launches = lrs::count_waiting(launches_folder());
  if (launches > 0)
    fmt::print(
        "{}, of which a learning management system was not told yet; `burr learner take-in` "
        "tries\n",
        launches == 1 ? "1 launch" : fmt::format("{} launches", launches));
  print_json(options.json, {{"on", !now->home_page.empty()},
                            {"home_page", now->home_page},
                            {"waiting", now->waiting},
                            {"sent", now->sent},
                            {"parked", now->parked},
                            {"trouble", now->trouble},
                            {"next_ms", now->waiting > 0 ? Json(next) : Json(nullptr)},
                            {"first_parked", parked},
                            {"launches", launches}});
  return fine();
}

Status run_send(const Options& options) {
  tell_waiting_launches();
  const auto lrs = lrs::read_lrs(options.key_file, users_places().config);
  if (!lrs) return lrs.error();
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  const auto until =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(options.seconds);
  lrs::Sent all;
  for (lrs::Ways ways{.all = options.now, .wait_s = options.wait_s};; ways.all = false) {
    const auto sent = lrs::send_due(**store, *lrs, ways);
    if (!sent) return sent.error();
    all.sent += sent->sent;
    all.parked += sent->parked;
    all.trouble = sent->trouble;
    if (std::chrono::steady_clock::now() >= until || interrupted()) break;
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  fmt::print("{} sent, {} parked\n", counted(all.sent, "statement"), all.parked);
  print_json(options.json, {{"sent", all.sent}, {"parked", all.parked}, {"trouble", all.trouble}});
  if (!all.trouble.empty())
    return error(Trouble::io, fmt::format("the rest waits: {}", all.trouble));
  return fine();
}

Status run_retry(const Options& options) {
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  const auto some = school::unpark(**store);
  if (!some) return some.error();
  fmt::print("{} wait again\n", counted(static_cast<std::size_t>(*some), "statement"));
  return fine();
}

Status run_test(const Options& options) {
  const auto lrs = lrs::read_lrs(options.key_file, users_places().config);
  if (!lrs) return lrs.error();
  const auto versions = lrs::about(*lrs);
  if (!versions) return versions.error();
  fmt::print("{}: it speaks xAPI {} and takes the key\n", base::printable(lrs->endpoint, 200),
             base::printable(*versions, 200));
  return fine();
}

void add_key_file(CLI::App& command, Options& options) {
  command.add_option("--key-file", options.key_file,
                     "a file with two lines, the endpoint and KEY:SECRET, readable by you alone "
                     "(default: BURR_XAPI_FILE, or `xapi` in burr's settings folder)");
}

}  // namespace

void add_xapi(CLI::App& learner, Todo& todo) {
  auto* command =
      learner.add_subcommand("xapi", "statements about sessions for a learning record store");
  command->require_subcommand(1);
  auto options = std::make_shared<Options>();
  auto* on = store_command<Options>(
      *command, "on", "sessions that come in make statements from now on", options, todo,
      [](const Options& given) { return run_switch(given, true); });
  on->add_option("--home-page", options->home_page,
                 "the centre's address; with it a pseudonym is an account")
      ->required();
  options = std::make_shared<Options>();
  store_command<Options>(*command, "off", "no more statements are made or sent", options, todo,
                         [](const Options& given) { return run_switch(given, false); });
  options = std::make_shared<Options>();
  auto* status = store_command<Options>(*command, "status",
                                        "what waits, what was sent, what the server refused",
                                        options, todo, run_status);
  status->add_flag("--json", options->json, "print a JSON object as the last line");
  options = std::make_shared<Options>();
  auto* send =
      store_command<Options>(*command, "send", "send what is due", options, todo, run_send);
  add_key_file(*send, *options);
  send->add_flag("--now", options->now, "also what is to be tried later");
  send->add_option("--for", options->seconds, "go on for this many seconds with what becomes due")
      ->check(CLI::Range(0.0, 1e6));
  send->add_option("--wait", options->wait_s, "for an answer, in seconds")
      ->check(CLI::Range(0.1, 600.0))
      ->capture_default_str();
  send->add_flag("--json", options->json, "print a JSON object as the last line");
  options = std::make_shared<Options>();
  store_command<Options>(*command, "retry", "let parked statements wait again", options, todo,
                         run_retry);
  options = std::make_shared<Options>();
  auto* test = store_command<Options>(*command, "test", "ask the server whether it can be used",
                                      options, todo, run_test);
  add_key_file(*test, *options);
}

std::filesystem::path launches_folder() { return users_places().state / "cmi5"; }

void tell_waiting_launches() {
  const lrs::SentLater sent = lrs::tell_waiting(launches_folder());
  if (sent.launches > 0)
    fmt::print(stderr, "{} kept from earlier were sent to the learning management system\n",
               sent.launches == 1 ? "1 launch" : fmt::format("{} launches", sent.launches));
  print_notices(sent.notices);
}

void send_what_is_due(school::Store& store) {
  const auto page = school::home_page(store);
  if (!page || page->empty()) return;
  const auto lrs = lrs::read_lrs("", users_places().config);
  if (!lrs) return;  // another computer has the key
  const auto sent = lrs::send_due(store, *lrs, {});
  if (!sent)
    fmt::print(stderr, "statements: {}\n", in_options(sent.error()).text);
  else if (!sent->trouble.empty())
    fmt::print(stderr, "statements wait: {}\n", sent->trouble);
}

}  // namespace burr::app
