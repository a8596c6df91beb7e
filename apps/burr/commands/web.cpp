// `burr web`: writes the page, burr in a browser, as a folder for any static host.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "burr/base/new_file.h"
#include "shared/built_page.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

struct Options {
  std::string out;
};

// Nothing of the user is overwritten: the folder is new, empty, or an older page.
Status check_out(const fs::path& out) {
  std::error_code none;
  if (!fs::exists(out, none)) return fine();
  if (!fs::is_directory(out, none))
    return error(Trouble::usage, fmt::format("--out {}: is no folder", out.string()));
  if (!fs::is_empty(out, none) && !fs::exists(out / kSignOfPage, none))
    return error(Trouble::usage,
                 fmt::format("--out {}: holds other files; choose a new folder", out.string()));
  return fine();
}

Status put_file(const fs::path& from, const fs::path& to) {
  std::ifstream in(from, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in.good() && !in.eof())
    return error(Trouble::io, fmt::format("{}: cannot be read", from.string()));
  std::error_code trouble;
  fs::create_directories(to.parent_path(), trouble);
  if (trouble)
    return error(Trouble::io, fmt::format("{}: cannot be made: {}", to.parent_path().string(),
                                          trouble.message()));
  auto file = base::NewFile::create(to.string(), base::kForAll);
  if (!file) return file.error();
  file->write(bytes.data(), bytes.size());
  return file->put_in_place();
}

Status run(const Options& options) {
  const auto page = built_page();
  if (!page) return page.error();
  const fs::path out = options.out;
  if (const Status possible = check_out(out); !possible) return possible;
  const std::vector<fs::path> files = files_of_page(*page);
  std::uintmax_t bytes = 0;
  for (const fs::path& file : files) {
    if (const Status copied = put_file(file, out / fs::relative(file, *page)); !copied)
      return copied;
    bytes += fs::file_size(file);
  }
  fmt::print("{}: {} files, {:.1f} MB; put it on any web server, and open mill/\n", out.string(),
             files.size(), 1e-6 * static_cast<double>(bytes));
  return fine();
}

void add(CLI::App& app, Todo& todo) {
  auto* command =
      app.add_subcommand("web", "write the page: burr in a browser, for any web server");
  auto options = std::make_shared<Options>();
  command->add_option("--out", options->out, "the folder to write")->required();
  command->callback([options, &todo] { todo.work = [options] { return run(*options); }; });
}
const Command command{70, add};

}  // namespace
}  // namespace burr::app
