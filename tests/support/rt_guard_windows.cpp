// tests/support/rt_guard.h on Windows: the linker leads every call of these functions here first
// (BURR_GUARDED in cmake/portable.cmake). tests/support/rt_guard.cpp is the one for Linux.
#include <malloc.h>
#include <pthread.h>
#include <windows.h>

#include <atomic>
#include <cstddef>

#include "support/rt_guard.h"

namespace {

struct Counts {
  bool watching = false;
  long heap_calls = 0, mutexes = 0;
};

// Not thread_local: g++ for Windows allocates memory for that at a thread's first use. Made by the first guard.
std::atomic<DWORD> slot = TLS_OUT_OF_INDEXES;

// The calling thread's; none if it never had a guard. Leaves the last error as it is.
Counts* counts() {
  if (slot == TLS_OUT_OF_INDEXES) return nullptr;
  const DWORD error = GetLastError();
  auto* mine = static_cast<Counts*>(TlsGetValue(slot));
  SetLastError(error);
  return mine;
}

void note(long Counts::*what) {
  Counts* mine = counts();
  if (mine != nullptr && mine->watching) ++(mine->*what);
}

}  // namespace

// NOLINTBEGIN: these names are the linker's
extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* p, std::size_t size);
void __real_free(void* p);
int __real_pthread_mutex_lock(pthread_mutex_t* mutex);

void* __wrap_malloc(std::size_t size) {
  note(&Counts::heap_calls);
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  note(&Counts::heap_calls);
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* p, std::size_t size) {
  note(&Counts::heap_calls);
  return __real_realloc(p, size);
}
void __wrap_free(void* p) {
  if (p != nullptr) note(&Counts::heap_calls);
  __real_free(p);
}
int __wrap_pthread_mutex_lock(pthread_mutex_t* mutex) {
  note(&Counts::mutexes);
  return __real_pthread_mutex_lock(mutex);
}

// of new with an alignment; the C++ library calls these two by their pointers
extern void* (*__real___imp__aligned_malloc)(std::size_t size, std::size_t alignment);
extern void (*__real___imp__aligned_free)(void* p);

static void* aligned_malloc(std::size_t size, std::size_t alignment) {
  note(&Counts::heap_calls);
  return __real___imp__aligned_malloc(size, alignment);
}
static void aligned_free(void* p) {
  if (p != nullptr) note(&Counts::heap_calls);
  __real___imp__aligned_free(p);
}
void* (*__wrap___imp__aligned_malloc)(std::size_t size, std::size_t alignment) = aligned_malloc;
void (*__wrap___imp__aligned_free)(void* p) = aligned_free;
}
// NOLINTEND

namespace burr::test {

RtGuard::RtGuard() noexcept {
  static const DWORD made = TlsAlloc();
  slot = made;
  if (counts() == nullptr) TlsSetValue(slot, new Counts);  // kept until the program ends
  *counts() = {true};
}
RtGuard::~RtGuard() { counts()->watching = false; }
long RtGuard::allocations() const noexcept { return counts()->heap_calls; }
long RtGuard::locks() const noexcept { return counts()->mutexes; }
bool RtGuard::watching() noexcept { return true; }

}  // namespace burr::test
