#include "report/marked.h"

#include <utility>

#include "report/make_report.h"
#include "report/scored.h"
#include "report/self_marks.h"

namespace burr::app {

Result<Report> marked(const std::string& recording, const std::string& rubric,
                      const scenario::Recipe& volume, Progress& progress) {
  auto judged = judged_by(recording, rubric);
  if (!judged) return judged.error();
  ReportSettings settings;
  settings.most_pictures = 0;
  settings.self = recorded_self_marks(*judged->player, judged->rubric);
  auto mine = scored(std::move(*judged), volume, progress);
  if (!mine) return mine.error();
  return report_on(*mine, settings, progress);
}

}  // namespace burr::app
