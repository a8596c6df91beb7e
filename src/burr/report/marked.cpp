#include "burr/report/marked.h"

#include <algorithm>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "burr/report/make_report.h"
#include "burr/report/scored.h"
#include "burr/report/self_marks.h"

namespace burr::report {
namespace {

// The work has many steps, and each tells its own share from 0 to 1. Together they are one share that
// only grows: each new step gets a part of what is left, so that the bar is never full before the end.
class OneShare final : public Progress {
 public:
  explicit OneShare(Progress& whole) : whole_(whole) {}
  void report(double fraction, std::string_view stage) override {
    constexpr double kStep = 0.25;  // of what is left
    const double from = from_.emplace(std::string(stage), reported_).first->second;
    const double here = from + kStep * (1 - from) * std::clamp(fraction, 0.0, 1.0);
    reported_ = std::max(reported_, here);
    whole_.report(reported_, stage);
  }
  [[nodiscard]] bool cancelled() const override { return whole_.cancelled(); }

 private:
  Progress& whole_;
  std::map<std::string, double> from_;  // where a step began; steps come again
  double reported_ = 0;
};

}  // namespace

Result<Report> marked(const std::string& recording, const std::string& rubric,
                      const scenario::BoneRecipe& volume, Progress& progress) {
  auto judged = judged_by(recording, rubric);
  if (!judged) return judged.error();
  ReportSettings settings;
  settings.most_pictures = 0;
  settings.self = recorded_self_marks(*judged->player, judged->rubric);
  OneShare share(progress);
  auto mine = scored(std::move(*judged), volume, share);
  if (!mine) return mine.error();
  return report_on(*mine, settings, share);
}

}  // namespace burr::report
