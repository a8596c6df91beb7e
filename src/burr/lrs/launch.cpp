#include "burr/lrs/launch.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/printable.h"
#include "burr/net/client.h"
#include "burr/school/statements.h"
#include "burr/school/store.h"
#include "burr/school/uuid.h"

namespace burr::lrs {
namespace {

using Json = nlohmann::ordered_json;
using Trouble = burr::Trouble;

constexpr const char* kCategory = "https://w3id.org/xapi/cmi5/context/categories/cmi5";
constexpr const char* kMoveOn = "https://w3id.org/xapi/cmi5/context/categories/moveon";
constexpr const char* kSession = "https://w3id.org/xapi/cmi5/context/extensions/sessionid";

std::map<std::string, std::string> query_of(const std::string& url) {
  std::map<std::string, std::string> out;
  std::size_t at = url.find('?');
  while (at != std::string::npos && at < url.size()) {
    const std::size_t end = std::min(url.find_first_of("&#", at + 1), url.size());
    const std::string one = url.substr(at + 1, end - at - 1);
    const std::size_t equals = std::min(one.find('='), one.size());
    out[one.substr(0, equals)] = net::unescaped(one.substr(std::min(equals + 1, one.size())));
    at = end < url.size() && url[end] == '&' ? end : std::string::npos;
  }
  return out;
}

bool is_uuid(const std::string& text) {
  return text.size() == 36 && text[8] == '-' && text[13] == '-' && text[18] == '-' &&
         text[23] == '-' && text.find_first_not_of("0123456789abcdefABCDEF-") == std::string::npos;
}

Error refuses(const char* what, const net::Answer& answer) {
  return error(Trouble::io, fmt::format("cmi5: {}: the learning management system answers {}: {}",
                                        what, answer.status, base::printable(answer.body, 200)));
}

}  // namespace

namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

// Where statements go, and with what right.
struct Post {
  std::string endpoint, token;
  double wait_s = 15;

  [[nodiscard]] Result<net::Answer> ask(const char* method, const std::string& path,
                                        const std::string& body) const {
    return net::ask({method,
                     endpoint + path,
                     {{"Authorization", "Basic " + token},
                      {"X-Experience-API-Version", "1.0.3"},
                      {"Content-Type", "application/json"}},
                     body,
                     wait_s});
  }

