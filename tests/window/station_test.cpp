// A station on the instructor's page: the server's side, the station's side, and both together over a real connection.
#include "window/station/station_link.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "burr/net/client.h"
#include "burr/net/guard.h"
#include "burr/net/http_server.h"
#include "burr/render/picture.h"
#include "serve/stations.h"
#include "window/mill/instructor_notes.h"

namespace burr::app {
namespace {

using net::Request;
using net::Response;
using Json = nlohmann::json;
using namespace std::chrono_literals;

const std::string kJpeg = "\xFF\xD8\xFF picture";

Request request(const std::string& method, const std::string& target, std::string body = {}) {
  Request out;
  out.method = method;
  EXPECT_TRUE(net::read_target(target, out)) << target;
  out.body = std::move(body);
  return out;
}
Json json_of(const Response& response) { return Json::parse(response.body); }

TEST(Stations, AStationIsSeenUntilItIsSilent) {
  Stations stations;
  const Stations::Clock::time_point start{};
  const auto post = [&](const std::string& more, std::string body, Stations::Clock::time_point at) {
    return stations.answer(request("POST", "/api/station?name=a" + more, std::move(body)), at);
  };
  EXPECT_EQ(post("&learner=heron-1&case=tooth&seconds=3", "", start).status, 200);
  const Json all = json_of(stations.answer(request("GET", "/api/live"), start));
  ASSERT_EQ(all["stations"].size(), 1U);
  EXPECT_EQ(all["stations"][0]["learner"], "heron-1");
  // pictures are wanted only while somebody looks
  EXPECT_EQ(json_of(post("", "", start))["watched"], false);
  const std::string newest = "/api/live/picture?station=a&after=";
  EXPECT_EQ(stations.answer(request("GET", newest + "0"), start).status, 202);
  EXPECT_EQ(json_of(post("&picture=7", kJpeg, start + 1s))["watched"], true);
  const Response picture = stations.answer(request("GET", newest + "6"), start + 1s);
  EXPECT_EQ(picture.type, "image/jpeg");
  EXPECT_EQ(picture.body, kJpeg);
  EXPECT_EQ(stations.answer(request("GET", newest + "7"), start + 1s).status, 202);
  EXPECT_EQ(json_of(post("", "", start + 10s))["watched"], false);
  // silent for half a minute
  EXPECT_EQ(stations.answer(request("GET", newest + "6"), start + 39s).status, 200);
  EXPECT_EQ(stations.answer(request("GET", newest + "6"), start + 41s).status, 404);
  EXPECT_EQ(json_of(stations.answer(request("GET", "/api/live"), start + 41s))["stations"].size(),
            0U);
}

TEST(Stations, AWordComesOnceAndIsSeen) {
  Stations stations;
  const Stations::Clock::time_point now{};
  const auto say = [&](const Json& what) {
    return stations.answer(request("POST", "/api/live/say", what.dump()), now).status;
  };
  EXPECT_EQ(say({{"station", "a"}, {"text", "slower"}}), 404);
  const auto hear = [&](std::uint64_t seen) {
    return json_of(stations.answer(
        request("POST", "/api/station?name=a&seen=" + std::to_string(seen)), now))["messages"];
  };
  EXPECT_TRUE(hear(0).empty());
  EXPECT_EQ(say({{"station", "a"}, {"text", "slow\ner"}}), 200);
  EXPECT_EQ(say({{"station", "a"}, {"mark", {0.25, 1}}, {"picture", 9}}), 200);
  const Json twice = hear(0);
  EXPECT_EQ(twice, hear(0)) << "an answer that got lost comes again";
  ASSERT_EQ(twice.size(), 2U);
  EXPECT_EQ(twice[0]["text"], "slow er");
  EXPECT_EQ(twice[1]["mark"], Json({0.25, 1}));
  EXPECT_EQ(twice[1]["picture"], 9);
  ASSERT_EQ(hear(twice[0]["id"]).size(), 1U);
  EXPECT_TRUE(hear(twice[1]["id"]).empty());
  const Json sent =
      json_of(stations.answer(request("GET", "/api/live"), now))["stations"][0]["messages"];
  EXPECT_EQ(sent[0]["seen"], true);
  for (const Json& odd :
       {Json{{"station", "a"}}, Json{{"station", "a"}, {"text", std::string(201, 'x')}},
        Json{{"station", "a"}, {"mark", {0.5, 1.1}}, {"picture", 1}},
        Json{{"station", "a"}, {"mark", {0.5}}, {"picture", 1}},
        Json{{"station", "a"}, {"mark", {0.5, 0.5}}}, Json{{"station", "a"}, {"text", 5}}, Json(3)})
    EXPECT_EQ(say(odd), 400) << odd;
  // letters, not bytes
  std::string long_word;
  for (int n = 0; n < 200; ++n) long_word += "å";
  EXPECT_EQ(say({{"station", "a"}, {"text", long_word}}), 200);
}

TEST(Stations, WhatIsNoPictureOrTooMuchIsRefused) {
  Stations stations;
  const Stations::Clock::time_point now{};
  EXPECT_EQ(stations.answer(request("POST", "/api/station?name=a", "<svg>"), now).status, 400);
  EXPECT_EQ(stations.answer(request("POST", "/api/station?name="), now).status, 400);
  EXPECT_EQ(
      stations.answer(request("POST", "/api/station?name=" + std::string(41, 'x')), now).status,
      400);
  for (std::size_t n = 0; n < Stations::kMost; ++n)
    EXPECT_EQ(
        stations.answer(request("POST", "/api/station?name=" + std::to_string(n)), now).status,
        200);
  EXPECT_EQ(stations.answer(request("POST", "/api/station?name=more"), now).status, 503);
  EXPECT_EQ(stations.answer(request("POST", "/api/station?name=5"), now).status, 200);
}

TEST(StationLink, APictureIsMadeSmallerByItsMeans) {
  render::Image image{4, 2, {}};
  for (int n = 0; n < 24; ++n) image.rgb.push_back(static_cast<std::uint8_t>(10 * n));
  const render::Image half = smaller(image, 2);
  ASSERT_EQ(half.width, 2);
  ASSERT_EQ(half.height, 1);
  // red of the four pixels at the left: 0, 30, 120, 150
  EXPECT_EQ(half.rgb[0], 75);
  EXPECT_EQ(smaller(image, 4).rgb, image.rgb);
  EXPECT_EQ(smaller(image, 1).width, 2) << "one row cannot be halved";
}

TEST(StationLink, AnAddressThatCannotBeOneIsRefused) {
  for (const char* url : {"school.example", "ftp://school.example", "http://school.example:8231",
                          "https://school.example/page", "https://a:b@school.example"}) {
    const auto link = StationLink::open({url, "t", "a"});
    ASSERT_FALSE(link) << url;
    EXPECT_NE(link.error().text.find("--live"), std::string::npos) << link.error().text;
  }
}

// `burr serve --live`, without a store.
class Server {
 public:
  explicit Server(unsigned short port = 0) {
    net::Door door;
    door.port = port;
    auto opened = net::HttpServer::open(door, [this](const Request& asked) {
      if (auto refusal = net::refused(asked, guard_)) return *refusal;
      return stations_.answer(asked, Stations::Clock::now());
    });
    EXPECT_TRUE(opened) << opened.error().text;
    server_ = std::move(*opened);
    guard_.token = std::string(64, 'a');
    guard_.station_token = std::string(64, 'b');
    guard_.hosts = {"127.0.0.1:" + std::to_string(server_->port())};
    thread_ = std::thread([this] { server_->run(); });
  }
  ~Server() {
    server_->stop();
    thread_.join();
  }
  [[nodiscard]] unsigned short port() const { return server_->port(); }
  [[nodiscard]] std::string url() const { return "http://" + guard_.hosts.front(); }
  [[nodiscard]] std::string token() const { return guard_.station_token; }
  // As the page asks. Only while the link's thread may ask too: both go through the server's one thread.
  [[nodiscard]] Response page(const std::string& method, const std::string& target,
                              const Json& body = {}) {
    net::Question question;
    question.method = method;
    question.url = url() + target;
    question.fields = {{"Authorization", "Bearer " + guard_.token},
                       {"Content-Type", "application/json"}};
    if (!body.is_null()) question.body = body.dump();
    const auto answer = net::ask(question);
    Response out;
    EXPECT_TRUE(answer) << answer.error().text;
    if (!answer) return out;
    out.status = answer->status;
    out.body = answer->body;
    return out;
  }

