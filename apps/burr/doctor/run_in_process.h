// apps/burr/doctor/run_in_process.h - runs work in a process of its own, with a time limit: a
// maker's library may crash or hang, and the doctor must report that.
//
//     const ProcessResult seen = run_in_process([] { return std::string("what was found"); },
//                              std::chrono::seconds(10));
//
// Thread: main, before any other thread was started (fork).
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace burr::app {

struct ProcessResult {
  bool ended = false;  // it ended by itself and gave a text
  std::string words;   // the text that the work returned; otherwise what happened to it
};

[[nodiscard]] ProcessResult run_in_process(const std::function<std::string()>& work,
                                           std::chrono::milliseconds longest);

}  // namespace burr::app