  struct Heard {
    bool answered = true;  // false: later, perhaps
    Status status = fine();
  };
  // The id stays the same, so trying again does no harm.
  [[nodiscard]] Heard tell(const Json& one, Clock::time_point until) const {
    const std::string path = "/statements?statementId=" + one["id"].get<std::string>();
    for (std::chrono::milliseconds pause(500);; pause *= 2) {
      const auto answer = ask("PUT", path, one.dump());
      // 409: it has it from a try whose answer was lost
      if (answer && (answer->status == 204 || answer->status == 200 || answer->status == 409))
        return {};
      const bool again = !answer || answer->status == 429 || answer->status >= 500;
      if (!again || Clock::now() + pause > until)
        return {!again, answer ? refuses("a statement", *answer) : answer.error()};
      std::this_thread::sleep_for(pause);
    }
  }
};

Clock::time_point after(double seconds) {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

constexpr std::int64_t kDay = 86'400'000;  // [ms]

// For this user alone: the token is in it.
Status keep(const fs::path& folder, const Post& post, const Json& statements) {
  std::error_code trouble;
  fs::create_directories(folder, trouble);
  auto file = base::NewFile::create((folder / (school::uuid_at_random() + ".json")).string());
  if (!file) return file.error();
  file->write(Json{{"endpoint", post.endpoint},
                   {"token", post.token},
                   {"until_ms", school::now_ms() + kDaysToWait * kDay},
                   {"statements", statements}}
                  .dump());
  return file->put_in_place();
}

std::vector<fs::path> waiting_in(const fs::path& folder) {
  std::vector<fs::path> all;
  std::error_code nobody_asks;
  for (const auto& entry : fs::directory_iterator(folder, nobody_asks))
    if (entry.path().extension() == ".json") all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

struct Launch::Parts {
  std::string registration, activity;
  Post post;
  Json actor, context;
  bool normal = true;
  std::int64_t last_ms = 0;

  [[nodiscard]] Result<net::Answer> ask(const char* method, const std::string& path,
                                        const std::string& body) const {
    return post.ask(method, path, body);
  }

  // One of the statements that cmi5 defines.
  [[nodiscard]] Json statement(const char* verb, const Json& result, bool moves_on) {
    Json about = context;
    about["registration"] = registration;
    Json categories = Json::array();
    if (about.contains("contextActivities") && about["contextActivities"].is_object()) {
      const Json& known = about["contextActivities"].value("category", Json::array());
      for (const Json& one : known.is_array() ? known : Json::array({known}))
        if (one.is_object() && one.value("id", "") != kCategory && one.value("id", "") != kMoveOn)
          categories.push_back(one);
    }
    categories.push_back({{"id", kCategory}});
    if (moves_on) categories.push_back({{"id", kMoveOn}});
    about["contextActivities"]["category"] = categories;
    // their order is told by the time, to the millisecond
    last_ms = std::max(school::now_ms(), last_ms + 1);
    Json out = {{"id", school::uuid_at_random()},
                {"actor", actor},
                {"verb",
                 {{"id", std::string("http://adlnet.gov/expapi/verbs/") + verb},
                  {"display", {{"en", verb}}}}},
                {"object", {{"objectType", "Activity"}, {"id", activity}}},
                {"context", about},
                {"timestamp", school::iso_time(last_ms)}};
    if (!result.is_null()) out["result"] = result;
    return out;
  }

  [[nodiscard]] Status fetch(const std::string& url) {
    const auto answer = net::ask({"POST", url, {}, "", post.wait_s});
    if (!answer) return answer.error();
    const Json read = Json::parse(answer->body, nullptr, false);
    if (answer->status != 200 || !read.is_object() || !read.contains("auth-token") ||
        !read["auth-token"].is_string()) {
      const std::string why =
          read.is_object() && read.contains("error-text") && read["error-text"].is_string()
              ? read["error-text"].get<std::string>()
              : std::to_string(answer->status);
      return error(Trouble::io,
                   fmt::format("cmi5: the learning management system gives no token ({}); start "
                               "the unit there again",
                               base::printable(why, 200)));
    }
    std::string& token = post.token = read["auth-token"];
    if (std::any_of(token.begin(), token.end(),
                    [](char c) { return static_cast<unsigned char>(c) <= 0x20 || c == 0x7f; }))
      return error(Trouble::io, "cmi5: the token cannot be used");
    return fine();
  }

  [[nodiscard]] Status read_launch_data() {
    const std::string who = "agent=" + net::escaped(actor.dump());
    const auto state =
        ask("GET",
            "/activities/state?stateId=LMS.LaunchData&activityId=" + net::escaped(activity) +
                "&registration=" + registration + "&" + who,
            "");
    if (!state) return state.error();
    const Json read = Json::parse(state->body, nullptr, false);
    if (state->status != 200 || !read.is_object()) return refuses("LMS.LaunchData", *state);
    if (const auto found = read.find("contextTemplate"); found != read.end() && found->is_object())
      context = *found;
    else
      return error(Trouble::data, "cmi5: LMS.LaunchData has no contextTemplate");
    const Json::json_pointer session(Json::json_pointer("/extensions") / std::string(kSession));
    if (!context.contains(session) || !context[session].is_string())
      return error(Trouble::data, "cmi5: LMS.LaunchData has no session id");
    normal = read.value("launchMode", Json("Normal")) == "Normal";
    // cmi5 asks for it; burr's language is set in burr
    const auto preferences =
        ask("GET", "/agents/profile?profileId=cmi5LearnerPreferences&" + who, "");
    if (!preferences) return preferences.error();
    if (preferences->status != 200 && preferences->status != 404 && preferences->status != 403)
      return refuses("cmi5LearnerPreferences", *preferences);
    return fine();
  }
};

Launch::Launch(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Launch::~Launch() = default;

Result<std::unique_ptr<Launch>> Launch::begin(const std::string& url, double wait_s) {
  auto parts = std::make_unique<Parts>();
  auto query = query_of(url);
  for (const char* name : {"endpoint", "fetch", "actor", "registration", "activityId"})
    if (query[name].empty())
      return error(
          Trouble::usage,
          fmt::format("cmi5: {} is missing in the address; copy it whole, in quotes", name));
  std::string& endpoint = parts->post.endpoint = query["endpoint"];
  while (!endpoint.empty() && endpoint.back() == '/') endpoint.pop_back();
  parts->registration = query["registration"];
  parts->activity = query["activityId"];
  parts->actor = Json::parse(query["actor"], nullptr, false);
  parts->post.wait_s = wait_s;
  if (!parts->actor.is_object() || !parts->actor.contains("account"))
    return error(Trouble::usage, "cmi5: actor is no account of a learner");
  if (!is_uuid(parts->registration)) return error(Trouble::usage, "cmi5: registration is no UUID");
  for (const std::string& one : {endpoint, query["fetch"]})
    if (const auto good = net::parse_url(one); !good)
      return error(Trouble::usage, "cmi5: " + good.error().text);
  if (const Status done = parts->fetch(query["fetch"]); !done) return done.error();
  if (const Status done = parts->read_launch_data(); !done) return done.error();
  const Status begun =
      parts->post.tell(parts->statement("initialized", nullptr, false), after(20)).status;
  if (!begun) return begun.error();
  return std::unique_ptr<Launch>(new Launch(std::move(parts)));
}

bool Launch::counts() const { return parts_->normal; }

Result<std::string> Launch::end(double seconds, bool finished, const fs::path& wait_in,
                                double patience_s) {
  const std::string took = school::iso_duration(seconds);
  Json all = Json::array();
  if (finished && parts_->normal)
    all.push_back(parts_->statement("completed", {{"completion", true}, {"duration", took}}, true));
  // said in any case, so that the system lets the learner begin anew
  all.push_back(parts_->statement("terminated", {{"duration", took}}, false));
  const Clock::time_point until = after(patience_s);
  Status refused = fine();
  while (!all.empty()) {
    const Post::Heard heard = parts_->post.tell(all.front(), until);
    if (!heard.answered) {
      // nothing may come after "terminated", so what is not said waits with all after it
      const Status kept = keep(wait_in, parts_->post, all);
      if (!kept) return error(Trouble::io, heard.status.error().text + "; " + kept.error().text);
      return heard.status.error().text +
             ". burr tells it later, at its next start by cmi5 or by `lrs::tell_waiting`";
    }
    if (!heard.status && refused) refused = heard.status;
    all.erase(0);
  }
  if (!refused) return refused.error();
  return std::string();
}

ToldLater tell_waiting(const fs::path& folder, double wait_s) {
  ToldLater out;
  std::error_code nobody_asks;
  for (const fs::path& file : waiting_in(folder)) {
    std::ifstream in(file);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    const Json read = Json::parse(text, nullptr, false);
    const bool whole = read.is_object() && read.value("endpoint", Json()).is_string() &&
                       read.value("token", Json()).is_string() &&
                       read.value("statements", Json()).is_array();
    if (!whole || read.value("until_ms", std::int64_t{0}) < school::now_ms()) {
      out.notices.push_back(
          whole ? fmt::format("a learning management system did not answer for {} days; it was not "
                              "told that a session ended",
                              kDaysToWait)
                : "what a learning management system was to be told cannot be read any more");
      fs::remove(file, nobody_asks);
      continue;
    }
    const Post post{read["endpoint"], read["token"], wait_s};
    Post::Heard heard;
    for (const Json& one : read["statements"])
      if (heard = post.tell(one, Clock::now()); !heard.status) break;
    if (!heard.answered) {
      ++out.left;
      continue;
    }
    if (heard.status)
      ++out.launches;
    else
      out.notices.push_back(heard.status.error().text + "; it has ended the session by itself");
    fs::remove(file, nobody_asks);
  }
  return out;
}

std::size_t count_waiting(const fs::path& folder) { return waiting_in(folder).size(); }

}  // namespace burr::lrs
