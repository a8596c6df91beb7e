// A user's devices.toml; the first line is one setting as on the command line.

#include "burr/workshop/device_book.h"
#include "support.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace burr;
  fuzz::Pieces in({data, size});
  const std::string_view assignment = in.line();
  auto book = workshop::DeviceBook::parse(fuzz::text_of(in.rest()), "a.toml");
  for (const std::string& trouble : book.troubles()) fuzz::look_at(error(trouble));
  const Status set = book.set("Touch T-1", assignment);
  if (!set) fuzz::look_at(set.error());
  const workshop::DevicePreferences preferences = book.of("Touch T-1");
  const auto within = [](std::string_view key, double value) {
    const workshop::PreferenceRange range = workshop::range_of_preference(key);
    fuzz::must(value >= range.least && value <= range.most, "a preference is within its range");
  };
  within("scale", preferences.mapping.scale);
  within("max_force_n", preferences.max_force_n);
  within("vibration", preferences.vibration);
  within("torque", preferences.torque);
  within("mill_button", preferences.mapping.mill_button);
  within("clutch_button", preferences.mapping.clutch_button);
  fuzz::must(std::abs(preferences.mapping.axes.norm() - 1) < 1e-9, "a device stands somehow");
  const std::string written = book.text();
  const auto again = workshop::DeviceBook::parse(written, "b.toml");
  fuzz::must(again.troubles().empty() && again.text() == written, "what is written is read");
  return 0;
}
