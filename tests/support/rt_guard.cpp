#include "support/rt_guard.h"

#include <dlfcn.h>
#include <malloc.h>
#include <pthread.h>

#include <cerrno>
#include <cstddef>

namespace {
thread_local bool watching_now = false;
thread_local long heap_calls = 0;
thread_local long mutexes = 0;
}  // namespace

#if !defined(BURR_SANITIZED)
// NOLINTBEGIN: these names are glibc's
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* p, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* p);

void* malloc(std::size_t size) {
  heap_calls += watching_now;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  heap_calls += watching_now;
  return __libc_calloc(count, size);
}
void* realloc(void* p, std::size_t size) {
  heap_calls += watching_now;
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  heap_calls += watching_now;
  return __libc_memalign(alignment, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  heap_calls += watching_now;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  heap_calls += watching_now;
  *out = __libc_memalign(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
void free(void* p) {
  heap_calls += watching_now && p != nullptr;
  __libc_free(p);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  using Lock = int (*)(pthread_mutex_t*);
  static Lock real = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  mutexes += watching_now;
  return real(mutex);
}
}
// NOLINTEND
#endif

namespace burr::test {

RtGuard::RtGuard() noexcept {
  heap_calls = 0;
  mutexes = 0;
  watching_now = true;
}
RtGuard::~RtGuard() { watching_now = false; }
long RtGuard::allocations() const noexcept { return heap_calls; }
long RtGuard::locks() const noexcept { return mutexes; }
bool RtGuard::watching() noexcept {
#if defined(BURR_SANITIZED)
  return false;
#else
  return true;
#endif
}

}  // namespace burr::test
