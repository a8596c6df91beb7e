// A scan from behind the fence: what the reader answered is checked here.
#include "burr/io/read/read_scan.h"

#include <fcntl.h>
#include <sys/mman.h>

#include <cstdint>
#include <utility>

#include "burr/base/hash.h"
#include "burr/io/sandbox/fence_asker.h"
#include "burr/io/sandbox/fence_letter.h"

namespace burr::io {
namespace {

bool all_finite(const Voxels<float>& values) {
  constexpr std::uint32_t kExponent = 0x7F800000;
  std::uint32_t broken = 0;
  for (const float value : values) {
    const std::uint32_t bits = base::bits_of(value);
    broken |= (bits & kExponent) == kExponent ? 1U : 0U;
  }
  return broken == 0;
}

// Takes over the voxels of a loan without a copy.
template <class T>
bool take_over(Voxels<T>& to, FenceAsker::Loan* loan, std::uint64_t count) {
  if (count == 0) return true;
  if (loan == nullptr || count > loan->bytes / sizeof(T)) return false;
  // after this it cannot be written; the kernel refuses while it is mapped for writing
  if (::fcntl(loan->memory.get(), F_ADD_SEALS, F_SEAL_WRITE) != 0) return false;
  const auto bytes = static_cast<std::size_t>(loan->bytes);
  void* at = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_NORESERVE,
                    loan->memory.get(), 0);
  if (at == MAP_FAILED) return false;
  to = voxels_in<T>(at, bytes, static_cast<std::size_t>(count));
  loan->memory.reset();
  return true;
}

}  // namespace

Result<Scan> read_scan(const std::filesystem::path& path, const ReadOptions& options,
                       Progress& progress) {
  FenceAsker asker(path);
  if (Status status = asker.ask({path.string(), options}, progress); !status) return status.error();
  const std::vector<std::uint8_t> bytes = asker.letter();
  FenceOutcome outcome;
  if (bytes.empty() || !unpack(bytes, outcome)) return asker.lies();
  if (!outcome.scan) {
    if (outcome.scan.error().trouble == Trouble::interrupted) return asker.lies();
    return outcome.scan.error();
  }
  Scan& scan = *outcome.scan;
  if (!take_over(scan.values, asker.loan(outcome.values_loan), outcome.values) ||
      !take_over(scan.labels, asker.loan(outcome.labels_loan), outcome.labels) ||
      !all_finite(scan.values))
    return asker.lies();
  return std::move(scan);
}

}  // namespace burr::io
