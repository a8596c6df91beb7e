#include "burr/workshop/fault_file.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <system_error>
#include <vector>

#include "burr/base/new_file.h"
#include "burr/base/version.h"
#include "burr/tick/flag_words.h"

namespace burr::workshop {
namespace {

constexpr std::size_t kKept = 20;

std::string three(const math::Vec3& v, double scale) {
  return fmt::format("{:.6g},{:.6g},{:.6g}", scale * v.x(), scale * v.y(), scale * v.z());
}

// A comment's line ends where the text does.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  return text;
}

}  // namespace

std::string fault_text(const tick::FaultReport& report, const device::DeviceSpec& device,
                       double rate_hz, const std::string& trouble) {
  std::string text =
      fmt::format("# burr {} ({}): force released\n", base::version(), base::build());
  text += fmt::format("# device: {}\n", one_line(device.name + " " + device.serial));
  for (const std::string& sentence : tick::words(report.flags))
    text += "# " + one_line(sentence) + "\n";
  if (!trouble.empty()) text += "# message of the device: " + one_line(trouble) + "\n";
  text += fmt::format("# the last {} ticks, {:g} a second, oldest first; flags as in rt/flags.h\n",
                      report.count, rate_hz);
  text +=
      "tick,valid,hand_x_mm,hand_y_mm,hand_z_mm,velocity_x_mm_s,velocity_y_mm_s,velocity_z_mm_s,"
      "proxy_x_mm,proxy_y_mm,proxy_z_mm,force_x_n,force_y_n,force_z_n,torque_x_nm,torque_y_nm,"
      "torque_z_nm,depth_mm,pedal,buttons,flags,"
      "took_us,late_us\n";
  for (int n = 0; n < report.count; ++n) {
    const tick::TickRow& row = report.rows[static_cast<std::size_t>(n)];
    text += fmt::format("{},{},{},{},{},{},{},{:.6g},{:.3g},{},{},{:.1f},{:.1f}\n", row.tick,
                        row.hand.valid ? 1 : 0, three(row.hand.world_from_tool.p, 1e3),
                        three(row.hand.velocity, 1e3), three(row.contact.proxy, 1e3),
                        three(row.contact.force, 1), three(row.contact.torque, 1),
                        1e3 * row.contact.depth, row.hand.pedal, row.hand.buttons,
                        row.contact.flags, row.took_us, row.late_us);
  }
  return text;
}

Result<std::filesystem::path> keep_fault(const std::filesystem::path& folder,
                                         const std::string& text) {
  std::error_code trouble;
  std::filesystem::create_directories(folder, trouble);
  if (trouble)
    return error(Trouble::io,
                 fmt::format("{}: cannot make this folder ({}); the last ticks are not saved",
                             folder.string(), trouble.message()));
  const std::string name = fmt::format("fault-{:%Y%m%d-%H%M%S}", fmt::gmtime(std::time(nullptr)));
  std::filesystem::path path = folder / (name + ".csv");
  for (int n = 2; std::filesystem::exists(path, trouble); ++n)  // another one in the same second
    path = folder / fmt::format("{}.{}.csv", name, n);
  auto file = base::NewFile::create(path.string());
  if (!file) return file.error();
  file->write(text);
  const Status put = file->put_in_place();
  if (!put) return put.error();

  std::vector<std::filesystem::path> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder, trouble))
    if (entry.path().filename().string().starts_with("fault-")) all.push_back(entry.path());
  std::sort(all.begin(), all.end());
  while (all.size() > kKept) {
    std::filesystem::remove(all.front(), trouble);
    all.erase(all.begin());
  }
  return path;
}

}  // namespace burr::workshop
