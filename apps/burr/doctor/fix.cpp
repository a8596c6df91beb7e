#include "doctor/fix.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "burr/base/new_file.h"
#include "shared/front_words.h"

namespace burr::app {
namespace {

namespace fs = std::filesystem;

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

}  // namespace

Result<std::string> write_rules(const System& system,
                                const std::function<Answer(const std::string&)>& ask) {
  const fs::path file = udev_file(system);
  const std::string rules = udev_rules();
  std::error_code trouble;
  const bool there = fs::exists(file, trouble);
  if (there && text_of_file(file) == rules)
    return fmt::format("{} is already correct", file.string());
  switch (ask(fmt::format("{} will contain:\n\n{}\n", file.string(), rules))) {
    case Answer::nobody:
      return error(Trouble::usage,
                   "burr cannot ask, because there is no terminal; burr doctor --fix --yes writes "
                   "it without asking");
    case Answer::no:
      return std::string("nothing was written");
    case Answer::yes:
      break;
  }
  std::string said;
  if (there) {
    fs::path old = file;
    old += ".old";
    fs::copy_file(file, old, fs::copy_options::overwrite_existing, trouble);
    if (trouble)
      return error(Trouble::io, fmt::format("{}: cannot be kept as {} ({}); nothing was written",
                                            file.string(), old.string(), trouble.message()));
    said = fmt::format("its old content is in {}\n", old.string());
  }
  const auto cannot = [](const std::string& why) {
    return error(Trouble::io,
                 geteuid() == 0
                     ? why
                     : fmt::format("{}; run it as root: sudo burr doctor --fix --seconds 0", why));
  };
  // without udev there is no folder yet; then the rule waits there for udev
  const bool no_udev = fs::create_directories(file.parent_path(), trouble);
  if (trouble)
    return cannot(fmt::format("{}: the folder cannot be made ({})", file.parent_path().string(),
                              trouble.message()));
  auto out = base::NewFile::create(file.string(), base::kForAll);
  if (!out) return cannot(in_options(out.error()).text);
  out->write(rules);
  const Status put = out->put_in_place();
  if (!put) return cannot(in_options(put.error()).text);
  if (no_udev)
    return said + "written, but udev, which reads it, is not on this computer: apt install udev";
  return said +
         "written. Now: udevadm control --reload && udevadm trigger, then plug the device in again";
}

}  // namespace burr::app
