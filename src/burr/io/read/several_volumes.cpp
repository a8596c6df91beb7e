#include "burr/io/read/several_volumes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "burr/base/printable.h"
#include "burr/io/read/text.h"

namespace burr::io {
namespace {

class OneShare final : public ByteSource {
 public:
  OneShare(std::unique_ptr<ByteSource> all, const Share& share)
      : all_(std::move(all)), share_(share), block_(std::size_t{1} << 16) {}

  Result<std::size_t> read(void* to, std::size_t n) override {
    auto* out = static_cast<std::uint8_t*>(to);
    std::size_t have = 0;
    while (have < n) {
      if (at_ == end_) {
        if (have > 0) break;
        auto got = all_->read(block_.data(), block_.size());
        if (!got || *got == 0) return got;
        at_ = 0;
        end_ = *got;
      }
      const std::uint64_t until = where_ < share_.from ? share_.from
                                  : where_ < share_.from + share_.length
                                      ? share_.from + share_.length
                                      : share_.period;
      const bool wanted = where_ >= share_.from && where_ < share_.from + share_.length;
      std::uint64_t step = std::min<std::uint64_t>(until - where_, end_ - at_);
      if (wanted) {
        step = std::min<std::uint64_t>(step, n - have);
        std::memcpy(out + have, block_.data() + at_, step);
        have += step;
      }
      at_ += step;
      where_ += step;
      if (where_ == share_.period) where_ = 0;
    }
    return have;
  }

 private:
  std::unique_ptr<ByteSource> all_;
  Share share_;
  std::vector<std::uint8_t> block_;
  std::size_t at_ = 0, end_ = 0;  // in the block
  std::uint64_t where_ = 0;       // in the period
};

}  // namespace

Result<std::uint64_t> take_volume(std::uint64_t count, const ReadOptions& options,
                                  const std::string& file, Scan& scan) {
  std::string wanted(trimmed(options.series));
  if (wanted.starts_with('#')) wanted.erase(0, 1);
  std::int64_t number = 1;
  const bool good = wanted.empty() || (to_number(wanted, number) && number >= 1 &&
                                       static_cast<std::uint64_t>(number) <= count);
  if (!good && count == 1)
    return error(
        Trouble::usage,
        fmt::format("{}: holds one volume, and `series` names another, \"{}\"; leave it out", file,
                    base::printable(options.series)));
  if (!good)
    return error(Trouble::usage,
                 fmt::format("{}: holds {} volumes, and `series` \"{}\" is none of them; give a "
                             "number from 1 to {}",
                             file, count, base::printable(options.series), count));
  constexpr std::uint64_t kListed = 1000;
  if (count > 1 && count <= kListed) {
    for (std::uint64_t n = 1; n <= count; ++n)
      scan.series.push_back(fmt::format("#{}: volume {} of {}", n, n, count));
    scan.series_taken = static_cast<int>(number - 1);
  }
  if (count > 1 && wanted.empty())
    scan.ask(Ask::volume, fmt::format("{}: holds {} volumes, and burr reads one", file, count));
  else if (count > 1)
    scan.notices.push_back(fmt::format("Volume {} of {} was read.", number, count));
  return static_cast<std::uint64_t>(number - 1);
}

std::unique_ptr<ByteSource> only_share(std::unique_ptr<ByteSource> all, const Share& share) {
  if (share.all()) return all;
  return std::make_unique<OneShare>(std::move(all), share);
}

}  // namespace burr::io
