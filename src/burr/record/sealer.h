// record/sealer.h - whoever seals a recording: says at the start for whom it is, and at the end that it is whole.
//
//     recorder.set_sealer(sealer);                     // before start(); school/station_sealer.h is the one of burr
//
// A sealed recording has `seal` in its /session, and the metadata `burr.seal` as its last record before the
// summary. The seal is about all bytes of the file before that record, so whatever is changed, taken out or
// added breaks it. docs/teach/security.md says what a seal proves and what it does not.
// Thread: begin() main, end() the recorder's.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "burr/base/result.h"
#include "burr/record/session_info.h"

namespace burr::record {

class Sealer {
 public:
  Sealer() = default;
  Sealer(const Sealer&) = delete;
  Sealer& operator=(const Sealer&) = delete;
  virtual ~Sealer() = default;
  // info: as it will be written, but for the seal. none: this session gets no seal.
  [[nodiscard]] virtual std::optional<StartSeal> begin(const SessionInfo& info) = 0;
  // Everything but the seal is in the file, in its first `bytes` bytes. Only after begin() gave a seal. none: no
  // seal after all; the recording is whole without it. Throws nothing.
  [[nodiscard]] virtual std::optional<std::map<std::string, std::string>> end(
      const std::string& file, std::uint64_t bytes) = 0;
};

inline constexpr const char* kSealName = "burr.seal";  // metadata: the seal of the end

// As it is in a file; nothing here is checked but the file's own order.
struct SealInFile {
  std::map<std::string, std::string> words;
  std::uint64_t bytes = 0;  // of the file, that it is about
};
// none: the recording has no seal of its end. Error: the file is damaged or cut, it has two seals, or something
// stands behind the seal.
[[nodiscard]] Result<std::optional<SealInFile>> seal_in(const std::string& path);

}  // namespace burr::record
