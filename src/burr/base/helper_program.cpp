#include "burr/base/helper_program.h"

#include <dlfcn.h>
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

}  // namespace burr::base
