// base/one_bar.h - one bar for a work of several steps, each of which tells its own share: "3 of 5:
// smoothing".
//
//     OneBar bar(progress, {{{"reading"}, 0.3}, {{"smoothing"}, 0.2}, {{"finding the surface"}, 0.5}});
//     read(file, bar);  ...  smooth(bar);  ...        // each reports 0 to 1 of its own stage
//
// The bar only grows. A step may have several stages; a stage that begins again belongs to a
// later step, if one names it. A stage that no step names counts with the step at hand.
// A OneBar that is given a OneBar adds nothing: the outer one knows the whole work, so what is a part
// of it may have one of its own for whoever calls it alone. Thread: as Progress.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "burr/base/progress.h"

namespace burr::base {

class OneBar final : public Progress {
 public:
  struct Step {
    std::vector<std::string_view> stages;  // in their order; each an equal part of the step
    double share;                          // of the whole work; the shares need not add up to 1
  };

  // `whole`, and the texts that the steps point to, must outlive this object. With fewer than two steps
  // the stage is reported without numbers.
  OneBar(Progress& whole, std::vector<Step> steps);
  void report(double fraction, std::string_view stage) override;
  [[nodiscard]] bool cancelled() const override { return whole_.cancelled(); }

 private:
  [[nodiscard]] bool find(std::string_view stage, bool later);

  Progress& whole_;
  std::vector<Step> steps_;
  bool passes_;     // whole_ is a OneBar
  double all_ = 0;  // sum of the shares
  std::size_t step_ = 0, stage_ = 0;
  std::string last_;  // the stage that was reported last
  double done_ = 0;   // of that stage
  double told_ = 0;
};

// What a OneBar says: "3 of 5: smoothing".
struct NumberedStage {
  int number = 0, of = 0;
  std::string_view words;  // of `stage`
};
// none: a stage without numbers
[[nodiscard]] std::optional<NumberedStage> numbered_stage(std::string_view stage);

}  // namespace burr::base
