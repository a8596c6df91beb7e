// io/read/stack_names.h - which of the pictures in a folder are one stack, and their order: by the number
// that changes in their names, so that slice2 comes before slice10. Internal to io. Thread: any.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "burr/base/result.h"

namespace burr::io {

struct StackNames {
  std::vector<std::filesystem::path> files;  // in the order of their numbers
  std::vector<std::int64_t> numbers;         // of each
  std::int64_t step = 1;                     // what the numbers grow by where none is missing
  std::size_t left_out = 0;                  // other pictures in the folder
  // Numbers between the first and the last that no picture has.
  [[nodiscard]] std::vector<std::int64_t> missing() const;
};

// files: at least one picture, all of them of the folder. Error: several stacks, no number that tells the
// pictures apart, one number twice.
[[nodiscard]] Result<StackNames> stack_names(const std::vector<std::filesystem::path>& files,
                                             const std::string& folder);

}  // namespace burr::io
