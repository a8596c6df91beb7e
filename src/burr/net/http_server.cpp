#include "burr/net/http_server.h"

#include <fmt/core.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "burr/net/field_name.h"
#include "burr/net/guard.h"

namespace burr::net {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace asio = boost::asio;
using Tcp = asio::ip::tcp;

constexpr std::uint32_t kLargestHead = 16 << 10;  // [byte]
constexpr std::uint64_t kLargestBody = 64 << 10;  // [byte]
constexpr int kMostConnections = 128;

// What all connections share.
struct Shared {
  Answering answer;
  std::chrono::steady_clock::duration wait;
  int connections = 0;
};

std::string_view view(beast::string_view text) { return {text.data(), text.size()}; }

// One connection; keeps itself alive while it waits.
template <class Stream>
class Connection : public std::enable_shared_from_this<Connection<Stream>> {
 public:
  template <class... More>
  explicit Connection(Tcp::socket&& socket, Shared& shared, More&... more)
      : stream_(std::move(socket), more...), shared_(shared) {
    ++shared_.connections;
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { --shared_.connections; }

  void begin() {
    if constexpr (kTls) {
      wait();
      stream_.async_handshake(asio::ssl::stream_base::server,
                              [self = this->shared_from_this()](beast::error_code trouble) {
                                if (!trouble) self->read();
                              });
    } else {
      read();
    }
  }

 private:
  static constexpr bool kTls = !std::is_same_v<Stream, beast::tcp_stream>;

  void wait() { beast::get_lowest_layer(stream_).expires_after(shared_.wait); }

  void read() {
    parser_.emplace();
    parser_->header_limit(kLargestHead);
    parser_->body_limit(kLargestBody);
    wait();
    http::async_read(stream_, buffer_, *parser_,
                     [self = this->shared_from_this()](beast::error_code trouble, std::size_t) {
                       self->was_read(trouble);
                     });
  }

  void was_read(beast::error_code trouble) {
    if (trouble == http::error::end_of_stream || trouble == beast::error::timeout) return close();
    if (trouble == http::error::body_limit)
      return send(refusal(413, "the request is too large"), true);
    if (trouble == http::error::header_limit)
      return send(refusal(431, "the head of the request is too large"), true);
    if (trouble.category() == http::make_error_code(http::error::bad_method).category())
      return send(refusal(400, "this is no request of HTTP/1.1"), true);
    if (trouble) return;  // the other side is gone
    const auto& message = parser_->get();
    Request request;
    request.method = std::string(view(message.method_string()));
    const bool readable = read_target(view(message.target()), request);
    bool twice = false;
    for (const auto& field : message)
      twice =
          !request.fields
               .emplace(small_letters(view(field.name_string())), std::string(view(field.value())))
               .second ||
          twice;
    request.body = message.body();
    const bool last = !message.keep_alive();
    head_only_ = request.method == "HEAD";
    if (!readable) return send(refusal(400, "this address cannot be read"), true);
    if (twice) return send(refusal(400, "a field of the head is there twice"), true);
    send(answered(request), last);
  }

  // What the answer throws (no memory, odd content of the store) must not end the server.
  Response answered(const Request& request) const {
    try {
      return shared_.answer(request);
    } catch (const std::exception& trouble) {
      fmt::print(stderr, "{} {}: {}\n", request.method, request.path, trouble.what());
      return refusal(500, "burr could not answer; its terminal says why");
    }
  }

  void send(Response response, bool last) {
    add_fences(response);
    message_.emplace(static_cast<http::status>(response.status), 11);
    message_->set(http::field::content_type, response.type);
    for (const auto& [name, value] : response.fields) message_->set(name, value);
    message_->keep_alive(!last);
    const std::size_t size = response.body.size();
    if (!head_only_) message_->body() = std::move(response.body);
    message_->content_length(size);
    head_only_ = false;
    wait();
    auto sent = [self = this->shared_from_this(), last](beast::error_code trouble, std::size_t) {
      if (trouble || last) return self->close();
      self->read();
    };
    serializer_.emplace(*message_);
    http::async_write(stream_, *serializer_, std::move(sent));
  }

  // TLS says that it ends, so the other end knows that nothing was cut off.
  void close() {
    if constexpr (kTls) {
      wait();
      stream_.async_shutdown(
          [self = this->shared_from_this()](beast::error_code) { self->close_socket(); });
    } else {
      close_socket();
    }
  }

  void close_socket() {
    beast::error_code ignored;
    auto& socket = beast::get_lowest_layer(stream_).socket();
    socket.shutdown(Tcp::socket::shutdown_send, ignored);
    socket.close(ignored);
  }

  Stream stream_;
  Shared& shared_;
  beast::flat_buffer buffer_{kLargestHead + kLargestBody};
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::string_body>> message_;
  std::optional<http::response_serializer<http::string_body>> serializer_;
  bool head_only_ = false;
};

class Server final : public HttpServer {
 public:
  Server(Answering answer, double wait_s) {
    shared_.answer = std::move(answer);
    shared_.wait = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(wait_s));
  }
  ~Server() override { context_.stop(); }

