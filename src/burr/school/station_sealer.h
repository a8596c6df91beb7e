// school/station_sealer.h - seals the sessions of this station: asks the centre's store for a nonce at the start, and closes
// it at the end.
//
//     auto sealer = std::make_shared<StationSealer>(place, *SigningKey::read(file));
//     recorder.set_sealer(sealer);
//     ...                                               // the session
//     for (const std::string& line : sealer->said()) ...  // why it has no seal
//
// A store that does not answer costs the session its seal, and some seconds, and nothing else. Thread: begin() main, end()
// the recorder's, said() any.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "burr/record/sealer.h"
#include "burr/school/seal.h"
#include "burr/school/signing_key.h"
#include "burr/school/store.h"

namespace burr::school {

class StationSealer final : public record::Sealer {
 public:
  StationSealer(StorePlace place, SigningKey key);
  [[nodiscard]] std::optional<record::StartSeal> begin(const record::SessionInfo& info) override;
  [[nodiscard]] std::optional<std::map<std::string, std::string>> end(const std::string& file,
                                                                      std::uint64_t bytes) override;
  // One sentence where the session has no seal, or none at its end.
  [[nodiscard]] std::vector<std::string> said() const;

 private:
  void say(const std::string& why);
  [[nodiscard]] Status close(const std::string& file, std::uint64_t bytes);

  StorePlace place_;
  SigningKey key_;
  Seal seal_;
  mutable std::mutex mutex_;
  std::vector<std::string> said_;
};

}  // namespace burr::school
