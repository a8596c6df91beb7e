// The web server against what browsers, other pages and worse send it, over real sockets.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "burr/net/guard.h"
#include "burr/net/http_server.h"
#include "support/folder.h"

namespace burr::net {
namespace {

constexpr const char* kToken = "0123456789abcdef0123456789abcdef";

// A server as `burr serve` has it: guarded, with one page and one answer.
class Running {
 public:
  explicit Running(Door door = {}) {
    door.wait_s = 1;
    auto opened = HttpServer::open(door, [this](const Request& request) {
      if (auto refusal = refused(request, guard_)) return *refusal;
      ++answered;
      if (request.path == "/api/throws") throw std::runtime_error("odd content");
      Response out;
      out.body =
          request.path == "/api/echo" ? request.body : request.path + " " + request.asked("q");
      return out;
    });
    if (!opened) {
      trouble = opened.error().text;
      return;
    }
    server_ = std::move(*opened);
    port = server_->port();
    guard_.hosts = {"127.0.0.1:" + std::to_string(port), "localhost:" + std::to_string(port)};
    guard_.tls = !door.certificate.empty();
    guard_.token = kToken;
    thread_ = std::thread([this] { server_->run(); });
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (!server_) return;
    server_->stop();
    thread_.join();
  }
  unsigned short port = 0;
  std::atomic<int> answered = 0;
  std::string trouble;

