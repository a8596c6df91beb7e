#include "shared/built_page.h"

#include <algorithm>
#include <system_error>

namespace burr::app {

namespace fs = std::filesystem;

Result<fs::path> built_page() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none).parent_path();
  for (const fs::path& folder : {program / "../web/site", program / "../share/burr/web"})
    if (fs::exists(folder / kSignOfPage, none)) return fs::canonical(folder, none);
  return error(Trouble::usage,
               "the page is not built: install Debian's emscripten and nodejs (apt-get install "
               "emscripten nodejs), and run ./run --web in the folder of burr's sources, or cmake "
               "--preset web && cmake --build --preset web");
}

std::vector<fs::path> files_of_page(const fs::path& page) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(page))
    if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace burr::app
