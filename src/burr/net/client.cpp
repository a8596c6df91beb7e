#include "burr/net/client.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/ssl.hpp>
#include <chrono>
#include <cstdint>
#include <type_traits>

#include "burr/net/field_name.h"

namespace burr::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace web = boost::beast::http;
using Tcp = asio::ip::tcp;
using Trouble = burr::Trouble;

constexpr std::uint64_t kLargestAnswer = 8 << 20;  // [byte]

bool is_this_computer(const std::string& host) {
  beast::error_code trouble;
  const auto address = asio::ip::make_address(host, trouble);
  return host == "localhost" || (!trouble && address.is_loopback());
}

Error failed(const Url& url, const beast::error_code& trouble) {
  const bool late = trouble == beast::error::timeout;
  return error(Trouble::io, fmt::format("{}: {}", url.host,
                                        late ? "no whole answer came in time" : trouble.message()));
}

// Starts one piece of work and waits until it is done or the stream's time is over.
template <class Begin>
beast::error_code wait_for(asio::io_context& context, Begin begin) {
  beast::error_code out = asio::error::would_block;
  begin([&out](const beast::error_code& trouble, auto&&...) { out = trouble; });
  context.restart();
  context.run();
  return out;
}

template <class Stream>
beast::error_code exchange(asio::io_context& context, Stream& stream, const Url& url,
                           web::request<web::string_body>& request,
                           web::response_parser<web::string_body>& parser,
                           std::chrono::steady_clock::time_point until) {
  Tcp::resolver resolver(context);
  beast::error_code trouble;
  const auto places = resolver.resolve(url.host, url.port, trouble);
  if (trouble) return trouble;
  auto& lowest = beast::get_lowest_layer(stream);
  lowest.expires_at(until);
  trouble = wait_for(context, [&](auto done) { lowest.async_connect(places, std::move(done)); });
  if constexpr (!std::is_same_v<Stream, beast::tcp_stream>)
    if (!trouble)
      trouble = wait_for(context, [&](auto done) {
        stream.async_handshake(asio::ssl::stream_base::client, std::move(done));
      });
  if (!trouble)
    trouble =
        wait_for(context, [&](auto done) { web::async_write(stream, request, std::move(done)); });
  // who refuses a body that is too large may answer before it has read it
  const beast::error_code wrote = trouble;
  if (trouble && trouble != asio::error::broken_pipe && trouble != asio::error::connection_reset)
    return trouble;
  beast::flat_buffer buffer;
  trouble = wait_for(context,
                     [&](auto done) { web::async_read(stream, buffer, parser, std::move(done)); });
  if (parser.is_done()) return {};
  return wrote ? wrote : trouble;
}

web::request<web::string_body> request_of(const Question& question, const Url& url) {
  web::request<web::string_body> request;
  request.method_string(question.method);
  request.target(url.target);
  request.version(11);
  const bool usual = url.port == (url.tls ? "443" : "80");
  const std::string host =
      url.host.find(':') == std::string::npos ? url.host : "[" + url.host + "]";
  request.set(web::field::host, usual ? host : host + ":" + url.port);
  request.set(web::field::user_agent, "burr");
  request.set(web::field::connection, "close");
  for (const auto& [name, value] : question.fields) request.set(name, value);
  request.body() = question.body;
  if (!question.body.empty() || question.method == "POST" || question.method == "PUT")
    request.content_length(question.body.size());
  return request;
}

int digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

}  // namespace

Result<Url> parse_url(const std::string& text) {
  const auto wrong = [](const char* why) {
    return error(Trouble::usage, std::string("this is no address of a server: ") + why);
  };
  Url url;
  std::string rest;
  if (text.rfind("https://", 0) == 0) {
    rest = text.substr(8);
  } else if (text.rfind("http://", 0) == 0) {
    url.tls = false;
    rest = text.substr(7);
  } else {
    return wrong("it must begin with https://");
  }
  for (const char c : text)
    if (static_cast<unsigned char>(c) <= 0x20 || c == 0x7f) return wrong("it holds a space");
  rest = rest.substr(0, rest.find('#'));
  const std::size_t end = std::min(rest.find_first_of("/?"), rest.size());
  std::string place = rest.substr(0, end);
  url.target = rest.substr(end);
  if (url.target.empty() || url.target[0] == '?') url.target.insert(0, "/");
  if (place.find('@') != std::string::npos) return wrong("it holds a name or a password");
  url.port = url.tls ? "443" : "80";
  const std::size_t bracket = place.rfind(']');
  const std::size_t colon = place.find(':', bracket == std::string::npos ? 0 : bracket);
  if (colon != std::string::npos) {
    url.port = place.substr(colon + 1);
    place.resize(colon);
  }
  if (place.size() > 2 && place.front() == '[' && place.back() == ']')
    place = place.substr(1, place.size() - 2);
  url.host = place;
  if (url.host.empty() || url.port.empty() ||
      url.port.find_first_not_of("0123456789") != std::string::npos || url.port.size() > 5)
    return wrong("the computer's name or the port is missing");
  if (!url.tls && !is_this_computer(url.host))
    return error(Trouble::usage, "without TLS other computers could read the key; use https://");
  return url;
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                       c == '-' || c == '.' || c == '_' || c == '~';
    out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

std::string unescaped(const std::string& text) {
  std::string out;
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (text[n] == '%' && n + 2 < text.size() && digit(text[n + 1]) >= 0 &&
        digit(text[n + 2]) >= 0) {
      out += static_cast<char>(digit(text[n + 1]) * 16 + digit(text[n + 2]));
      n += 2;
    } else {
      out += text[n] == '+' ? ' ' : text[n];
    }
  }
  return out;
}

Result<Answer> ask(const Question& question) {
  auto url = parse_url(question.url);
  if (!url) return url.error();
  const auto until = std::chrono::steady_clock::now() +
                     std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                         std::chrono::duration<double>(question.wait_s));
  auto request = request_of(question, *url);
  web::response_parser<web::string_body> parser;
  parser.body_limit(kLargestAnswer);
  parser.skip(question.method == "HEAD");
  asio::io_context context{1};
  beast::error_code trouble;
  if (url->tls) {
    asio::ssl::context tls(asio::ssl::context::tls_client);
    tls.set_default_verify_paths(trouble);
    tls.set_options(asio::ssl::context::default_workarounds | asio::ssl::context::no_tlsv1 |
                        asio::ssl::context::no_tlsv1_1,
                    trouble);
    tls.set_verify_mode(asio::ssl::verify_peer);
    beast::ssl_stream<beast::tcp_stream> stream(context, tls);
    stream.set_verify_callback(asio::ssl::host_name_verification(url->host));
    // the macro for it has a cast of the old style
    if (SSL_ctrl(stream.native_handle(), SSL_CTRL_SET_TLSEXT_HOSTNAME, TLSEXT_NAMETYPE_host_name,
                 url->host.data()) != 1)
      return error(Trouble::io, url->host + ": TLS does not begin");
    trouble = exchange(context, stream, *url, request, parser, until);
  } else {
    beast::tcp_stream stream(context);
    trouble = exchange(context, stream, *url, request, parser, until);
  }
  if (trouble) return failed(*url, trouble);
  Answer out;
  const auto& message = parser.get();
  out.status = static_cast<int>(message.result_int());
  for (const auto& field : message)
    out.fields[small_letters({field.name_string().data(), field.name_string().size()})] =
        std::string(field.value().data(), field.value().size());
  out.body = message.body();
  return out;
}

}  // namespace burr::net
