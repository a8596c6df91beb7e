#include "shared/law_choice.h"

#include <fmt/format.h>

#include "burr/workshop/law_file.h"

namespace burr::app {

Result<std::shared_ptr<tick::OwnLaw>> own_law(const LawChoice& law, bool realtime) {
  if (law.file.empty()) return std::shared_ptr<tick::OwnLaw>();
  auto opened = workshop::LawFile::open(law.file, law.settings, workshop::law_passes());
  if (!opened) return opened.error();
  if (realtime)
    if (const Status fit = (*opened)->fit_for_real_time(); !fit)
      return error(fit.error().trouble,
                   fmt::format("{}; run `burr verify law {}{}`", fit.error().text, law.file,
                               law.settings.empty() ? "" : " --law-settings " + law.settings));
  return std::shared_ptr<tick::OwnLaw>(std::move(*opened));
}

}  // namespace burr::app
