// apps/burr/shared/helper_process.h - another program beside the window: its error messages are
// read. The program is stopped when this object is destroyed, unless let_go() was called.
//
//     HelperProcess child({burr_itself(), "--quiet", "report", ...});
//     if (!child.began()) ...
//     each frame:   if (child.ended()) ... child.fine() or child.complaint("...")
//
// Thread: one.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace burr::app {

// The program `burr` beside the one that runs; a test is such a program too.
[[nodiscard]] std::string burr_itself();

// Full path of a program that is in PATH; empty: it is not.
[[nodiscard]] std::string program_in_path(const std::string& name);

// Starts a program and does not wait for it; it stays when burr ends. False: it could not be started.
[[nodiscard]] bool start_apart(const std::vector<std::string>& words);

class HelperProcess {
 public:
  static constexpr int kBeside = 10;  // for work beside a running session
  // nice: its priority, 0 to 19; the higher, the less it gets.
  explicit HelperProcess(const std::vector<std::string>& words, int nice = kBeside);
  ~HelperProcess();  // kills it if it has not ended
  HelperProcess(const HelperProcess&) = delete;
  HelperProcess& operator=(const HelperProcess&) = delete;

  [[nodiscard]] bool began() const { return pid_ > 0; }
  void stop() const;                 // as Ctrl-C does
  void let_go() { let_go_ = true; }  // the program runs on after this object is destroyed
  [[nodiscard]] bool ended();
  [[nodiscard]] bool fine() const;  // call it after ended()
  // The last line of its messages so far; "": none.
  [[nodiscard]] std::string last_line() const;
  // The last line of the error messages, without the program's name; `silent` if there is none.
  [[nodiscard]] std::string complaint(const std::string& silent) const;

 private:
  pid_t pid_ = -1;
  int said_at_ = -1, status_ = 0;
  bool ended_ = false, let_go_ = false;
  std::string said_;
};

}  // namespace burr::app