 private:
  Stations stations_;
  net::Guard guard_;
  std::unique_ptr<net::HttpServer> server_;
  std::thread thread_;
};

template <class Done>
bool soon(const Done& done) {
  for (int n = 0; n < 3000; ++n) {
    if (done()) return true;
    std::this_thread::sleep_for(10ms);
  }
  return false;
}

TEST(StationLink, PicturesGoOutWhileSomebodyLooksAndWordsComeBack) {
  Server server;
  auto link = StationLink::open({server.url(), server.token(), "station å \"4\""});
  ASSERT_TRUE(link) << link.error().text;
  (*link)->is({.learner = "heron-1",
               .work = "tooth",
               .mode = "exam",
               .step = "",
               .seconds = 2,
               .force = 1});
  std::string name;
  ASSERT_TRUE(soon([&] {
    const Json all = json_of(server.page("GET", "/api/live"))["stations"];
    if (all.size() == 1) name = all[0]["name"];
    return !name.empty();
  }));
  EXPECT_EQ(name, "station å \"4\"");
  EXPECT_FALSE((*link)->wants_picture()) << "nobody looks";
  const std::string target = "/api/live/picture?after=0&station=" + net::escaped(name);
  ASSERT_TRUE(soon([&] {
    static_cast<void>(server.page("GET", target));
    return (*link)->wants_picture();
  }));
  render::Image image{1280, 720, std::vector<std::uint8_t>(1280 * 720 * 3, 90)};
  const std::uint64_t number = (*link)->offer(image);
  std::string jpeg;
  ASSERT_TRUE(soon([&] {
    const Response answer = server.page("GET", target);
    jpeg = answer.body;
    return answer.status == 200;
  }));
  EXPECT_EQ(jpeg, render::jpeg_of(smaller(image, StationLink::kWide), 75));
  EXPECT_TRUE(soon([&] {
    static_cast<void>(server.page("GET", target));
    return (*link)->wants_picture();
  })) << "the next one, after this one has arrived";
  EXPECT_EQ(
      server
          .page("POST", "/api/live/say",
                {{"station", name}, {"text", "here"}, {"mark", {0.5, 0.25}}, {"picture", number}})
          .status,
      200);
  std::vector<StationLink::Message> news;
  ASSERT_TRUE(soon([&] {
    news = (*link)->news();
    return !news.empty();
  }));
  ASSERT_EQ(news.size(), 1U);
  EXPECT_EQ(news[0].text, "here");
  EXPECT_EQ(news[0].picture, number);
  ASSERT_TRUE(news[0].mark);
  EXPECT_EQ((*news[0].mark)[1], 0.25);
  std::this_thread::sleep_for(1500ms);
  EXPECT_TRUE((*link)->news().empty()) << "each word comes once";
}

TEST(StationLink, AServerThatIsAwayChangesNothingAndIsFoundAgain) {
  unsigned short port = 0;
  std::unique_ptr<StationLink> link;
  {
    Server server;
    port = server.port();
    auto opened = StationLink::open({server.url(), std::string(64, 'x'), "a"});
    ASSERT_TRUE(opened);
    link = std::move(*opened);
    link->is({});
    ASSERT_TRUE(soon([&] { return link->trouble().find("token") != std::string::npos; }))
        << link->trouble();
    auto right = StationLink::open({server.url(), server.token(), "a"});
    ASSERT_TRUE(right);
    link = std::move(*right);
    link->is({});
    ASSERT_TRUE(
        soon([&] { return json_of(server.page("GET", "/api/live"))["stations"].size() == 1; }));
    EXPECT_EQ(link->trouble(), "");
  }
  ASSERT_TRUE(soon([&] { return !link->trouble().empty(); }));
  EXPECT_FALSE(link->watched());
  Server again(port);
  ASSERT_TRUE(
      soon([&] { return json_of(again.page("GET", "/api/live"))["stations"].size() == 1; }));
  ASSERT_TRUE(soon([&] { return link->trouble().empty(); }));
}

TEST(InstructorNotes, TheOldestGoes) {
  InstructorNotes notes;
  for (int n = 0; n < 7; ++n) notes.say(std::to_string(n));
  notes.mark({0, 0, 0}, "there");
  EXPECT_EQ(notes.texts(), (std::vector<std::string>{"3", "4", "5", "6", "there"}));
  EXPECT_EQ(notes.marks(), 1U);
  notes.close();
  EXPECT_TRUE(notes.empty());
}

}  // namespace
}  // namespace burr::app
