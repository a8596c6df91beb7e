#include "burr/lrs/launch.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "burr/base/printable.h"
#include "burr/http/client.h"
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
    out[one.substr(0, equals)] = http::unescaped(one.substr(std::min(equals + 1, one.size())));
    at = end < url.size() && url[end] == '&' ? end : std::string::npos;
  }
  return out;
}

bool is_uuid(const std::string& text) {
  return text.size() == 36 && text[8] == '-' && text[13] == '-' && text[18] == '-' &&
         text[23] == '-' && text.find_first_not_of("0123456789abcdefABCDEF-") == std::string::npos;
}

Error refuses(const char* what, const http::Answer& answer) {
  return error(Trouble::io, fmt::format("--cmi5: {}: the learning management system answers {}: {}",
                                        what, answer.status, base::printable(answer.body, 200)));
}

}  // namespace

struct Launch::Parts {
  std::string endpoint, registration, activity, token;
  Json actor, context;
  bool normal = true;
  double wait_s = 15;
  std::int64_t last_ms = 0;

  [[nodiscard]] Result<http::Answer> ask(const char* method, const std::string& path,
                                         const std::string& body) const {
    return http::ask({method,
                      endpoint + path,
                      {{"Authorization", "Basic " + token},
                       {"X-Experience-API-Version", "1.0.3"},
                       {"Content-Type", "application/json"}},
                      body,
                      wait_s});
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

  // The id stays the same, so trying again does no harm.
  [[nodiscard]] Status tell(const Json& one, double patience_s) const {
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
    const std::string path = "/statements?statementId=" + one["id"].get<std::string>();
    for (std::chrono::milliseconds pause(500);; pause *= 2) {
      const auto answer = ask("PUT", path, one.dump());
      // 409: it has it from a try whose answer was lost
      if (answer && (answer->status == 204 || answer->status == 200 || answer->status == 409))
        return fine();
      const bool again = !answer || answer->status == 429 || answer->status >= 500;
      if (!again || std::chrono::steady_clock::now() + pause > until)
        return answer ? refuses("a statement", *answer) : answer.error();
      std::this_thread::sleep_for(pause);
    }
  }

  [[nodiscard]] Status fetch(const std::string& url) {
    const auto answer = http::ask({"POST", url, {}, "", wait_s});
    if (!answer) return answer.error();
    const Json read = Json::parse(answer->body, nullptr, false);
    if (answer->status != 200 || !read.is_object() || !read.contains("auth-token") ||
        !read["auth-token"].is_string()) {
      const std::string why =
          read.is_object() && read.contains("error-text") && read["error-text"].is_string()
              ? read["error-text"].get<std::string>()
              : std::to_string(answer->status);
      return error(Trouble::io,
                   fmt::format("--cmi5: the learning management system gives no token ({}); start "
                               "the unit there again",
                               base::printable(why, 200)));
    }
    token = read["auth-token"];
    if (std::any_of(token.begin(), token.end(),
                    [](char c) { return static_cast<unsigned char>(c) <= 0x20 || c == 0x7f; }))
      return error(Trouble::io, "--cmi5: the token cannot be used");
    return fine();
  }

  [[nodiscard]] Status read_launch_data() {
    const std::string who = "agent=" + http::escaped(actor.dump());
    const auto state =
        ask("GET",
            "/activities/state?stateId=LMS.LaunchData&activityId=" + http::escaped(activity) +
                "&registration=" + registration + "&" + who,
            "");
    if (!state) return state.error();
    const Json read = Json::parse(state->body, nullptr, false);
    if (state->status != 200 || !read.is_object()) return refuses("LMS.LaunchData", *state);
    if (const auto found = read.find("contextTemplate"); found != read.end() && found->is_object())
      context = *found;
    else
      return error(Trouble::data, "--cmi5: LMS.LaunchData has no contextTemplate");
    const Json::json_pointer session(Json::json_pointer("/extensions") / std::string(kSession));
    if (!context.contains(session) || !context[session].is_string())
      return error(Trouble::data, "--cmi5: LMS.LaunchData has no session id");
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
          fmt::format("--cmi5: {} is missing in the address; copy it whole, in quotes", name));
  parts->endpoint = query["endpoint"];
  while (!parts->endpoint.empty() && parts->endpoint.back() == '/') parts->endpoint.pop_back();
  parts->registration = query["registration"];
  parts->activity = query["activityId"];
  parts->actor = Json::parse(query["actor"], nullptr, false);
  parts->wait_s = wait_s;
  if (!parts->actor.is_object() || !parts->actor.contains("account"))
    return error(Trouble::usage, "--cmi5: actor is no account of a learner");
  if (!is_uuid(parts->registration))
    return error(Trouble::usage, "--cmi5: registration is no UUID");
  for (const std::string& one : {parts->endpoint, query["fetch"]})
    if (const auto good = http::parse_url(one); !good)
      return error(Trouble::usage, "--cmi5: " + good.error().text);
  if (const Status done = parts->fetch(query["fetch"]); !done) return done.error();
  if (const Status done = parts->read_launch_data(); !done) return done.error();
  if (const Status done = parts->tell(parts->statement("initialized", nullptr, false), 20); !done)
    return done.error();
  return std::unique_ptr<Launch>(new Launch(std::move(parts)));
}

bool Launch::counts() const { return parts_->normal; }

Status Launch::end(double seconds, bool finished, double patience_s) {
  const std::string took = school::iso_duration(seconds);
  Status told = fine();
  if (finished && parts_->normal)
    told = parts_->tell(
        parts_->statement("completed", {{"completion", true}, {"duration", took}}, true),
        patience_s);
  // said in any case, so that the system lets the learner begin anew
  const Status ended =
      parts_->tell(parts_->statement("terminated", {{"duration", took}}, false), patience_s);
  return told ? ended : told;
}

}  // namespace burr::lrs