  Status listen(const Door& door) {
    beast::error_code trouble;
    const auto address = asio::ip::make_address(door.address, trouble);
    if (trouble)
      return error(Trouble::usage,
                   fmt::format("`address`: \"{}\" is not an IP address", door.address));
    if (!door.certificate.empty())
      if (const Status done = with_tls(door); !done) return done;
    const Tcp::endpoint place(address, door.port);
    acceptor_.open(place.protocol(), trouble);
    if (!trouble) acceptor_.set_option(Tcp::acceptor::reuse_address(true), trouble);
    if (!trouble) acceptor_.bind(place, trouble);
    if (!trouble) acceptor_.listen(Tcp::acceptor::max_listen_connections, trouble);
    if (trouble)
      return error(Trouble::io,
                   fmt::format("{} port {}: {}; choose another with `address` and `port`",
                               door.address, door.port, trouble.message()));
    return fine();
  }

  [[nodiscard]] unsigned short port() const override {
    beast::error_code ignored;
    return acceptor_.local_endpoint(ignored).port();
  }
  void run() override {
    accept();
    context_.run();
  }
  void stop() override { context_.stop(); }
  void stop_at_signals(const std::vector<int>& signals) override {
    for (const int signal : signals) signals_.add(signal);
    signals_.async_wait([this](beast::error_code trouble, int) {
      if (!trouble) stop();
    });
  }

 private:
  Status with_tls(const Door& door) {
    auto& tls = tls_.emplace(asio::ssl::context::tls_server);
    beast::error_code trouble;
    tls.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_sslv2 |
                        asio::ssl::context::no_sslv3 | asio::ssl::context::no_tlsv1 |
                        asio::ssl::context::no_tlsv1_1,
                    trouble);
    const auto name = [](const std::string& path) {
      return std::filesystem::path(path).filename().string();
    };
    tls.use_certificate_chain_file(door.certificate, trouble);
    if (trouble)
      return error(Trouble::data, fmt::format("{}: is no certificate in PEM ({})",
                                              name(door.certificate), trouble.message()));
    tls.use_private_key_file(door.key, asio::ssl::context::pem, trouble);
    if (trouble)
      return error(Trouble::data,
                   fmt::format("{}: is no private key in PEM for this certificate ({})",
                               name(door.key), trouble.message()));
    return fine();
  }

  void accept() {
    acceptor_.async_accept([this](beast::error_code trouble, Tcp::socket socket) {
      if (trouble == asio::error::operation_aborted) return;
      if (!trouble && shared_.connections < kMostConnections) begin(std::move(socket));
      if (!trouble) return accept();                         // what was not taken is closed here
      pause_.expires_after(std::chrono::milliseconds(100));  // too many open files, for example
      pause_.async_wait([this](beast::error_code ended) {
        if (!ended) accept();
      });
    });
  }

  void begin(Tcp::socket&& socket) {
    if (tls_)
      std::make_shared<Connection<beast::ssl_stream<beast::tcp_stream>>>(std::move(socket), shared_,
                                                                         *tls_)
          ->begin();
    else
      std::make_shared<Connection<beast::tcp_stream>>(std::move(socket), shared_)->begin();
  }

  Shared shared_;
  std::optional<asio::ssl::context> tls_;
  asio::io_context context_{1};  // connections in it go first: it is destroyed before what they use
  Tcp::acceptor acceptor_{context_};
  asio::signal_set signals_{context_};
  asio::steady_timer pause_{context_};
};

}  // namespace

Result<std::unique_ptr<HttpServer>> HttpServer::open(const Door& door, Answering answer) {
  if (door.certificate.empty() != door.key.empty())
    return error(Trouble::usage, "`certificate` and `key` belong together; give both");
  auto server = std::make_unique<Server>(std::move(answer), door.wait_s);
  if (const Status done = server->listen(door); !done) return done.error();
  return std::unique_ptr<HttpServer>(std::move(server));
}

bool is_loopback(const std::string& address) {
  beast::error_code trouble;
  const auto parsed = asio::ip::make_address(address, trouble);
  return !trouble && parsed.is_loopback();
}

}  // namespace burr::net
