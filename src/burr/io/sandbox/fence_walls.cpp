// Raw system calls, because Debian 12 has no library for Landlock, and seccomp needs none. Sources:
// landlock(7), seccomp(2), Documentation/userspace-api/landlock.rst.
#include "burr/io/sandbox/fence_walls.h"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <system_error>
#include <vector>

#include "burr/io/read/adf_folder.h"
#include "burr/io/read/bytes.h"
#include "burr/io/read/text.h"
#include "burr/io/sandbox/fence_letter.h"

namespace burr::io {
namespace {

namespace fs = std::filesystem;

// ---- the size of the limits

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
constexpr std::size_t kMostEntries = 100000;  // as many as the reader of folders reads
constexpr int kDeepest = 10;

// Headers that may name a data file beside them, or have one with a matching name.
bool may_have_partner(const fs::path& path) {
  const std::string name = lower(path.filename().string());
  for (const char* part : {".hdr", ".img"})
    if (name.find(part) != std::string::npos) return true;
  constexpr std::size_t kHeader = 65536;
  auto head = first_bytes(path, kHeader);
  if (!head) return false;
  const std::string text = lower(std::string(head->begin(), head->end()));
  if (text.rfind("nrrd", 0) == 0)
    return text.find("data file:") != std::string::npos ||
           text.find("datafile:") != std::string::npos ||
           (text.find("\n\n") == std::string::npos && text.find("\n\r\n") == std::string::npos);
  if (name.find(".mhd") == std::string::npos && name.find(".mha") == std::string::npos)
    return text.rfind("objecttype", 0) == 0;
  const std::size_t field = text.find("elementdatafile");
  if (field == std::string::npos) return true;
  const std::size_t value =
      text.find_first_not_of(" =\t", field + std::string("elementdatafile").size());
  return value == std::string::npos || text.compare(value, 5, "local") != 0;
}

fs::path folder_of(const fs::path& file) {
  const fs::path folder = file.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

template <class Walk>
std::uint64_t bytes_in(Walk walk, std::error_code& trouble) {
  std::uint64_t sum = 0;
  std::size_t entries = 0;
  for (; !trouble && walk != Walk() && entries < kMostEntries; walk.increment(trouble), ++entries) {
    if constexpr (requires { walk.depth(); })
      if (walk.depth() >= kDeepest) walk.disable_recursion_pending();
    std::error_code unreadable;
    if (!walk->is_regular_file(unreadable)) continue;
    const std::uint64_t size = walk->file_size(unreadable);
    if (!unreadable) sum += size;
  }
  return sum;
}

std::uint64_t bytes_there(const fs::path& path) {
  constexpr auto kSkip = fs::directory_options::skip_permission_denied;
  std::error_code trouble;
  if (fs::is_directory(path, trouble))
    return bytes_in(fs::recursive_directory_iterator(path, kSkip, trouble), trouble);
  if (!fs::is_regular_file(path, trouble)) return 0;
  if (is_dicomdir(path))
    return bytes_in(fs::recursive_directory_iterator(folder_of(path), kSkip, trouble), trouble);
  if (named_as_adf(path)) {
    const auto pictures = pictures_folder_in_text(path);
    return pictures ? bytes_in(fs::directory_iterator(*pictures, kSkip, trouble), trouble) : 0;
  }
  if (may_have_partner(path))
    return bytes_in(fs::directory_iterator(folder_of(path), kSkip, trouble), trouble);
  const std::uint64_t size = fs::file_size(path, trouble);
  return trouble ? 0 : size;
}

// ---- limits of the system

template <class Resource>  // whatever type the C library gives these names
bool limit(Resource what, std::uint64_t soft, std::uint64_t hard) {
  rlimit now{};
  if (::getrlimit(what, &now) != 0) return false;
  const rlimit wanted{std::min<rlim_t>(soft, now.rlim_max), std::min<rlim_t>(hard, now.rlim_max)};
  return ::setrlimit(what, &wanted) == 0;
}

bool raise_limits(const FenceLimits& limits) {
  const auto seconds = static_cast<std::uint64_t>(std::ceil(limits.seconds));
  constexpr std::uint64_t kFiles = 64;  // one for each worker, one for each folder level, some to
                                        // spare
  bool good = limit(RLIMIT_CORE, 0, 0) && limit(RLIMIT_NOFILE, kFiles, kFiles) &&
              limit(RLIMIT_CPU, seconds, seconds + 1);
  // a sanitizer writes its report to the file behind stderr
  if (kMemoryLimit)
    good = good && limit(RLIMIT_FSIZE, 0, 0) && limit(RLIMIT_AS, limits.memory, limits.memory);
  return good;
}

// ---- Landlock: which files

// as in linux/landlock.h, independent of the version of the installed headers
struct Ruleset {
  std::uint64_t files = 0, network = 0, scopes = 0;
};
struct __attribute__((packed)) BeneathRule {
  std::uint64_t allowed = 0;
  std::int32_t folder = -1;
};
constexpr std::uint64_t kReadFile = 1U << 2, kReadFolder = 1U << 3;
#if defined(SYS_landlock_create_ruleset)
constexpr long kCreateRuleset = SYS_landlock_create_ruleset, kAddRule = SYS_landlock_add_rule,
               kRestrictSelf = SYS_landlock_restrict_self;
#else  // the same numbers on every architecture
constexpr long kCreateRuleset = 444, kAddRule = 445, kRestrictSelf = 446;
#endif

bool raise_landlock(const fs::path& path) {
  const int version = landlock_version();
  if (version == 0) return true;
  Ruleset rules;
  rules.files = (1U << 13) - 1;               // everything in version 1
  if (version >= 2) rules.files |= 1U << 13;  // moving between folders
  if (version >= 3) rules.files |= 1U << 14;  // truncating
  if (version >= 5) rules.files |= 1U << 15;  // ioctl of devices
  if (version >= 4) rules.network = 3;        // bind and connect, TCP
  if (version >= 6) rules.scopes = 3;         // abstract sockets and signals to others
  const std::size_t size = version >= 6 ? 24 : version >= 4 ? 16 : 8;
  const auto set = static_cast<int>(::syscall(kCreateRuleset, &rules, size, 0));
  if (set < 0) return false;
  const auto open_up = [set](const fs::path& where) {
    const int handle = ::open(where.c_str(), O_PATH | O_CLOEXEC);
    if (handle < 0) return true;  // what does not exist needs no rule; the reader reports it
    struct stat facts = {};
    bool good = ::fstat(handle, &facts) == 0;
    if (good && (S_ISREG(facts.st_mode) || S_ISDIR(facts.st_mode))) {
      const BeneathRule rule{S_ISDIR(facts.st_mode) ? kReadFile | kReadFolder : kReadFile, handle};
      good = ::syscall(kAddRule, set, 1, &rule, 0) == 0;
    }
    ::close(handle);
    return good;
  };
  std::error_code trouble;
  bool good = open_up(path);
  if (!fs::is_directory(path, trouble) && named_as_adf(path)) {
    if (const auto pictures = pictures_folder_in_text(path)) good = good && open_up(*pictures);
  } else if (!fs::is_directory(path, trouble) && (is_dicomdir(path) || may_have_partner(path)))
    good = good && open_up(folder_of(path));
  good = good && ::syscall(kRestrictSelf, set, 0) == 0;
  ::close(set);
  return good;
}

// ---- seccomp: which system calls

#if defined(__x86_64__)
#define BURR_AUDIT_ARCH AUDIT_ARCH_X86_64
#elif defined(__aarch64__) && defined(__ORDER_LITTLE_ENDIAN__)
#define BURR_AUDIT_ARCH AUDIT_ARCH_AARCH64
#endif

#if defined(BURR_AUDIT_ARCH)
// Three kinds of calls: those that reading needs are allowed; those that no reader needs end the
// process; for all others the kernel answers as if it were older and did not know them.
class Filter {
 public:
  Filter() {
    load(offsetof(seccomp_data, arch));
    put(BPF_JMP | BPF_JEQ | BPF_K, BURR_AUDIT_ARCH, 1, 0);
    end(SECCOMP_RET_KILL_PROCESS);
    load(offsetof(seccomp_data, nr));
#if defined(__x86_64__)
    put(BPF_JMP | BPF_JGE | BPF_K, 0x40000000, 0, 1);  // calls of the x32 ABI
    end(SECCOMP_RET_KILL_PROCESS);
#endif
  }
  void always(std::initializer_list<long> calls, std::uint32_t answer) {
    for (const long call : calls) {
      put(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1);
      end(answer);
    }
  }
  // by the lower half of an argument: whether it has one of these bits, or is one of these numbers
  void by_bits(long call, unsigned argument, std::uint32_t bits, std::uint32_t yes,
               std::uint32_t no) {
    put(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 4);
    load(offsetof(seccomp_data, args) + 8 * argument);
    put(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1);
    end(yes);
    end(no);
  }
  void by_numbers(long call, unsigned argument, std::initializer_list<std::uint32_t> numbers,
                  std::uint32_t yes, std::uint32_t no) {
    auto left = static_cast<unsigned>(numbers.size());
    put(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, left + 3);
    load(offsetof(seccomp_data, args) + 8 * argument);
    for (const std::uint32_t number : numbers) put(BPF_JMP | BPF_JEQ | BPF_K, number, left--, 0);
    end(no);
    end(yes);
  }
  // checks both halves of a pointer
  void by_null(long call, unsigned argument, std::uint32_t yes, std::uint32_t no) {
    put(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 6);
    load(offsetof(seccomp_data, args) + 8 * argument);
    put(BPF_JMP | BPF_JEQ | BPF_K, 0, 0, 3);
    load(offsetof(seccomp_data, args) + 8 * argument + 4);
    put(BPF_JMP | BPF_JEQ | BPF_K, 0, 0, 1);
    end(yes);
    end(no);
  }
  [[nodiscard]] bool install(std::uint32_t otherwise) {
    end(otherwise);
    const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return ::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program) ==
           0;
  }

 private:
  void put(unsigned code, std::uint32_t k, unsigned yes = 0, unsigned no = 0) {
    code_.push_back({static_cast<std::uint16_t>(code), static_cast<std::uint8_t>(yes),
                     static_cast<std::uint8_t>(no), k});
  }
  void load(std::size_t offset) {
    put(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  }
  void end(std::uint32_t answer) { put(BPF_RET | BPF_K, answer); }
  std::vector<sock_filter> code_;
};

constexpr std::uint32_t kLet = SECCOMP_RET_ALLOW, kEnd = SECCOMP_RET_KILL_PROCESS;
constexpr std::uint32_t kUnknown = SECCOMP_RET_ERRNO | ENOSYS, kNo = SECCOMP_RET_ERRNO | EPERM;

bool raise_seccomp() {
  if (!seccomp_offered()) return true;
  Filter filter;
  // the most frequent first
  filter.always({SYS_read, SYS_futex, SYS_lseek, SYS_close, SYS_munmap, SYS_brk, SYS_madvise},
                kLet);
  filter.by_bits(SYS_mmap, 2, PROT_EXEC, kNo, kLet);
  filter.by_bits(SYS_mprotect, 2, PROT_EXEC, kNo, kLet);
  constexpr std::uint32_t kWriting = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
  filter.by_bits(SYS_openat, 2, kWriting, kEnd, kLet);
#if defined(SYS_open)
  filter.by_bits(SYS_open, 1, kWriting, kEnd, kLet);
#endif
  filter.always({SYS_pread64,      SYS_readv,         SYS_write,           SYS_writev,
                 SYS_mremap,       SYS_fstat,         SYS_newfstatat,      SYS_statx,
                 SYS_getdents64,   SYS_readlinkat,    SYS_getcwd,          SYS_exit,
                 SYS_exit_group,   SYS_rt_sigaction,  SYS_rt_sigprocmask,  SYS_rt_sigreturn,
                 SYS_sigaltstack,  SYS_clock_gettime, SYS_clock_nanosleep, SYS_nanosleep,
                 SYS_gettimeofday, SYS_sched_yield,   SYS_getrandom,       SYS_set_robust_list,
                 SYS_rseq,         SYS_getpid,        SYS_gettid,          SYS_getppid,
                 SYS_sysinfo,      SYS_uname,         SYS_restart_syscall, SYS_sched_getaffinity,
                 SYS_ppoll,        SYS_membarrier,    SYS_faccessat,       SYS_getuid,
                 SYS_geteuid,      SYS_getgid,        SYS_getegid,         SYS_set_tid_address,
                 SYS_clock_getres, SYS_getrusage,     SYS_fadvise64},
                kLet);
#if defined(__x86_64__)
  filter.always({SYS_stat, SYS_lstat, SYS_access, SYS_poll, SYS_readlink}, kLet);
#endif
  // threads yes, processes no; newer glibc uses clone when clone3 is reported as unknown
  filter.by_bits(SYS_clone, 0, CLONE_THREAD, kLet, kEnd);
  // messages only through the socket that it was started with
  filter.by_numbers(SYS_sendmsg, 0, {kFenceSocket}, kLet, kEnd);
  filter.by_numbers(SYS_recvmsg, 0, {kFenceSocket}, kLet, kEnd);
  // abort() sends a signal to this process only
  filter.by_numbers(SYS_tgkill, 0, {static_cast<std::uint32_t>(::getpid())}, kLet, kEnd);
  filter.by_null(SYS_prlimit64, 2, kLet, kEnd);  // limits may be read, not changed
  filter.by_numbers(SYS_fcntl, 1, {F_GETFD, F_SETFD, F_GETFL}, kLet, kNo);

  filter.always({SYS_socket,
                 SYS_socketpair,
                 SYS_connect,
                 SYS_bind,
                 SYS_listen,
                 SYS_accept,
                 SYS_accept4,
                 SYS_sendto,
                 SYS_sendmmsg,
                 SYS_execve,
                 SYS_execveat,
                 SYS_ptrace,
                 SYS_kill,
                 SYS_tkill,
                 SYS_process_vm_readv,
                 SYS_process_vm_writev,
                 SYS_mount,
                 SYS_umount2,
                 SYS_pivot_root,
                 SYS_chroot,
                 SYS_unlinkat,
                 SYS_renameat2,
                 SYS_mkdirat,
                 SYS_linkat,
                 SYS_symlinkat,
                 SYS_mknodat,
                 SYS_truncate,
                 SYS_ftruncate,
                 SYS_fchmodat,
                 SYS_fchmod,
                 SYS_fchownat,
                 SYS_fchown,
                 SYS_utimensat,
                 SYS_setxattr,
                 SYS_bpf,
                 SYS_perf_event_open,
                 SYS_keyctl,
                 SYS_add_key,
                 SYS_request_key,
                 SYS_unshare,
                 SYS_setns,
                 SYS_setuid,
                 SYS_setgid,
                 SYS_setrlimit,
                 SYS_userfaultfd,
                 SYS_reboot,
                 SYS_open_by_handle_at,
                 SYS_pwrite64,
                 SYS_fallocate,
                 SYS_rt_sigqueueinfo},
                kEnd);
#if defined(__x86_64__)
  filter.always({SYS_fork, SYS_vfork, SYS_unlink, SYS_rename, SYS_mkdir, SYS_rmdir, SYS_link,
                 SYS_symlink, SYS_mknod, SYS_creat, SYS_chmod, SYS_chown},
                kEnd);
#endif
#if defined(SYS_io_uring_setup)
  filter.always({SYS_io_uring_setup}, kEnd);
#endif
  return filter.install(kUnknown);
}
#else
bool raise_seccomp() { return true; }
#endif

}  // namespace

FenceLimits fence_limits(const fs::path& path, const ReadOptions& options) {
  const std::uint64_t there = bytes_there(path);
  FenceLimits limits;
  // Reading takes about 10 ms a MiB, compressed pixels up to 100; a build with sanitizers ten times
  // that.
  constexpr double kSeconds = 8, kSecondsPerMiB = 2, kMostSeconds = 24 * 3600;
  limits.seconds = kSeconds + kSecondsPerMiB * static_cast<double>(there) / double{kMiB};
  if (options.seconds > 0) limits.seconds = options.seconds;
  limits.seconds = std::clamp(limits.seconds, 1.0, kMostSeconds);
  // Labels stay one byte a voxel, however well compressed; other numbers become four bytes each.
  constexpr std::uint64_t kMemory = 1536 * kMiB, kMemoryPerByte = 32, kLeast = 256 * kMiB;
  const auto installed = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                         static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  limits.memory = std::max(kMemory, std::min(kMemory + kMemoryPerByte * there, installed));
  if (options.memory_mb > 0)
    limits.memory = static_cast<std::uint64_t>(std::min(options.memory_mb, 1e7)) * kMiB;
  limits.memory = std::max(limits.memory, kLeast);
  return limits;
}

FenceLimits fence_limits_of_mesh() {
  // The largest takes about 2 s and 400 MiB; a build with sanitizers ten times as long.
  constexpr std::uint64_t kMemory = 1536 * kMiB;
  constexpr double kSeconds = 30;
  return {kMemory, kSeconds};
}

// A sanitizer opens programs, and starts one of its own to name the lines of its report.
#if defined(BURR_SANITIZED)
int landlock_version() { return 0; }
bool seccomp_offered() { return false; }
#else
int landlock_version() {
  const long version = ::syscall(kCreateRuleset, nullptr, 0, 1);
  return version < 0 ? 0 : static_cast<int>(version);
}

bool seccomp_offered() {
#if defined(BURR_AUDIT_ARCH)
  const std::uint32_t action = SECCOMP_RET_KILL_PROCESS;
  return ::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
#else
  return false;
#endif
}

#endif

bool raise_walls(const fs::path& path, const FenceLimits& limits) {
  // needed for the other two; also, no program that it could start would gain rights
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  return raise_limits(limits) && raise_landlock(path) && raise_seccomp();
}

}  // namespace burr::io
