// apps/burr/batch/result_files.h - the folder in which a batch keeps its results, one file for each row, written whole or not at all.
//
//     DIR/results/<2>/<id>.json       {"engine","id","inputs","manifest","result"}: equal bytes for equal results
//     DIR/results/<2>/<id>.time.json  when, where and how long: differs from run to run
//     DIR/failed/<id>.json            {"code","id","inputs","manifest","sentence"} of a row that was not done
//     DIR/recordings/<2>/<id>.mcap    with `burr batch --record`
//
// <2>: the last two hex digits of fnv1a64(id), so that no folder gets too large. Many processes may write to one DIR: two that do
// the same row give its file the same bytes. Thread: one for each object. Errors: the file, and why.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "burr/base/result.h"

namespace burr::app {

// Which program makes the results: version, compiler, and the build (the linker's id of the program and burr's libraries), since only
// one build gives equal bits.
[[nodiscard]] nlohmann::json this_engine();

class ResultFiles {
 public:
  explicit ResultFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  [[nodiscard]] std::filesystem::path result(const std::string& id) const;
  [[nodiscard]] std::filesystem::path times(const std::string& id) const;
  [[nodiscard]] std::filesystem::path failure(const std::string& id) const;
  [[nodiscard]] std::filesystem::path recording(const std::string& id) const;
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  // None: there is no such file. Error: it cannot be read, or is damaged.
  [[nodiscard]] static Result<std::optional<nlohmann::json>> read(
      const std::filesystem::path& file);
  // Makes the folder of the file. Canonical, with one line end.
  [[nodiscard]] static Status write(const std::filesystem::path& file, const nlohmann::json& value);

  // Names of the files of results and failures, and of what a killed process left half written.
  struct Found {
    std::vector<std::string> results, failures;  // ids, sorted
    std::vector<std::filesystem::path> remains;
  };
  [[nodiscard]] Result<Found> look() const;

 private:
  [[nodiscard]] std::filesystem::path place(const char* kind, const std::string& id,
                                            const char* ending) const;
  std::filesystem::path folder_;
};

}  // namespace burr::app
