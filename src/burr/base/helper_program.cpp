#include "burr/base/helper_program.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#if !defined(BURR_LIBEXEC_FROM_LIB)
#define BURR_LIBEXEC_FROM_LIB "../libexec/burr"
#endif

namespace burr::base {

std::string helper_program(const char* name, const char* variable) {
  if (const char* named = std::getenv(variable); named != nullptr && *named != '\0')
    return ::access(named, X_OK) == 0 ? named : "";
  Dl_info here{};
  if (::dladdr(reinterpret_cast<const void*>(&helper_program), &here) == 0) return {};
  std::error_code trouble;
  const auto library = std::filesystem::canonical(here.dli_fname, trouble);
  if (trouble) return {};
  for (const char* folder : {".", BURR_LIBEXEC_FROM_LIB}) {
    const std::string program = (library.parent_path() / folder / name).lexically_normal().string();
    if (::access(program.c_str(), X_OK) == 0) return program;
  }
  return {};
}

// posix_spawn, because after a fork a process with threads may only call a few functions
int start_helper(const std::string& program, const char* name, std::initializer_list<Passed> passed,
                 pid_t& child) {
  posix_spawn_file_actions_t handles;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&handles);
  posix_spawnattr_init(&attributes);
  for (const Passed& one : passed) {
    if (one.here == kNothing)
      posix_spawn_file_actions_addopen(&handles, one.there, "/dev/null", O_RDWR, 0);
    else
      posix_spawn_file_actions_adddup2(&handles, one.here, one.there);
  }
  sigset_t none, all;
  sigemptyset(&none);
  sigfillset(&all);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &all);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  std::string first = name;
  char* arguments[] = {first.data(), nullptr};
  const int reason =
      ::posix_spawn(&child, program.c_str(), &handles, &attributes, arguments, environ);
  posix_spawn_file_actions_destroy(&handles);
  posix_spawnattr_destroy(&attributes);
  return reason;
}

}  // namespace burr::base
