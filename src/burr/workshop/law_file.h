// workshop/law_file.h - a custom law from a shared library (tick/law_v1.h), and the list of those that
// passed `burr verify law` on this computer.
//
//     auto law = workshop::LawFile::open("my_law.so", "", workshop::law_passes());
//     settings.law = *law;                       // of a sim::SessionSettings
//
// The library is loaded from a copy in memory of the very bytes that were hashed: a file that is built again
// meanwhile changes nothing, and each LawFile has global variables of its own. A law is a program with all the
// rights of burr: nothing holds it back. Thread: as tick/own_law.h.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "burr/base/result.h"
#include "burr/tick/own_law.h"

namespace burr::workshop {

class LawFile final : public tick::OwnLaw {
 public:
  // law_settings: a file whose text the law gets; empty: none. passes: the folder of law_passes(), where
  // fit_for_real_time() looks; empty: nothing has passed. Error: it cannot be read or loaded, or is no law.
  [[nodiscard]] static Result<std::shared_ptr<LawFile>> open(
      const std::string& path, const std::string& law_settings = "",
      const std::filesystem::path& passes = {});
  ~LawFile() override;

  [[nodiscard]] int answer(const burr_law_in_v1& in, burr_law_out_v1& out) BURR_RT override {
    return call_(state_, &in, &out);
  }
  [[nodiscard]] Status begin() override;
  [[nodiscard]] Status fit_for_real_time() const override;
  [[nodiscard]] tick::LawAbout about() const override { return about_; }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  LawFile() = default;
  [[nodiscard]] Status load(const std::string& bytes);
  void end();

  std::string path_, settings_path_, settings_;  // the text
  std::filesystem::path passes_;
  tick::LawAbout about_;
  void* library_ = nullptr;
  void* state_ = nullptr;
  bool begun_ = false;
  decltype(&burr_law_v1) call_ = nullptr;
  decltype(&burr_law_v1_new) new_ = nullptr;
  decltype(&burr_law_v1_delete) delete_ = nullptr;
};

// Of the user: in burr's folder for states.
[[nodiscard]] std::filesystem::path law_passes();
// Remembers that this law, with these settings, passed. notes: lines for people. Error: it cannot be written.
[[nodiscard]] Status remember_pass(const std::filesystem::path& passes, const tick::LawAbout& law,
                                   const std::string& notes);
[[nodiscard]] bool has_passed(const std::filesystem::path& passes, const tick::LawAbout& law);

}  // namespace burr::workshop
