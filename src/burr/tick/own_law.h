// tick/own_law.h - a law that is not burr's: from a file (workshop/law_file.h), from a function of
// Python, or from a recording of one.
//
// Thread: answer() on the servo's; the rest on another one, while no tick runs. Units and frame: law_v1.h.
#pragma once

#include <string>

#include "burr/base/result.h"
#include "burr/rt/rt.h"
#include "burr/tick/law_v1.h"
#include "burr/tick/rows.h"

namespace burr::tick {

// What a recording says about it.
struct LawAbout {
  std::string kind;             // "compiled" or "python"; empty: none
  std::string name;             // of the file without its folder, or of the function
  std::string sha256;           // of the file; empty: none
  std::string settings_sha256;  // of the text of its settings; empty: none
};

class OwnLaw {
 public:
  OwnLaw() = default;
  virtual ~OwnLaw() = default;
  OwnLaw(const OwnLaw&) = delete;
  OwnLaw& operator=(const OwnLaw&) = delete;

  // out: filled with burr's own answer. 0: fine; else it cannot answer.
  [[nodiscard]] virtual int answer(const burr_law_in_v1& in, burr_law_out_v1& out) BURR_RT = 0;
  // Before the first tick of a session, and when it starts over: as if it had never been asked.
  [[nodiscard]] virtual Status begin() = 0;
  // May it act in a session in real time? Error: why not, and what to do.
  [[nodiscard]] virtual Status fit_for_real_time() const = 0;
  [[nodiscard]] virtual LawAbout about() const = 0;
};

// The answers of a recording, for its replay: nothing is asked again.
class RecordedLaw final : public OwnLaw {
 public:
  void set(const LawRow& recorded) BURR_RT { row_ = recorded; }
  [[nodiscard]] int answer(const burr_law_in_v1& in, burr_law_out_v1& out) BURR_RT override;
  [[nodiscard]] Status begin() override { return fine(); }
  [[nodiscard]] Status fit_for_real_time() const override { return fine(); }
  [[nodiscard]] LawAbout about() const override { return {}; }

 private:
  LawRow row_;
};

}  // namespace burr::tick
