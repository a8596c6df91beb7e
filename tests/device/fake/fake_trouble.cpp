// A library that crashes, or never returns, when it is loaded.
#include <unistd.h>

#include <csignal>
#include <cstdlib>

namespace {

struct Loaded {
  Loaded() {
#ifdef FAKE_HANGS
    for (;;) pause();
#else
    std::signal(SIGABRT, SIG_DFL);
    std::abort();
#endif
  }
} const loaded;

}  // namespace
