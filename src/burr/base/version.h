// base/version.h - version and build of this burr.
#pragma once

namespace burr::base {

// "0.1.0"
[[nodiscard]] const char* version() noexcept;

// compiler and build kind, for reports and recordings: "g++ 12.2.0, optimised"
[[nodiscard]] const char* build() noexcept;

}  // namespace burr::base