 private:
  Guard guard_;
  std::unique_ptr<HttpServer> server_;
  std::thread thread_;
};

class Wire {
 public:
  explicit Wire(unsigned short port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place = {};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    timeval patience = {20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    open = connect(socket_, reinterpret_cast<sockaddr*>(&place), sizeof place) == 0;
  }
  Wire(const Wire&) = delete;
  Wire& operator=(const Wire&) = delete;
  ~Wire() { close(socket_); }
  void say(const std::string& text) {
    (void)!::send(socket_, text.data(), text.size(), MSG_NOSIGNAL);
  }
  void end() { shutdown(socket_, SHUT_WR); }
  // Until the other end closes; "" at once where it did.
  std::string all() {
    std::string out;
    char some[4096];
    for (ssize_t n = 0; (n = recv(socket_, some, sizeof some, 0)) > 0;)
      out.append(some, static_cast<std::size_t>(n));
    return out;
  }
  bool open = false;

 private:
  int socket_;
};

std::string head(unsigned short port, const std::string& first, const std::string& more = "",
                 bool token = true) {
  return first + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
         "\r\nConnection: close\r\n" +
         (token ? std::string("Authorization: Bearer ") + kToken + "\r\n" : "") + more + "\r\n";
}

std::string answer(unsigned short port, const std::string& text) {
  Wire wire(port);
  wire.say(text);
  return wire.all();
}

int status(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? std::atoi(answer.c_str() + 9) : 0;
}

TEST(Serve, AnswersItsOwnPage) {
  Running server;
  ASSERT_EQ(server.trouble, "");
  const std::string got = answer(server.port, head(server.port, "GET /api/learner?q=heron%2D1+x"));
  EXPECT_EQ(status(got), 200) << got;
  EXPECT_NE(got.find("\r\n\r\n/api/learner heron-1 x"), std::string::npos) << got;
  for (const char* fence :
       {"Content-Security-Policy: default-src 'none'", "X-Content-Type-Options: nosniff",
        "Referrer-Policy: no-referrer", "Cache-Control: no-store", "frame-ancestors 'none'"})
    EXPECT_NE(got.find(fence), std::string::npos) << fence;
  EXPECT_EQ(got.find("Access-Control"), std::string::npos);  // no other page may read it
  const std::string only_head = answer(server.port, head(server.port, "HEAD /api/learner?q=x"));
  EXPECT_EQ(status(only_head), 200);
  EXPECT_TRUE(only_head.ends_with("\r\n\r\n"));
  const std::string post =
      answer(server.port, head(server.port, "POST /api/echo",
                               "Content-Type: application/json\r\nContent-Length: 2\r\n") +
                              "{}");
  EXPECT_TRUE(post.ends_with("{}")) << post;
}

TEST(Serve, AnAnswerThatThrowsDoesNotEndIt) {
  Running server;
  const std::string got = answer(server.port, head(server.port, "GET /api/throws"));
  EXPECT_EQ(status(got), 500) << got;
  EXPECT_EQ(got.find("odd content"), std::string::npos);  // for the terminal alone
  EXPECT_EQ(status(answer(server.port, head(server.port, "GET /"))), 200);
}

TEST(Serve, TwoRequestsOnOneConnection) {
  Running server;
  Wire wire(server.port);
  const std::string host = "Host: 127.0.0.1:" + std::to_string(server.port) + "\r\n";
  wire.say("GET /a HTTP/1.1\r\n" + host + "\r\nGET /b HTTP/1.1\r\n" + host +
           "Connection: close\r\n\r\n");
  const std::string got = wire.all();
  EXPECT_NE(got.find("/a "), std::string::npos) << got;
  EXPECT_NE(got.find("/b "), std::string::npos) << got;
}

TEST(Serve, RefusesOthers) {
  Running server;
  const std::string port = std::to_string(server.port);
  const std::string own = "Origin: http://127.0.0.1:" + port + "\r\n",
                    json = "Content-Type: application/json\r\n";
  struct {
    const char* what;
    std::string text;
    int status;
  } const attacks[] = {
      {"no token", head(server.port, "GET /api/learner", "", false), 401},
      {"a wrong token",
       head(server.port, "GET /api/learner",
            "Authorization: Bearer 0123456789abcdef0123456789abcdee\r\n", false),
       401},
      {"a shorter token",
       head(server.port, "GET /api/learner", "Authorization: Bearer 0123456789abcdef\r\n", false),
       401},
      {"an empty token", head(server.port, "GET /api/learner", "Authorization: Bearer \r\n", false),
       401},
      {"the token in the address",
       head(server.port, std::string("GET /api/learner?token=") + kToken, "", false), 401},
      {"the token as a cookie",
       head(server.port, "GET /api/learner", std::string("Cookie: token=") + kToken + "\r\n",
            false),
       401},
      {"a name that was made to point here",
       "GET /api/x HTTP/1.1\r\nHost: evil.example:" + port + "\r\nConnection: close\r\n\r\n", 421},
      {"another port", "GET / HTTP/1.1\r\nHost: 127.0.0.1:1\r\nConnection: close\r\n\r\n", 421},
      {"no host", "GET / HTTP/1.1\r\nConnection: close\r\n\r\n", 421},
      {"another page", head(server.port, "GET /api/learner", "Origin: http://evil.example\r\n"),
       403},
      {"a page of another port",
       head(server.port, "GET /api/learner", "Origin: http://127.0.0.1:1\r\n"), 403},
      {"a page without a name", head(server.port, "GET /api/learner", "Origin: null\r\n"), 403},
      {"another site", head(server.port, "GET /api/learner", "Sec-Fetch-Site: cross-site\r\n"),
       403},
      {"another server of this computer",
       head(server.port, "GET /", "Sec-Fetch-Site: same-site\r\n"), 403},
      {"a form",
       head(server.port, "POST /api/echo",
            own + "Content-Type: text/plain\r\nContent-Length: 2\r\n") +
           "{}",
       415},
      {"a post to a page", head(server.port, "POST /", own + json + "Content-Length: 2\r\n") + "{}",
       405},
      {"PUT", head(server.port, "PUT /api/x"), 405},
      {"TRACE", head(server.port, "TRACE /"), 405},
      {"OPTIONS", head(server.port, "OPTIONS /api/x", own), 405},
      {"CONNECT", head(server.port, "CONNECT evil.example:80"), 400},
      {"a path upwards", head(server.port, "GET /../../etc/passwd"), 400},
      {"the same, hidden", head(server.port, "GET /%2e%2e/%2e%2e/etc/passwd"), 400},
      {"the same, hidden twice", head(server.port, "GET /..%252f..%252fetc/passwd"), 400},
      {"a path of another system", head(server.port, "GET /..%5c..%5cwindows"), 400},
      {"an end inside of the path", head(server.port, "GET /api/x%00.css"), 400},
      {"a line end inside of the path", head(server.port, "GET /api/x%0d%0aSet-Cookie:%20a=b"),
       400},
      {"a torn escape", head(server.port, "GET /api/x%4"), 400},
      {"a whole address", head(server.port, "GET http://evil.example/api/x"), 400},
      {"the length twice",
       head(server.port, "POST /api/echo", json + "Content-Length: 2\r\nContent-Length: 3\r\n") +
           "{}",
       400},
      {"the host twice", head(server.port, "GET /", "Host: evil.example\r\n"), 400},
      {"two ways to say the length",
       head(server.port, "POST /api/echo",
            json + "Content-Length: 2\r\nTransfer-Encoding: chunked\r\n") +
           "0\r\n\r\n",
       400},
      {"a long path", head(server.port, "GET /" + std::string(5000, 'a')), 400},
      {"a long head", head(server.port, "GET /", "X: " + std::string(40000, 'a') + "\r\n"), 431},
      {"a large body",
       head(server.port, "POST /api/echo", json + "Content-Length: 1000000\r\n") +
           std::string(70000, ' '),
       413},
      {"a large body in pieces",
       head(server.port, "POST /api/echo", json + "Transfer-Encoding: chunked\r\n") + "20000\r\n" +
           std::string(0x20000, ' '),
       413},
      {"another protocol", "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03 hello\r\n\r\n", 400},
      {"HTTP 0.9", "GET /\r\n\r\n", 400},
  };
  for (const auto& attack : attacks) {
    const int before = server.answered;
    const std::string got = answer(server.port, attack.text);
    // a large body may be cut off before the answer arrives
    const bool cut = attack.status == 413 && got.empty();
    EXPECT_TRUE(status(got) == attack.status || cut) << attack.what << ": " << got;
    EXPECT_EQ(server.answered, before) << attack.what;
  }
  EXPECT_EQ(status(answer(server.port, head(server.port, "GET /api/x", own))),
            200);  // and it still answers
}

TEST(Serve, TornAndSlowOnesAreDroppedAndOthersServed) {
  Running server;
  std::vector<std::unique_ptr<Wire>> slow;
  for (int n = 0; n < 60; ++n) {
    slow.push_back(std::make_unique<Wire>(server.port));
    slow.back()->say(n % 2 == 0 ? "GET /api/learn"
                                : "POST /api/echo HTTP/1.1\r\nContent-Length: 100\r\n\r\n{");
  }
  slow.push_back(std::make_unique<Wire>(server.port));
  slow.back()->say(head(server.port, "POST /api/echo", "Content-Length: 100\r\n") + "half");
  slow.back()->end();
  slow.back()->all();
  EXPECT_EQ(status(answer(server.port, head(server.port, "GET /"))), 200);
  for (const auto& wire : slow)
    wire->all();  // each ends; without a limit of time this would wait for ever
  EXPECT_EQ(server.answered, 1);
  EXPECT_EQ(status(answer(server.port, head(server.port, "GET /"))), 200);
}

TEST(Serve, ManyConnectionsLeaveRoom) {
  Running server;
  std::vector<std::unique_ptr<Wire>> all;
  for (int n = 0; n < 300; ++n) all.push_back(std::make_unique<Wire>(server.port));
  all.clear();
  for (int n = 0; n < 40; ++n) {  // the server hears of the ends soon
    if (status(answer(server.port, head(server.port, "GET /"))) == 200) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  FAIL() << "the server does not answer any more";
}

TEST(Serve, RandomBytesDoNoHarm) {
  Running server;
  const unsigned seed = std::random_device()();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const std::string good = head(server.port, "POST /api/echo?q=1",
                                "Content-Type: application/json\r\nContent-Length: 2\r\n") +
                           "{}";
  for (int n = 0; n < 300; ++n) {
    std::string bad = good;
    for (unsigned k = 0; k <= random() % 5; ++k)
      bad[random() % bad.size()] = static_cast<char>(random());
    Wire wire(server.port);
    wire.say(bad.substr(0, random() % (bad.size() + 1)));
    wire.end();
    wire.all();
  }
  EXPECT_EQ(status(answer(server.port, head(server.port, "GET /"))), 200);
}

TEST(Serve, TokensAreLongAndKeptForTheirOwner) {
  const auto a = new_token(), b = new_token();
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->size(), 64U);
  EXPECT_NE(*a, *b);
  const test::Folder folder;
  const std::string file = (folder.path() / "token").string();
  std::ofstream(file) << kToken << "\n";
  chmod(file.c_str(), 0644);
  EXPECT_EQ(token_from(file).error().text,
            "token: other users may read the token; run: chmod 600 token");
  chmod(file.c_str(), 0600);
  EXPECT_EQ(*token_from(file), kToken);
  for (const char* bad :
       {"short", "0123456789abcdef0123456789abcde&", "0123456789abcdef0123456789abcde%"}) {
    std::ofstream(file) << bad;
    EXPECT_FALSE(token_from(file).ok()) << bad;
  }
}

// A station's token posts pictures to one address; the page's token does not, and neither reads with the other's.
TEST(Serve, AStationsTokenReadsNothing) {
  Guard guard;
  guard.hosts = {"127.0.0.1:1"};
  guard.token = std::string(64, 'a');
  const auto asked = [&](const std::string& method, const std::string& path, char token,
                         const std::string& type) {
    Request request;
    request.method = method;
    request.path = path;
    request.fields = {{"host", "127.0.0.1:1"},
                      {"authorization", "Bearer " + std::string(64, token)},
                      {"content-type", type}};
    const auto refusal = refused(request, guard);
    return refusal ? refusal->status : 200;
  };
  EXPECT_EQ(asked("POST", kStationPath, 'b', "image/jpeg"), 404) << "no stations are taken";
  guard.station_token = std::string(64, 'b');
  EXPECT_EQ(asked("POST", kStationPath, 'b', "image/jpeg"), 200);
  EXPECT_EQ(asked("POST", kStationPath, 'a', "image/jpeg"), 401);
  EXPECT_EQ(asked("GET", kStationPath, 'b', "image/jpeg"), 405);
  EXPECT_EQ(asked("POST", kStationPath, 'b', "text/plain"), 415) << "a form of another page";
  for (const char* path : {"/api/overview", "/api/live", "/api/station/", "/api/replay"})
    EXPECT_EQ(asked("GET", path, 'b', ""), 401) << path;
  EXPECT_EQ(asked("GET", "/api/live", 'a', ""), 200);
  EXPECT_EQ(asked("POST", "/api/live/say", 'a', "application/json"), 200);
  EXPECT_EQ(asked("POST", "/api/live/say", 'a', "image/jpeg"), 415);
}

TEST(Serve, SaysWhyItCannotOpen) {
  Running first;
  Door door;
  door.port = first.port;
  EXPECT_NE(Running(door).trouble.find("Address already in use"), std::string::npos);
  door.address = "example";
  EXPECT_EQ(Running(door).trouble, "`address`: \"example\" is not an IP address");
  door = {};
  door.certificate = "a.pem";
  EXPECT_EQ(Running(door).trouble, "`certificate` and `key` belong together; give both");
  door.key = "a.pem";
  EXPECT_NE(Running(door).trouble.find("a.pem: is no certificate in PEM"), std::string::npos);
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_TRUE(is_loopback("::1"));
  EXPECT_FALSE(is_loopback("0.0.0.0"));
  EXPECT_FALSE(is_loopback("192.168.1.1"));
}

TEST(Serve, SpeaksTls) {
  const test::Folder folder;
  const std::string at = folder.path().string();
  ASSERT_EQ(std::system(("openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes "
                         "-days 2 -subj /CN=localhost "
                         "-keyout " +
                         at + "/k.pem -out " + at + "/c.pem > /dev/null 2>&1")
                            .c_str()),
            0)
      << "needs openssl";
  Door door;
  door.certificate = at + "/c.pem";
  door.key = at + "/k.pem";
  Running server(door);
  ASSERT_EQ(server.trouble, "");
  std::ofstream(at + "/ask") << head(server.port, "GET /api/learner?q=7");
  const std::string port = std::to_string(server.port);
  const auto ask = [&](const std::string& how) {
    return std::system(("(cat " + at +
                        "/ask; sleep 1) | openssl s_client -quiet -connect 127.0.0.1:" + port +
                        " -CAfile " + at + "/c.pem " + how + " > " + at + "/got 2> /dev/null")
                           .c_str());
  };
  ASSERT_EQ(ask("-verify_return_error"), 0);
  std::ifstream got(at + "/got");
  std::string first, all;
  std::getline(got, first);
  EXPECT_TRUE(first.starts_with("HTTP/1.1 200")) << first;
  EXPECT_NE(ask("-tls1_1"), 0);                                           // too old
  EXPECT_EQ(status(answer(server.port, head(server.port, "GET /"))), 0);  // not without TLS
  EXPECT_EQ(server.answered, 1);
}

}  // namespace
}  // namespace burr::net
