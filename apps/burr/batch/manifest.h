// apps/burr/batch/manifest.h - a manifest: a table with one row for each session, and which rows belong to a shard.
//
//     # burr-manifest 1
//     id,command,case,level,seed
//     s0001,surgeon,tooth,expert,1000
//
// `command` names a command of burr, each other column one of its options without the dashes, or what stands without an option on
// its command line (`case`). An empty cell: the option is not given. Quotes as in RFC 4180; lines that begin with # and empty
// lines are left out. Thread: any. Errors: file, line, column, and what to change.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/result.h"

namespace burr::app {

inline constexpr const char* kManifestHead = "# burr-manifest 1";

struct ManifestRow {
  std::string id, command;
  std::vector<std::string> cells;  // one for each column
  int line = 0;                    // in the file; the first is 1
};

struct Manifest {
  std::string file;  // as the user named it
  std::string hash;  // SHA-256 of the whole file
  std::vector<std::string> columns;
  int head_line = 0;  // of the columns
  std::vector<ManifestRow> rows;

  // "m.csv: line 7, column seed"; column empty: without it
  [[nodiscard]] std::string place(int line, const std::string& column = {}) const;
  // What makes the result what it is: command and the cells that are not empty, by name.
  [[nodiscard]] nlohmann::json inputs(const ManifestRow& row) const;
};

[[nodiscard]] Result<Manifest> read_manifest(const std::string& path);
// file: for the sentences.
[[nodiscard]] Result<Manifest> parse_manifest(std::string_view text, const std::string& file);

// K of N. A row keeps its shard when others are added: fnv1a64(id) mod N == K.
struct Shard {
  std::uint64_t part = 0, of = 1;
};
// "3/64"
[[nodiscard]] Result<Shard> shard_of(const std::string& text);
[[nodiscard]] bool belongs(const ManifestRow& row, const Shard& shard);

}  // namespace burr::app
