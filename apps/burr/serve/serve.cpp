// `burr serve`: the instructor's page, in a browser, from the store of learners.
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "burr/net/guard.h"
#include "burr/net/http_server.h"
#include "burr/school/pending.h"
#include "burr/school/practice.h"
#include "burr/school/store.h"
#include "school/store_command.h"
#include "serve/page_files.h"
#include "serve/rating_api.h"
#include "serve/replays.h"
#include "serve/school_api.h"
#include "serve/stations.h"
#include "shared/built_page.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

struct Options {
  std::string store, token_file, station_token_file;
  bool live = false;
  net::Door door;
  std::vector<std::string> names;
  int port = 8231;
};

// The names by which a browser may ask: with the port, and without it where it is the usual one.
std::vector<std::string> hosts_of(const Options& options, unsigned short port) {
  std::vector<std::string> names = options.names;
  const std::string& address = options.door.address;
  names.push_back(address.find(':') == std::string::npos ? address : "[" + address + "]");
  if (net::is_loopback(address)) names.emplace_back("localhost");
  std::vector<std::string> out;
  const bool usual = port == (options.door.certificate.empty() ? 80 : 443);
  for (const std::string& name : names) {
    out.push_back(fmt::format("{}:{}", name, port));
    if (usual) out.push_back(name);
  }
  return out;
}

Status check(const Options& options) {
  if (!net::is_loopback(options.door.address) && options.door.certificate.empty())
    return error(Trouble::usage,
                 fmt::format("--listen {}: other computers could read along. Give --certificate "
                             "and --key for TLS, or stay on "
                             "127.0.0.1 and use a tunnel: ssh -L {}:127.0.0.1:{} THIS-COMPUTER",
                             options.door.address, options.port, options.port));
  return fine();
}

// The parts of the page, burr in a browser, whose view of bones the replay uses. Error: there is no page, or it is damaged.
Result<std::map<std::string, net::Response>> bone_view() {
  std::map<std::string, net::Response> out;
  const auto page = built_page();
  if (!page) return page.error();
  const std::map<std::string, std::string> types = {{".js", "text/javascript; charset=utf-8"},
                                                    {".mjs", "text/javascript; charset=utf-8"},
                                                    {".wasm", "application/wasm"},
                                                    {".json", "application/json; charset=utf-8"}};
  const std::string parts = page->parts + "/";
  for (const auto& [path, hash] : page->files) {
    const auto type = types.find(std::filesystem::path(path).extension().string());
    if (type == types.end() || !path.starts_with(parts)) continue;
    auto bytes = file_of_page(*page, path);
    if (!bytes) return bytes.error();
    net::Response part;
    part.type = type->second;
    part.body = std::move(*bytes);
    out["/page/" + path.substr(parts.size())] = std::move(part);
  }
  return out;
}

net::Response page(const net::Request& request, const std::map<std::string, net::Response>& view) {
  if (const auto part = view.find(request.path); part != view.end()) return part->second;
  const std::string path = request.path == "/" ? "/index.html" : request.path;
  for (const PageFile& file : page_files())
    if (file.path == path) {
      net::Response out;
      out.type = file.type;
      out.body = file.text;
      out.keeps = path != "/index.html";
      return out;
    }
  return net::refusal(404, "there is nothing at this address");
}

Status run(const Options& options) {
  if (const Status good = check(options); !good) return good;
  auto store = store_that_is_there(options.store);
  if (!store) return store.error();
  auto token = options.token_file.empty() ? net::new_token() : net::token_from(options.token_file);
  if (!token) return token.error();
  net::Guard guard;
  guard.token = *token;
  if (options.live || !options.station_token_file.empty()) {
    auto stations = options.station_token_file.empty()
                        ? net::new_token()
                        : net::token_from(options.station_token_file);
    if (!stations) return stations.error();
    if (*stations == guard.token)
      return error(Trouble::usage,
                   "--station-token-file and --token-file hold the same token; a "
                   "station must not be able to read the store");
    guard.station_token = *stations;
  }
  guard.tls = !options.door.certificate.empty();
  const auto found = bone_view();
  const auto view = found ? *found : std::map<std::string, net::Response>();
  Replays replays;
  Stations stations;
  RatingDesk desk(**store);
  school::PracticeMemo memo;
  // the learners' curves are fitted now, so that the first page is fast; if this fails, that page reports the error
  static_cast<void>(school::practice(**store, "", &memo));
  net::Door door = options.door;
  door.port = static_cast<unsigned short>(options.port);
  auto server = net::HttpServer::open(door, [&](const net::Request& request) {
    if (auto refusal = net::refused(request, guard)) return *refusal;
    if (request.path == net::kStationPath || request.path.starts_with("/api/live"))
      return stations.answer(request, Stations::Clock::now());
    if (request.path.starts_with("/api/replay")) return replays.answer(**store, request);
    if (!request.path.starts_with("/api/")) return page(request, view);
    if (auto marked = desk.answer(request)) return std::move(*marked);
    return answer_of_school(**store, request, memo);
  });
  if (!server) return server.error();
  guard.hosts = hosts_of(options, (*server)->port());
  if (!found) fmt::print(stderr, "the page can replay no session in 3D: {}\n", found.error().text);
  fmt::print(
      "store: {}\nOpen this address in a browser. Whoever has it can read the store:\n  "
      "{}://{}/#token={}\n",
      school::shown((*store)->place().address), guard.tls ? "https" : "http", guard.hosts.front(),
      guard.token);
  if (!guard.station_token.empty())
    fmt::print(
        "Stations show themselves with: burr run CASE --live {}://{} --live-token-file FILE\n"
        "FILE, readable by its user alone, holds their token, with which they can read nothing:\n  "
        "{}\n",
        guard.tls ? "https" : "http", guard.hosts.front(), guard.station_token);
  fmt::print("Ctrl-C ends.\n");
  std::fflush(stdout);
  (*server)->stop_at_signals({SIGINT, SIGTERM, SIGHUP});
  (*server)->run();
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command = app.add_subcommand("serve", "the instructor's page, in a browser");
  auto options = std::make_shared<Options>();
  add_store_option(*command, options->store);
  command->add_option("--port", options->port, "0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command
      ->add_option("--listen", options->door.address,
                   "an address of this computer; others than 127.0.0.1 need TLS")
      ->capture_default_str();
  command->add_option("--certificate", options->door.certificate,
                      "F.pem: the certificate, for TLS");
  command->add_option("--key", options->door.key, "F.pem: its private key");
  command->add_option("--name", options->names,
                      "a name by which browsers reach this computer; can be repeated");
  command->add_option("--token-file", options->token_file,
                      "a file with the token, readable by you alone (default: a new token)");
  command->add_flag("--live", options->live,
                    "running stations can show themselves on the page (burr run --live)");
  command->add_option("--station-token-file", options->station_token_file,
                      "a file with the token of the stations (default with --live: a new token)");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}

const Command command{67, add};

}  // namespace
}  // namespace burr::app
