// `burr web`: writes the page, burr in a browser, as a folder for any static host.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/new_file.h"
#include "shared/built_page.h"
#include "shared/page_source.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string out, from;
};

// Nothing of the user is overwritten: the folder is new, empty, or an older page.
Status check_out(const fs::path& out) {
  std::error_code none;
  if (!fs::exists(out, none)) return fine();
  if (!fs::is_directory(out, none))
    return error(Trouble::usage, fmt::format("--out {}: is no folder", out.string()));
  if (!fs::is_empty(out, none) && !fs::exists(out / kSignOfPage, none) &&
      !fs::exists(out / "burr_page.wasm", none))  // a page from before it had versions
    return error(Trouble::usage,
                 fmt::format("--out {}: holds other files; choose a new folder", out.string()));
  return fine();
}

Status put_file(const std::string& bytes, const fs::path& to) {
  std::error_code trouble;
  fs::create_directories(to.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be made: {}", to.parent_path().string(),
                                          trouble.message()));
  auto file = base::NewFile::create(to.string(), base::kForAll);
  if (!file) return file.error();
  file->write(bytes);
  return file->put_in_place();
}

// The parts first, then the pages that name them, then what keeps them in browsers: whoever loads meanwhile gets one version.
std::vector<std::string> in_order(const BuiltPage& page) {
  std::vector<std::string> parts, pages, last;
  for (const auto& [path, hash] : page.files)
    (path.starts_with(page.parts + "/") ? parts
     : path.starts_with("sw.js")        ? last
                                        : pages)
        .push_back(path);
  parts.insert(parts.end(), pages.begin(), pages.end());
  parts.insert(parts.end(), last.begin(), last.end());
  return parts;
}

// Folders of versions before the last one: pages of the last one may still be open, and load from it.
void remove_old(const fs::path& out, const std::string& now, const std::string& before) {
  std::error_code none;
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(out, none)) {
    const std::string name = entry.path().filename().string();
    if (is_parts(name) && name != now && name != before && entry.is_directory(none))
      old.push_back(entry.path());
  }
  for (const fs::path& one : old) fs::remove_all(one, none);
}

Status run(const Options& options) {
  const fs::path out = options.out;
  if (const Status possible = check_out(out); !possible) return possible;
  PageSource source;
  const auto page = source.open(options.from);
  if (!page) return page.error();
  std::error_code none;
  if (fs::weakly_canonical(page->folder, none) == fs::weakly_canonical(out, none))
    return error(Trouble::usage,
                 fmt::format("--out {}: is the page itself; choose a new folder", out.string()));
  const auto older = page_in(out);
  std::vector<std::pair<std::string, std::string>>
      files;  // all are looked at before one is written
  std::uintmax_t bytes = 0;
  for (const std::string& path : in_order(*page)) {
    auto file = file_of_page(*page, path);
    if (!file) return file.error();
    bytes += file->size();
    files.emplace_back(path, std::move(*file));
  }
  auto list = list_of_page(*page);
  if (!list) return list.error();
  files.emplace_back(kSignOfPage, std::move(*list));
  for (const auto& [path, file] : files)
    if (const Status put = put_file(file, out / path); !put) return put;
  if (older && older->parts != page->parts) remove_old(out, page->parts, older->parts);
  fmt::print(
      "{}: {} files, {:.1f} MB; put it on any web server, and open mill/. The files in hosting/ "
      "say for nginx, Apache and Caddy how\n",
      out.string(), files.size(), 1e-6 * static_cast<double>(bytes));
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command =
      app.add_subcommand("web", "write the page: burr in a browser, for any web server");
  auto options = std::make_shared<Options>();
  command->add_option("--out", options->out, "the folder to write")->required();
  command->add_option("--from", options->from,
                      "a page: a folder, or burr-web-VERSION.tar.gz (default: what came with this "
                      "program; where nothing came, it is built, which takes minutes)");
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}
const Command command{70, add};

}  // namespace
}  // namespace burr::app
