/* A disk that fails: for a program that is started with it as LD_PRELOAD, one call fails for files whose
   name has FAIL_PATH in it.
     FAIL_CALL   open write fdatasync fsync rename ftruncate flock pread close fstat, or several with commas;
                 FAIL_ERRNO its errno
     FAIL_AFTER  so many calls succeed first; FAIL_TIMES  so many fail (usual: all that follow)
     FAIL_SHORT  1: the first write that fails takes half of its bytes before */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static atomic_long calls;

static long number(const char* name, long usual) {
  const char* text = getenv(name);
  return text != NULL ? atol(text) : usual;
}

static int named(const char* path) {
  const char* part = getenv("FAIL_PATH");
  return part != NULL && path != NULL && strstr(path, part) != NULL;
}

static int wanted(const char* call) {
  const char* list = getenv("FAIL_CALL");
  const size_t size = strlen(call);
  while (list != NULL) {
    if (strncmp(list, call, size) == 0 && (list[size] == 0 || list[size] == ',')) return 1;
    list = strchr(list, ',');
    if (list != NULL) ++list;
  }
  return 0;
}

static int fails_here(const char* call, const char* path) {
  if (!wanted(call) || !named(path)) return 0;
  const long n = atomic_fetch_add(&calls, 1) - number("FAIL_AFTER", 0);
  if (n < 0 || n >= number("FAIL_TIMES", 1L << 40)) return 0;
  errno = (int)number("FAIL_ERRNO", EIO);
  return 1;
}

static int fails(const char* call, int file) {
  const int before = errno;
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t size = readlink(link, path, sizeof path - 1);
  path[size > 0 ? size : 0] = 0;
  errno = before;
  return fails_here(call, path);
}

#define NEXT(name) static __typeof__(&name) next; if (next == NULL) next = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

int open64(const char* path, int flags, ...) {
  NEXT(open64);
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  if ((flags & O_ACCMODE) != O_RDONLY && fails_here("open", path)) return -1;
  return next(path, flags, mode);
}
int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  return open64(path, flags, mode);
}
ssize_t write(int file, const void* data, size_t size) {
  NEXT(write);
  static atomic_int halves;
  if (!fails("write", file)) return next(file, data, size);
  if (number("FAIL_SHORT", 0) != 0 && size > 1 && atomic_fetch_add(&halves, 1) == 0)
    return next(file, data, size / 2);
  return -1;
}
ssize_t pread64(int file, void* data, size_t size, off64_t at) {
  NEXT(pread64);
  return fails("pread", file) ? -1 : next(file, data, size, at);
}
ssize_t pread(int file, void* data, size_t size, off_t at) { return pread64(file, data, size, at); }
int fdatasync(int file) {
  NEXT(fdatasync);
  return fails("fdatasync", file) ? -1 : next(file);
}
int fsync(int file) {
  NEXT(fsync);
  return fails("fsync", file) ? -1 : next(file);
}
int ftruncate64(int file, off64_t size) {
  NEXT(ftruncate64);
  return fails("ftruncate", file) ? -1 : next(file, size);
}
int ftruncate(int file, off_t size) { return ftruncate64(file, size); }
int flock(int file, int how) {
  NEXT(flock);
  return fails("flock", file) ? -1 : next(file, how);
}
int close(int file) {
  NEXT(close);
  const int failed = fails("close", file);
  const int code = errno;
  const int closed = next(file);
  if (failed) errno = code;
  return failed ? -1 : closed;
}
int fstat64(int file, struct stat64* about) {
  NEXT(fstat64);
  return fails("fstat", file) ? -1 : next(file, about);
}
int fstat(int file, struct stat* about) { return fstat64(file, (struct stat64*)about); }
int rename(const char* from, const char* to) {
  NEXT(rename);
  return fails_here("rename", to) ? -1 : next(from, to);
}
