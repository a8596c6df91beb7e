// apps/burr/doctor/apart.h - work in a process of its own, with an end in time: a maker's library
// may crash or hang, and the doctor is to say so.
//
//     const Apart seen = apart([] { return std::string("what was found"); },
//                              std::chrono::seconds(10));
//
// Thread: main, before any other thread was begun (fork).
#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace burr::app {

struct Apart {
  bool ended = false;  // by itself, with words
  std::string words;   // what the work gave back; else what became of it
};

[[nodiscard]] Apart apart(const std::function<std::string()>& work,
                          std::chrono::milliseconds longest);

}  // namespace burr::app
