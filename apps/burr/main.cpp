// burr - the program. Each subcommand is a file of its own; this file parses the command line, runs
// the subcommand and turns errors into exit codes.
#include <fcntl.h>
#include <fmt/core.h>
#include <malloc.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "burr/base/version.h"
#include "commands/complete.h"
#include "commands/examples.h"
#include "commands/shell_limits.h"
#include "shared/console.h"
#include "shared/front_words.h"
#include "shared/interrupt.h"
#include "shared/subcommand.h"

namespace burr::app {
namespace {

std::vector<std::pair<int, Command::Add>>& commands() {
  static std::vector<std::pair<int, Command::Add>> all;
  return all;
}

// A message to stderr that cannot be written must not end a session. fmt throws if a stream fails,
// on any thread, so stderr becomes a stream that never fails. Descriptors 0, 1 and 2 that are
// closed at the start are opened: otherwise the next file, perhaps a recording, would get the
// number of stderr and with it all messages.
void secure_streams() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(descriptor, F_GETFD) < 0 && errno == EBADF)
      // stdout opened for reading: writing to it is still an error, as without the file
      static_cast<void>(open("/dev/null", descriptor == STDERR_FILENO ? O_WRONLY : O_RDONLY));
  constexpr cookie_io_functions_t kDeaf = {
      .read = nullptr,
      .write = [](void*, const char* text, std::size_t size) -> ssize_t {
        for (std::size_t done = 0; done < size;) {
          const ssize_t some = write(STDERR_FILENO, text + done, size - done);
          if (some < 0 && errno == EINTR) continue;
          if (some <= 0) break;
          done += static_cast<std::size_t>(some);
        }
        return static_cast<ssize_t>(size);
      },
      .seek = nullptr,
      .close = nullptr};
  if (std::FILE* deaf = fopencookie(nullptr, "w", kDeaf); deaf != nullptr) {
    std::setvbuf(deaf, nullptr, _IONBF, 0);
    stderr = deaf;
  }
}

// The exit code of a program that SIGPIPE ended: the reader of the output is gone.
constexpr int kReaderGone = 128 + SIGPIPE;

// Output could not be written: returns the exit code; reports it on stderr, unless the reader is
// gone.
int unheard(int trouble) {
  if (trouble == EPIPE) return kReaderGone;
  std::fprintf(stderr, "burr: standard output cannot be written: %s\n", std::strerror(trouble));
  return static_cast<int>(Trouble::io);
}

// Flushes the output and returns the exit code: 0 only if all output was written.
int end(int code) {
  errno = 0;
  const bool written = std::fflush(stdout) == 0 && std::cout.flush().good();
  return code == 0 && !written ? unheard(errno) : code;
}

}  // namespace

Command::Command(int place, Add add) { commands().emplace_back(place, add); }

}  // namespace burr::app

int main(int argc, char** argv) {
  using namespace burr;
  // One memory arena for all threads. A software renderer allocates and frees about 75 MB per
  // picture, and each arena would keep its own peak until the end (memory of a session is locked).
  mallopt(M_ARENA_MAX, 1);
  const Status limits = app::raise_limits();
  app::catch_interrupts();
  std::signal(SIGPIPE, SIG_IGN);
  app::secure_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is reported as an error, like a full disk

  CLI::App program{"burr - cut bone by hand: touch, mill and print a patient's bone", "burr"};
  program.set_version_flag("--version",
                           fmt::format("burr {} ({})", base::version(), base::build()));
  program.set_help_all_flag("--help-all", "show the help of all subcommands");
  program.require_subcommand(0, 1);
  program.add_flag("--quiet", app::quiet(), "print no progress lines");
  program.add_flag("--percent", app::each_percent(),
                   "print a progress line for each percent, for another program to read");

  bool dry = false;
  program.add_flag("--dry", dry, "check the command line and do nothing");

  app::Todo todo;
  auto& commands = app::commands();
  std::stable_sort(commands.begin(), commands.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [place, add] : commands) add(program, todo);
  std::string about;
  auto* help = program.add_subcommand("help", "show this text, or the help of a command");
  help->add_option("command", about, "a command, as in `burr help mill`");
  help->callback([&] {
    todo.work = [&]() -> Status {
      const CLI::App* one = nullptr;
      for (const CLI::App* command : program.get_subcommands({}))
        if (command->get_name() == about) one = command;
      if (!about.empty() && one == nullptr)
        return error(Trouble::usage,
                     fmt::format("{}: there is no such command; `burr help` lists them", about));
      program.clear();  // otherwise CLI11 shows the help of the subcommand "help"
      fmt::print("{}", one != nullptr ? one->help("burr") : program.help());
      return fine();
    };
  });

  app::add_examples(program);
  if (argc > 1 &&
      std::string_view(argv[1]) == "__complete") {  // a shell wants to know what may come next
    for (const std::string& line :
         app::completions(program, std::vector<std::string>(argv + 2, argv + argc)))
      fmt::print("{}\n", line);
    return app::end(0);
  }

  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    const int code = program.exit(problem);
    return app::end(code == 0 ? 0 : static_cast<int>(Trouble::usage));
  }
  if (dry) return app::end(0);
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  app::speak_for(*command);
  if (!todo.work)
    todo.work = [&program] {
      fmt::print("{}", program.help());
      return fine();
    };
  Status status = limits;
  try {
    if (status) status = todo.work();
  } catch (const std::bad_alloc&) {
    status = error(Trouble::data, "not enough memory; use a larger --voxel-mm or a smaller --roi");
  } catch (const std::system_error& problem) {
    // fmt throws this when output could not be written
    if (problem.code() == std::errc::broken_pipe) return app::kReaderGone;
    if (std::ferror(stdout) != 0) return app::unheard(problem.code().value());
    status = problem.code() == std::errc::resource_unavailable_try_again
                 ? error(
                       "the system starts no further thread: raise the limit on processes "
                       "(`ulimit -u`) or on memory (`ulimit -v`), or end other programs")
                 : error(Trouble::internal,
                         fmt::format("unexpected: {}; please report it", problem.what()));
  } catch (const std::exception& problem) {
    status =
        error(Trouble::internal, fmt::format("unexpected: {}; please report it", problem.what()));
  }
  if (!status.ok())
    std::fprintf(stderr, "burr: %s\n", app::in_options(status.error()).text.c_str());
  if (status.ok()) return app::end(0);
  const Trouble trouble = status.error().trouble;
  return app::end(trouble == Trouble::interrupted ? app::stopped_code()
                                                  : static_cast<int>(trouble));
}
