#include "serve/rating_api.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <random>
#include <vector>

#include "burr/base/printable.h"
#include "burr/school/decisions.h"
#include "burr/school/ratings.h"
#include "burr/school/sessions.h"
#include "burr/school/study/raters.h"
#include "burr/school/study/reliability.h"
#include "burr/school/study_tables.h"
#include "burr/school/uuid.h"
#include "school/agreement.h"
#include "school/products.h"
#include "serve/school_api.h"
#include "shared/json_line.h"

namespace burr::app {
namespace {

using Json = nlohmann::ordered_json;
using net::Request;
using net::Response;
namespace study = school::study;

constexpr std::size_t kMostMarks = 200;

Response json_answer(const Json& content) {
  Response out;
  out.body = json_line(content);
  return out;
}

Response refused_by(const Error& why) {
  return net::refusal(why.trouble == Trouble::usage ? 400
                      : why.trouble == Trouble::io  ? 503
                                                    : 500,
                      why.text);
}

// A mark must come with the field Origin. Where it is there, net::refused() has checked that it names this server.
bool says_its_page(const Request& request) { return !request.field("origin").empty(); }

std::string text_in(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

Json figure(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }
Json ends(const study::Interval& of) { return {of.low, of.high}; }

// ---- agreement

Json raters_json(const study::RaterStudy& of) {
  Json out = {{"raters", of.raters},    {"complete", of.complete},
              {"icc", figure(of.icc)},  {"ask_a_person", of.ask_a_person},
              {"pairs", Json::array()}, {"apart", Json::array()}};
  for (const study::ItemAgreement& one : of.pairs) {
    const study::Agreement& f = one.figures;
    out["pairs"].push_back({{"item", one.item},
                            {"first", one.first},
                            {"second", one.second},
                            {"products", f.products},
                            {"agreement", f.agreement},
                            {"kappa", figure(f.kappa)},
                            {"kappa_95", ends(f.kappa_95)},
                            {"ac1", f.ac1},
                            {"prevalence", f.prevalence_index}});
  }
  for (const study::TotalsApart& one : of.apart)
    out["apart"].push_back({{"first", one.first},
                            {"second", one.second},
                            {"mean", one.figures.mean},
                            {"limits", ends(one.figures.limits)}});
  return out;
}

// How many products two raters, or a rater and the machine, have in common at most; for "n of 10".
std::int64_t products_in(const std::vector<study::Rating>& ratings) {
  std::map<std::string, std::vector<std::string>> raters;
  for (const study::Rating& one : ratings) {
    std::vector<std::string>& of = raters[one.product];
    if (std::find(of.begin(), of.end(), one.rater) == of.end()) of.push_back(one.rater);
  }
  return std::count_if(raters.begin(), raters.end(),
                       [](const auto& one) { return one.second.size() > 1; });
}

Result<Json> raters_of(school::Store& store, const std::string& rubric_hash) {
  Json out = {{"needed", study::kFewestProducts}, {"products", 0}, {"figures", nullptr}};
  const auto table = school::ratings_table(store, rubric_hash);
  if (!table) {
    if (table.error().trouble == Trouble::usage) return out;  // nobody has marked anything yet
    return table.error();
  }
  const auto ratings = ratings_of(*table);
  if (!ratings) return ratings.error();
  out["products"] = products_in(*ratings);
  if (const auto found = study::study_raters(*ratings)) out["figures"] = raters_json(*found);
  return out;
}

Result<Json> reliability_of(school::Store& store, const std::string& rubric_hash,
                            const std::string& part) {
  Json out = {{"part", part},
              {"needed", school::kNeeded},
              {"fewest", school::kFewestPeople},
              {"people", 0},
              {"figures", nullptr}};
  const auto full = school::marks_table(store, rubric_hash, part);
  if (!full) {
    if (full.error().trouble == Trouble::usage) return out;
    return full.error();
  }
  const auto table = study::parse_table(school::csv_of(*full), full->file, {"learner", "mark"},
                                        {"bone", "guided"});
  if (!table) return table.error();
  const auto marks = marks_of(*table);
  if (!marks) return marks.error();
  const auto used = study::balance(*marks, static_cast<int>(school::kNeeded), false);
  if (!used) return out;
  out["people"] = used->persons.size();
  if (static_cast<std::int64_t>(used->persons.size()) < school::kFewestPeople) return out;
  const study::Reliability found = study::reliability(*used);
  Json rows = Json::array();
  for (const int n : {1, 2, 3, 5, 8, 12})
    rows.push_back({{"marks", n},
                    {"g", found.g(n)},
                    {"phi", found.phi(n)},
                    {"error", found.standard_error(n)}});
  const auto enough = found.enough();
  out["figures"] = {{"of", rows},
                    {"g_95", ends(study::interval_of_g(*used, static_cast<int>(school::kNeeded)))},
                    {"enough", enough ? Json(*enough) : Json(nullptr)}};
  return out;
}

Json standard_json(const school::Standard& one) {
  const auto whole_or_null = [](const std::optional<std::int64_t>& value) {
    return value ? Json(*value) : Json(nullptr);
  };
  return {{"id", one.id},
          {"rubric", one.rubric},
          {"part", one.part},
          {"method", one.method},
          {"cut", one.cut},
          {"n_low", whole_or_null(one.n_low)},
          {"n_high", whole_or_null(one.n_high)},
          {"judges", whole_or_null(one.judges)},
          {"false_pass", figure(one.false_pass)},
          {"false_fail", figure(one.false_fail)},
          {"text", one.text},
          {"set_by", one.set_by},
          {"made_ms", one.made_ms}};
}

}  // namespace

RatingDesk::RatingDesk(school::Store& store)
    : store_(store), seed_((std::uint64_t{std::random_device()()} << 32) | std::random_device()()) {
  setenv("BURR_STORE", store.place().address.c_str(), 1);
}

std::string RatingDesk::code_for(const Ticket& ticket) {
  std::string& code = codes_[{ticket.rater, ticket.session}];
  if (code.empty()) code = school::uuid_at_random();
  tickets_[code] = ticket;
  return code;
}

// The next product of a rater's queue whose recording is on this computer; the one after it is drawn meanwhile.
Response RatingDesk::next(const Request& request) {
  const Json asked = Json::parse(request.body, nullptr, false);
  if (!asked.is_object()) return net::refusal(400, "give a rater");
  const std::string rater = text_in(asked, "rater");
  if (const Status good = school::check_name("the rater", rater); !good)
    return refused_by(good.error());
  const auto queue = products_here(store_, rater, text_in(asked, "rubric"), seed_);
  if (!queue) return refused_by(queue.error());
  const std::vector<school::Product>& here = queue->here;
  const auto all = school::rubrics(store_);
  if (!all) return refused_by(all.error());
  Json out = {{"left", here.size()},
              {"elsewhere", queue->elsewhere},
              {"read_only", store_.reads_only()},
              {"rubrics", Json::array()},
              {"code", nullptr}};
  for (const school::RubricRow& one : *all)
    out["rubrics"].push_back({{"hash", one.hash}, {"name", one.name}, {"version", one.version}});
  if (here.empty()) return json_answer(out);
  out["code"] = code_for({rater, here[0].session, here[0].rubric_hash, here[0].case_name});
  pictures_.want(here[0].session);
  if (here.size() > 1) pictures_.want(here[1].session, false);
  return json_answer(out);
}

Response RatingDesk::product(const Request& request) {
  const auto found = tickets_.find(request.asked("code"));
  if (found == tickets_.end()) return net::refusal(404, "there is no such product to mark");
  const Ticket& ticket = found->second;
  const auto items = product_items(store_, ticket.session, ticket.rubric_hash);
  if (!items) return refused_by(items.error());
  pictures_.want(ticket.session);
  const ProductPictures* drawn = pictures_.of(ticket.session);
  Json out = {{"case", ticket.case_name},
              {"drawing", drawn == nullptr},
              {"trouble", drawn != nullptr ? drawn->trouble : std::string()},
              {"pictures", Json::array()},
              {"items", Json::array()}};
  for (const ProductItem& one : *items) out["items"].push_back({{"id", one.id}, {"say", one.say}});
  if (drawn != nullptr)
    for (const ProductPicture& one : drawn->pictures)
      out["pictures"].push_back({{"name", one.name},
                                 {"wide_mm", one.wide_mm},
                                 {"width", one.width},
                                 {"height", one.height}});
  return json_answer(out);
}

Response RatingDesk::picture(const Request& request) {
  const auto found = tickets_.find(request.asked("code"));
  const ProductPictures* drawn =
      found == tickets_.end() ? nullptr : pictures_.of(found->second.session);
  if (drawn != nullptr)
    for (const ProductPicture& one : drawn->pictures)
      if (one.name == request.asked("name")) {
        Response out;
        out.type = "image/png";
        out.body = one.png;
        return out;
      }
  return net::refusal(404, "there is no such picture");
}

Response RatingDesk::take_marks(const Request& request) {
  const Json given = Json::parse(request.body, nullptr, false);
  const auto marks = given.is_object() ? given.find("marks") : given.end();
  if (!given.is_object() || marks == given.end() || !marks->is_array() ||
      marks->size() > kMostMarks)
    return net::refusal(400, "give rater, code and marks");
  const auto found = tickets_.find(text_in(given, "code"));
  if (found == tickets_.end() || found->second.rater != text_in(given, "rater"))
    return net::refusal(404, "there is no such product to mark");
  school::Marking marking{found->second.session, found->second.rater, true, {}};
  for (const Json& one : *marks) {
    if (!one.is_object()) return net::refusal(400, "a mark has an item, a mark and a reason");
    marking.marks.push_back({text_in(one, "item"), text_in(one, "mark"), text_in(one, "reason")});
  }
  if (const Status kept = school::mark(store_, marking); !kept) return refused_by(kept.error());
  return json_answer({{"kept", marking.marks.size()}});
}

Response RatingDesk::agreement(const Request& request) {
  const auto all = school::rubrics(store_);
  if (!all) return refused_by(all.error());
  Json out = {{"rubrics", Json::array()}, {"rubric", nullptr}};
  const std::string wanted = request.asked("rubric");
  const school::RubricRow* rubric = nullptr;
  for (const school::RubricRow& one : *all) {
    out["rubrics"].push_back({{"hash", one.hash}, {"name", one.name}, {"version", one.version}});
    if (rubric == nullptr && (wanted.empty() || wanted == one.hash)) rubric = &one;
  }
  if (rubric == nullptr)
    return wanted.empty() ? json_answer(out) : net::refusal(404, "the store has no such rubric");
  // thousands of samples: made again only where the store has changed
  const auto state = store_.database().rows(
      "SELECT (SELECT count(*) FROM rater_mark), (SELECT max(made_ms) FROM rater_mark), "
      "(SELECT count(*) FROM score), (SELECT max(made_ms) FROM score), "
      "(SELECT count(*) FROM rater_mark WHERE rater_id = 'forgotten') FROM schema_version LIMIT 1");
  if (!state) return refused_by(state.error());
  std::string now = rubric->hash;
  if (!state->empty())
    for (const school::Value& one : state->front()) now += " " + school::written(one);
  if (now != agreement_of_) {
    auto raters = raters_of(store_, rubric->hash);
    if (!raters) return refused_by(raters.error());
    auto words = words_of(store_, rubric->hash);
    Json say = Json::object();
    for (const auto& [id, texts] : words) say[id] = texts;
    out["rubric"] = rubric->hash;
    out["say"] = std::move(say);
    out["raters"] = std::move(*raters);
    out["reliability"] = Json::array();
    for (const char* part : {"product", "process"}) {
      auto one = reliability_of(store_, rubric->hash, part);
      if (!one) return refused_by(one.error());
      out["reliability"].push_back(std::move(*one));
    }
    agreement_json_ = json_line(out);
    agreement_of_ = now;
  }
  Response response;
  response.body = agreement_json_;
  return response;
}

Response RatingDesk::standards() {
  const auto all = school::standards(store_);
  if (!all) return refused_by(all.error());
  const auto decided = school::decisions(store_);
  if (!decided) return refused_by(decided.error());
  Json out = {{"needed", school::kNeeded}, {"standards", Json::array()}};
  for (const school::Standard& one : *all) {
    const auto said = school::proposals(store_, one);
    if (!said) return refused_by(said.error());
    std::map<std::string, const school::Decision*> last;
    for (const school::Decision& decision : *decided)
      if (decision.standard == one.id) last[decision.learner] = &decision;
    Json row = standard_json(one);
    row["learners"] = Json::array();
    for (const auto& [learner, proposal] : *said) {
      const school::Decision* decision = last[learner];
      row["learners"].push_back(
          {{"learner", learner},
           {"sessions", proposal.sessions.size()},
           {"reached", proposal.reached},
           {"first", proposal.first + 1},
           {"outcome", decision != nullptr ? Json(decision->outcome) : Json(nullptr)},
           {"confirmed_by", decision != nullptr ? Json(decision->confirmed_by) : Json(nullptr)},
           {"decided_ms", decision != nullptr ? Json(decision->made_ms) : Json(nullptr)}});
    }
    out["standards"].push_back(std::move(row));
  }
  return json_answer(out);
}

std::optional<Response> RatingDesk::answer(const Request& request) {
  const bool post = request.method == "POST";
  if (request.path == "/api/rating/next" || request.path == "/api/rating/marks") {
    if (!post) return net::refusal(405, "this must be posted");
    if (!says_its_page(request))
      return net::refusal(403, "a change must say from which page it comes");
    return request.path == "/api/rating/next" ? next(request) : take_marks(request);
  }
  if (post) return std::nullopt;
  if (request.path == "/api/rating/product") return product(request);
  if (request.path == "/api/rating/picture") return picture(request);
  if (request.path == "/api/agreement") return agreement(request);
  if (request.path == "/api/standards") return standards();
  return std::nullopt;
}

}  // namespace burr::app
