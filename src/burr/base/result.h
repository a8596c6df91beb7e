// base/result.h - the result of work that can fail from outside causes: a value, or one sentence
// that says what went wrong.
//
//     Result<Scan> scan = io::read_scan(path);
//     if (!scan) return scan.error();     // or: fmt::print(stderr, "{}\n", scan.error().text)
//
// For files, devices and arguments. Programming errors go to BURR_CHECK, trouble inside the tick to
// flags. Thread: any. Memory: the text is allocated, so never use it inside the tick.
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "burr/base/check.h"

namespace burr {

// The kind of trouble. The number is the exit code of the program (see sysexits.h).
enum class Trouble {
  failed = 1,         // a check that the user asked for did not pass
  usage = 2,          // wrong arguments on the command line
  data = 65,          // the content of a file is invalid
  internal = 70,      // a programming error that was caught late
  io = 74,            // a file cannot be read or written
  interrupted = 130,  // the user asked to stop
};

// One sentence: what (file), where (field), and what to do about it.
struct Error {
  Trouble trouble = Trouble::data;
  std::string text;
};

[[nodiscard]] inline Error error(std::string text) { return {Trouble::data, std::move(text)}; }
[[nodiscard]] inline Error error(Trouble trouble, std::string text) {
  return {trouble, std::move(text)};
}

struct Nothing {};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool ok() const { return std::holds_alternative<T>(state_); }
  explicit operator bool() const { return ok(); }

  [[nodiscard]] const burr::Error& error() const {
    BURR_CHECK(!ok());
    return std::get<burr::Error>(state_);
  }
  T& value() {
    BURR_CHECK(ok());
    return std::get<T>(state_);
  }
  const T& value() const {
    BURR_CHECK(ok());
    return std::get<T>(state_);
  }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

 private:
  std::variant<T, burr::Error> state_;
};

using Status = Result<Nothing>;
inline Status fine() { return Nothing{}; }

}  // namespace burr
